//! Vertices of the Minkowski difference.

use glam::DVec3;

use crate::ids::VertexId;

/// A vertex of the Minkowski difference: its position, and the vertices that it is the difference of (frame
/// 1).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CsoVertex {
    /// `on_1 - on_2`.
    pub w: DVec3,
    /// The point of shape 1.
    pub on_1: DVec3,
    /// The vertices of the two shapes.
    pub ids: [VertexId; 2],
}

impl CsoVertex {
    /// The point of shape 2, in frame 1.
    #[inline]
    pub fn on_2(&self) -> DVec3 {
        self.on_1 - self.w
    }
}
