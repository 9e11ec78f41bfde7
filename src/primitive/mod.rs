//! Shapes that need no tables: boxes and triangles, and smooth shapes.
//!
//! Balls and capsules are a core (a point or a segment) with a border around it: kernels work on the cores,
//! and the widths of the borders are subtracted from the distance. So round surfaces are exact, and a depth
//! need be searched for only if the *cores* overlap.

mod ball;
mod cone;
mod crossing_lines;
mod cuboid;
mod cylinder;
mod outline;
mod point;
mod rim;
mod rolling;
mod segment;
mod triangle;

pub use ball::Ball;
pub use cone::Cone;
pub(crate) use crossing_lines::{common_stretch, middle_direction, stretch_beside};
pub use cuboid::CuboidPolytope;
pub use cylinder::Cylinder;
pub(crate) use outline::Revolved;
pub(crate) use point::Point;
pub(crate) use rolling::{turn_about, turns};
pub use segment::Segment;
pub(crate) use segment::{exit_from_ball, exit_from_capsule, nearest_share};
pub use triangle::TrianglePolytope;

use glam::Vec3;

use crate::support::{EdgeId, FaceCorners, FaceId, Polytope, VertexId};

/// A face of a shape where look-ups cost nothing.
impl<P: Polytope> FaceCorners for (&P, FaceId) {
    #[inline]
    fn count(self) -> usize {
        self.0.face_len(self.1)
    }

    #[inline]
    fn vertex(self, i: usize) -> VertexId {
        self.0.face_vertex(self.1, i)
    }

    #[inline]
    fn point(self, i: usize) -> Vec3 {
        self.0.vertex(self.vertex(i)).as_vec3()
    }

    #[inline]
    fn edge(self, i: usize) -> Option<EdgeId> {
        self.0.face_edge(self.1, i)
    }
}
