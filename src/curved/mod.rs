//! Pairs with a cylinder or a cone: how far they are apart or how deep they overlap, and the contact patch.
//!
//! A search over a curved surface has no vertices to end at. But where two shapes are nearest or overlap
//! least, the normal usually solves a few equations: it is the normal of a flat side, it is perpendicular to
//! an edge, or it has a fixed angle to an axis ([`stationary`]). Such a normal and the patch along it make a
//! proof: the support planes bound the signed distance from below, and the narrowest gap of the patch bounds
//! it from above ([`certificate`]). GJK and EPA find a normal to start from, and give the answer if none of
//! these normals can be proved ([`search`]).
//!
//! To add a convex shape, implement [`SurfacePieces`]: its support mapping and the pieces of its surface.

mod at_rest;
mod bends;
mod by_pieces;
mod certificate;
mod circle;
mod cone;
mod contacts;
mod crossings;
mod curvature;
mod cylinder;
mod discs;
mod find_places;
mod flat_sides;
mod lead;
mod lines;
mod on_border;
mod on_crossing;
mod on_flat;
mod on_plane;
mod on_ruled;
mod on_segment;
mod outline;
mod over;
mod patch;
mod piece;
mod place;
mod polygons;
mod polytope;
mod query;
mod rim_edge;
mod round;
mod search;
mod seeds;
mod separation;
mod stationary;
mod surface_pieces;

pub use contacts::contacts;
pub use patch::{ContactPlace, Patch};
pub use piece::{FlatSide, Outline, Piece};
pub use query::{CurvedAnswer, CurvedQuery, CurvedScratch, Hint};
pub use surface_pieces::{BorderPlace, CircularEdge, Foot, Ruling, SurfacePieces, point_on_flat};
