//! Building hulls: from points, from triangles, and from parry's polyhedra.

mod adjacency;
mod area_vectors;
mod bends;
pub(crate) mod canonical;
mod face_loops;
mod face_plane;
mod faces;
mod flat_edges;
mod flat_sides;
mod graph;
pub(super) mod half_edge;
pub(crate) mod identity;
mod morton;
pub(crate) mod polyhedron;
mod quickhull;
mod regions;
mod sides;
pub(super) mod solid;
mod steep;
mod surface;
mod validate;
