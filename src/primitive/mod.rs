//! Shapes that need no tables: boxes and triangles, and smooth shapes.
//!
//! Balls and capsules are a core (a point or a segment) with a border around it: kernels work on the cores,
//! and the widths of the borders are subtracted from the distance. So round surfaces are exact, and a depth
//! need be searched for only if the *cores* overlap.

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
pub(crate) use segment::nearest_share;
pub use triangle::TrianglePolytope;
