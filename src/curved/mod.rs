//! Pairs with a cylinder or a cone: how far they are apart or how deep they overlap, and the contact patch.
//!
//! A curved surface has no vertices that a search could end at. But where two shapes are nearest or
//! overlap least, the normal mostly solves a few equations: it is that of a flat side, it is square to
//! an edge, or it has a fixed angle to an axis ([`stationary`]). One such normal and the patch along it
//! prove each other: the normal's support planes bound the signed distance from below, and the narrowest gap
//! of the patch bounds it from above ([`certificate`]). GJK and EPA only find the way to it, and answer
//! where no such normal is found ([`search`]).
//!
//! A new convex shape needs a [`Body`]: its support mapping, and the pieces that its surface consists of.

mod at_rest;
mod body;
mod certificate;
mod circle;
mod cone;
mod contacts;
mod curvature;
mod cylinder;
mod discs;
mod lines;
mod on_flat;
mod on_ruled;
mod outline;
mod over;
mod patch;
mod piece;
mod place;
mod polytope;
mod query;
mod rim_edge;
mod round;
mod search;
mod seeds;
mod stationary;

pub use body::{Body, CircularEdge, Ruling};
pub use contacts::contacts;
pub use patch::{ContactPlace, Patch};
pub use piece::{FlatSide, Piece};
pub use query::{CurvedAnswer, CurvedQuery, CurvedScratch, Hint};
