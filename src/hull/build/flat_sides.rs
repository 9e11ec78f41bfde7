//! A triangulation of our own for flat sides, so that a hull does not depend on the triangulation in the
//! input.
//!
//! The triangulation of a flat side says nothing about the shape, but edge ids depend on it. If it differed
//! whenever a shape is rebuilt, every edge would have to be compared to find out whether a prepared hull
//! still fits.

use glam::DVec3;

use super::half_edge::{HalfEdge, HalfEdgeMesh, next, triangle as triangle_of};
use crate::at::At;
use crate::hull::lists::Rows;
use crate::tolerance::{BENT_EDGE, FLAT_EDGE, FLAT_SIDE};

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

    /// The sides of a triangulated surface. `None` if they are ambiguous: a side is not a strictly convex polygon,
    /// or it is hardly flat, or hardly bent at its border.
    pub fn of_triangles(points: &[DVec3], triangles: &[[u32; 3]], radius: f64) -> Option<Self> {
        let mesh = HalfEdgeMesh::new(points.len(), triangles).ok()?;
        let sides = Sides::new(points, &mesh, radius)?;
        let mut flat = Self::with_capacity(points.len(), sides.polygons.len(), triangles.len())?;
        for polygon in &sides.polygons {
            flat.push(polygon);
        }
        Some(flat)
    }

    /// Adds a face, which begins at its lowest corner.
    pub fn push(&mut self, polygon: &[u32]) {
        self.triangles.extend(triangle_strip(polygon));
        if polygon.len() > 3 {
            self.polygons.push(polygon.iter().copied());
        }
    }
}

/// The flat polygons of a surface.
struct Sides<'a> {
    points: &'a [DVec3],
    mesh: &'a HalfEdgeMesh<'a>,
    radius: f64,
    polygons: Vec<Vec<u32>>,
    /// For each half-edge between polygons.
    borders: Vec<SideBorder>,
    /// For each corner of the current polygon, the border half-edge that starts there.
    outgoing: Vec<HalfEdge>,
}

impl<'a> Sides<'a> {
    fn new(points: &'a [DVec3], mesh: &'a HalfEdgeMesh<'a>, radius: f64) -> Option<Self> {
        let half_edges = 3 * mesh.triangles.len();
        let mut sides = Self {
            points,
            mesh,
            radius,
            polygons: Vec::with_capacity(mesh.triangles.len()),
            borders: vec![SideBorder::default(); half_edges],
            outgoing: vec![0; points.len()],
        };
        // Each edge once.
        let edges = || (0..half_edges as HalfEdge).filter(|&h| h < mesh.twin(h));
        let mut is_flat = vec![false; half_edges];
        for h in edges().filter(|&h| sides.is_flat(h)) {
            *is_flat.at_mut(h) = true;
            *is_flat.at_mut(mesh.twin(h)) = true;
        }
        let mut seen = vec![false; mesh.triangles.len()];
        for t in 0..seen.len() {
            if !seen[t] {
                sides.add(t, &is_flat, &mut seen)?;
            }
        }
        let all_bend = edges().all(|h| is_flat.at(h) || sides.bends(h));
        all_bend.then_some(sides)
    }

    fn along(&self, h: HalfEdge) -> DVec3 {
        self.points.at(self.mesh.end(h)) - self.points.at(self.mesh.start(h))
    }

    /// Whether the surface hardly bends at an edge.
    fn is_flat(&self, h: HalfEdge) -> bool {
        let from = self.points.at(self.mesh.start(h));
        let third = |h| self.points.at(self.mesh.end(next(h))) - from;
        let twin = self.mesh.twin(h);
        let (before, after) = (
            third(twin).cross(self.along(h)),
            self.along(h).cross(third(h)),
        );
        let area = before.length_squared().max(after.length_squared()).sqrt();
        before.dot(third(h)).abs() <= FLAT_EDGE * self.radius * area
    }

    /// The border of the polygon around a triangle, counter-clockwise from the lowest corner.
    fn border(
        &mut self,
        triangle: usize,
        is_flat: &[bool],
        seen: &mut [bool],
    ) -> Option<Vec<HalfEdge>> {
        let (mut stack, mut border) = (vec![triangle], Vec::new());
        let mut count = 0;
        seen[triangle] = true;
        while let Some(t) = stack.pop() {
            count += 1;
            for h in self.mesh.sides_of(t) {
                let beside = triangle_of(self.mesh.twin(h));
                if !is_flat.at(h) {
                    border.push(h);
                } else if !std::mem::replace(&mut seen[beside], true) {
                    stack.push(beside);
                }
            }
        }
        // Only a polygon without holes and without corners inside has this many triangles.
        if border.len() != count + 2 {
            return None;
        }
        self.sort(&mut border)?;
        Some(border)
    }

    /// Adds the polygon around a triangle.
    fn add(&mut self, triangle: usize, is_flat: &[bool], seen: &mut [bool]) -> Option<()> {
        let border = self.border(triangle, is_flat, seen)?;
        let polygon: Vec<u32> = border.iter().map(|&h| self.mesh.start(h)).collect();
        let normal = side_normal(self.points, &polygon, self.radius)?;
        for (i, &h) in border.iter().enumerate() {
            *self.borders.at_mut(h) = SideBorder::new(self.points, &polygon, i, normal)?;
        }
        self.polygons.push(polygon);
        Some(())
    }

    /// Sorts the border of a polygon counter-clockwise, starting from the lowest corner.
    fn sort(&mut self, border: &mut [HalfEdge]) -> Option<()> {
        for &h in &*border {
            *self.outgoing.at_mut(self.mesh.start(h)) = h;
        }
        let first = *border.iter().min_by_key(|&&h| self.mesh.start(h))?;
        let mut h = first;
        let count = border.len();
        for (i, place) in border.iter_mut().enumerate() {
            *place = h;
            h = self.outgoing.at(self.mesh.end(h));
            // A border that touches itself comes back too early.
            if (h == first) != (i + 1 == count) {
                return None;
            }
        }
        Some(())
    }

    /// Whether the surface bends between two polygons, however these are triangulated.
    fn bends(&self, h: HalfEdge) -> bool {
        let [here, there] = [h, self.mesh.twin(h)].map(|h| self.borders.at(h));
        here.bends(&there, self.radius)
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
