//! Shapes too small for tables: boxes and triangles, as hulls meet them, and smooth ones.
//!
//! Balls and capsules are a core, a point or a segment, with a border around it: kernels work on
//! the cores, and the borders' widths are taken off the distance. So a round surface is exact, and
//! only where the *cores* overlap is there a depth to search for.

mod ball;
mod cone;
mod cuboid;
mod cylinder;
mod rim;
mod segment;
mod triangle;

pub use ball::Ball;
pub use cone::Cone;
pub use cuboid::CuboidPolytope;
pub use cylinder::Cylinder;
pub use segment::Segment;
pub use triangle::TrianglePolytope;
