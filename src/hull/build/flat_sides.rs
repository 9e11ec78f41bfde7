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
        Sides::new(points, &mesh, radius)?.find()
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
    /// For each half-edge, whether the surface hardly bends there.
    is_flat: Vec<bool>,
    found: FlatFaces,
    /// For each half-edge between polygons.
    borders: Vec<SideBorder>,
    /// The border of the current polygon, and its corners.
    border: Vec<HalfEdge>,
    polygon: Vec<u32>,
    /// For each corner of the current polygon, the border half-edge that starts there.
    outgoing: Vec<HalfEdge>,
    /// Triangles of the current polygon whose neighbours have not been looked at, and those of all polygons.
    stack: Vec<usize>,
    seen: Vec<bool>,
}

impl<'a> Sides<'a> {
    fn new(points: &'a [DVec3], mesh: &'a HalfEdgeMesh<'a>, radius: f64) -> Option<Self> {
        let half_edges = 3 * mesh.triangles.len();
        Some(Self {
            points,
            mesh,
            radius,
            is_flat: vec![false; half_edges],
            found: FlatFaces::with_capacity(points.len(), mesh.triangles.len(), half_edges)?,
            borders: vec![SideBorder::default(); half_edges],
            border: Vec::with_capacity(points.len()),
            polygon: Vec::with_capacity(points.len()),
            outgoing: vec![0; points.len()],
            stack: Vec::with_capacity(mesh.triangles.len()),
            seen: vec![false; mesh.triangles.len()],
        })
    }

    fn find(mut self) -> Option<FlatFaces> {
        let mesh = self.mesh;
        let half_edges = self.is_flat.short_len();
        // Each edge once.
        let edges = || (0..half_edges).filter(|&h| h < mesh.twin(h));
        for h in edges() {
            let is_flat = self.is_flat(h);
            *self.is_flat.at_mut(h) = is_flat;
            *self.is_flat.at_mut(mesh.twin(h)) = is_flat;
        }
        for triangle in 0..mesh.triangles.len() {
            if !self.seen[triangle] {
                self.add(triangle)?;
            }
        }
        let all_bend = edges().all(|h| self.is_flat.at(h) || self.bends(h));
        all_bend.then_some(self.found)
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

    /// Finds the border of the polygon around a triangle, counter-clockwise from the lowest corner.
    fn find_border(&mut self, triangle: usize) -> Option<()> {
        let mut count = 0;
        self.border.clear();
        self.stack.push(triangle);
        self.seen[triangle] = true;
        while let Some(t) = self.stack.pop() {
            count += 1;
            for h in self.mesh.sides_of(t) {
                let beside = triangle_of(self.mesh.twin(h));
                if !self.is_flat.at(h) {
                    self.border.push(h);
                } else if !std::mem::replace(&mut self.seen[beside], true) {
                    self.stack.push(beside);
                }
            }
        }
        // Only a polygon without holes and without corners inside has this many triangles.
        (self.border.len() == count + 2).then_some(())?;
        self.sort_border()
    }

    /// Adds the polygon around a triangle.
    fn add(&mut self, triangle: usize) -> Option<()> {
        self.find_border(triangle)?;
        let corners = self.border.iter().map(|&h| self.mesh.start(h));
        self.polygon.clear();
        self.polygon.extend(corners);
        let normal = side_normal(self.points, &self.polygon, self.radius)?;
        for (i, &h) in self.border.iter().enumerate() {
            *self.borders.at_mut(h) = SideBorder::new(self.points, &self.polygon, i, normal)?;
        }
        self.found.push(&self.polygon);
        Some(())
    }

    /// Sorts the border of a polygon counter-clockwise, starting from the lowest corner.
    fn sort_border(&mut self) -> Option<()> {
        for &h in &self.border {
            *self.outgoing.at_mut(self.mesh.start(h)) = h;
        }
        let first = *self.border.iter().min_by_key(|&&h| self.mesh.start(h))?;
        let mut h = first;
        let count = self.border.len();
        for (i, place) in self.border.iter_mut().enumerate() {
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
