//! Building hulls: from points, from triangles, and from parry's polyhedra.

mod flat_sides;
pub(super) mod half_edge;
mod morton;
pub(super) mod point_cloud;
pub(crate) mod polyhedron;
mod validate;
