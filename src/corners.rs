//! The corners of a face.

use glam::{DVec3, Vec3};

use crate::ids::{EdgeId, VertexId};

/// The corners of a polygon in their order.
pub trait FacePoints: ExactSizeIterator<Item = DVec3> + DoubleEndedIterator + Clone {}

impl<T: ExactSizeIterator<Item = DVec3> + DoubleEndedIterator + Clone> FacePoints for T {}

/// A polygon that was looked up once: its corners, counter-clockwise seen from outside.
pub trait FaceCorners: Copy {
    /// The number of corners.
    fn count(self) -> usize;

    /// The `i`-th vertex.
    fn vertex(self, i: usize) -> VertexId;

    /// Its position in f32.
    fn point(self, i: usize) -> Vec3;

    /// The id of the edge from there to the next vertex.
    fn edge(self, i: usize) -> Option<EdgeId>;
}
