//! A triangulation of our own for flat sides, so that a hull does not depend on the triangulation in the
//! input.
//!
//! The triangulation of a flat side says nothing about the shape, but edge ids depend on it. If it differed
//! whenever a shape is rebuilt, every edge would have to be compared to find out whether a prepared hull
//! still fits.

use glam::DVec3;

use crate::at::At;
use crate::hull::lists::Rows;
use crate::tolerance::{BENT_EDGE, FLAT_SIDE};

/// A surface by its flat sides.
pub(super) struct FlatFaces {
    /// The triangles of all faces, with diagonals that depend only on the points.
    pub triangles: Vec<[u32; 3]>,
    /// The faces with more than three corners, each from its lowest corner.
    pub polygons: Rows<u32>,
}

impl FlatFaces {
    /// Without faces yet, but with room for them. `None` if there are not enough points for a solid.
    pub fn with_capacity(points: usize, faces: usize, corners: usize) -> Option<Self> {
        Some(Self {
            triangles: Vec::with_capacity((2 * points).checked_sub(4)?),
            polygons: Rows::with_capacity(faces, corners),
        })
    }

    /// Adds a face, which begins at its lowest corner.
    pub fn push(&mut self, polygon: &[u32]) {
        self.triangles.extend(triangle_strip(polygon));
        if polygon.len() > 3 {
            self.polygons.push(polygon.iter().copied());
        }
    }
}

/// The normal of a polygon; `None` if it is not flat.
pub(super) fn side_normal(points: &[DVec3], polygon: &[u32], radius: f64) -> Option<DVec3> {
    let first = points.at(polygon[0]);
    let from_first = |v: u32| points.at(v) - first;
    let fan = polygon[1..]
        .windows(2)
        .map(|ends| from_first(ends[0]).cross(from_first(ends[1])));
    let normal = fan.sum::<DVec3>().try_normalize()?;
    let thickness = FLAT_SIDE * radius;
    let is_flat = polygon
        .iter()
        .all(|&v| from_first(v).dot(normal).abs() <= thickness);
    is_flat.then_some(normal)
}

/// The border of a flat polygon along one of its edges.
#[derive(Clone, Copy, Default)]
pub(super) struct SideBorder {
    /// Of the polygon.
    normal: DVec3,
    /// The distance from the edge to the nearest other corner.
    nearest: f64,
}

impl SideBorder {
    /// Along the edge that starts at a corner; `None` if the polygon is not strictly convex there.
    pub fn new(points: &[DVec3], polygon: &[u32], corner: usize, normal: DVec3) -> Option<Self> {
        let count = polygon.len();
        let at = |i: usize| points.at(polygon[if i < count { i } else { i - count }]);
        let from = at(corner);
        let inward = normal.cross(at(corner + 1) - from).try_normalize()?;
        let beside = |i: usize| (at(i) - from).dot(inward);
        let nearest = beside(corner + 2).min(beside(corner + count - 1));
        (nearest > 0.0).then_some(Self { normal, nearest })
    }

    /// Whether the surface bends between two polygons, however these are triangulated.
    pub fn bends(&self, other: &Self, radius: f64) -> bool {
        let nearest = self.nearest.min(other.nearest);
        nearest * self.normal.cross(other.normal).length() > BENT_EDGE * radius
    }
}

/// The triangle strip of a polygon that begins at its lowest corner, each triangle starting at its lowest corner.
/// Triangles are cut off from both ends in turn, so that no corner has many of them.
fn triangle_strip(polygon: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let (mut low, mut high) = (0, polygon.len() - 1);
    let mut is_low = false;
    std::iter::from_fn(move || {
        is_low = !is_low;
        let middle = if is_low { low + 1 } else { high - 1 };
        let triangle = [polygon[low], polygon[middle], polygon[high]];
        if high - low < 2 {
            return None;
        }
        if is_low {
            low = middle;
        } else {
            high = middle;
        }
        Some(from_lowest(triangle))
    })
}

/// A triangle from its lowest corner.
#[inline]
pub(super) fn from_lowest([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
