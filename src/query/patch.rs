//! The whole region of a contact.

use glam::DVec3;

use super::contact_id::ContactId;
use super::feature::Feature;

/// The region in which two shapes touch, overlap, or are within a distance of each other: the polygon where
/// their meeting faces lie over each other. A contact manifold keeps at most four of its corners.
///
/// Everything is in frame 1, that of the first shape. Make one with [`ContactPatch::between`].
#[derive(Clone, Debug)]
pub struct ContactPatch {
    /// The unit contact normal, from shape 1 to shape 2.
    pub normal: DVec3,
    /// Where the shapes are nearest, or overlap most: the answer of
    /// [`contact`](parry3d::query::QueryDispatcher::contact).
    pub deepest: PatchVertex,
    /// The corners, counter-clockwise seen from shape 2. A contact along a line has two, and a contact in a
    /// point has one, which is the deepest.
    pub vertices: Vec<PatchVertex>,
    /// The area of the polygon, seen along the normal. Zero for lines and points.
    pub area: f64,
    /// The centre of its area, on the surface of shape 1; for a line, its middle.
    pub center: DVec3,
}

/// A place where the shapes meet.
#[derive(Clone, Copy, Debug)]
pub struct PatchVertex {
    /// The point on shape 1. The point on shape 2 is `distance` farther along the normal.
    pub on_1: DVec3,
    /// The distance from shape 1 to shape 2 along the normal; negative where they overlap.
    pub distance: f64,
    /// The features that meet there.
    pub features: [Feature; 2],
    /// The id, which stays the same from frame to frame.
    pub id: ContactId,
}

impl ContactPatch {
    pub(crate) fn new(normal: DVec3, deepest: PatchVertex, mut vertices: Vec<PatchVertex>) -> Self {
        if vertices.is_empty() {
            vertices.push(deepest);
        }
        let first = vertices[0].on_1;
        let (mut area, mut moment) = (0.0, DVec3::ZERO);
        for side in vertices.windows(2) {
            let [a, b] = [side[0].on_1, side[1].on_1];
            let triangle = 0.5 * normal.dot((a - first).cross(b - first));
            area += triangle;
            moment += triangle * (first + a + b) / 3.0;
        }
        let center = if area > 0.0 {
            moment / area
        } else {
            vertices.iter().map(|vertex| vertex.on_1).sum::<DVec3>() / vertices.len() as f64
        };
        Self {
            normal,
            deepest,
            vertices,
            area,
            center,
        }
    }
}
