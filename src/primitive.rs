//! Polytopes too small for tables: boxes and triangles, as hulls meet them.

mod cuboid;
mod triangle;

pub use cuboid::CuboidPolytope;
pub use triangle::TrianglePolytope;
