//! The search for the flat sides of a triangulated surface.

use std::mem;

use glam::DVec3;

use super::flat_sides::{FlatFaces, SideBorder, side_normal};
use super::half_edge::{HalfEdge, HalfEdgeMesh, next, triangle as triangle_of};
use crate::at::At;
use crate::tolerance::FLAT_EDGE;

impl FlatFaces {
    /// The sides of a triangulated surface. `None` if they are ambiguous: a side is not a strictly convex polygon,
    /// or it is hardly flat, or hardly bent at its border.
    pub fn of_triangles(points: &[DVec3], triangles: &[[u32; 3]], radius: f64) -> Option<Self> {
        let mesh = HalfEdgeMesh::new(points.len(), triangles).ok()?;
        Sides::new(points, &mesh, radius)?.find()
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
                } else if !mem::replace(&mut self.seen[beside], true) {
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
