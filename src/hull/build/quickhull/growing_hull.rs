//! A hull that grows point by point.

use std::mem;

use glam::DVec3;

use super::facet::{HullFacet, NONE};
use super::orientation::ExactPlane;
use crate::at::{At, to_u32};
use crate::hull::HullError;
use crate::hull::build::validate::MAX_VERTICES;

/// The triangles of a hull of the most vertices.
const MOST_FACETS: usize = 2 * MAX_VERTICES - 4;

/// About so many facets are added for each corner, most of which are removed again.
const FACETS_PER_POINT: usize = 6;
/// Most of so few points are corners. Of more points, most are often inside.
const MOSTLY_CORNERS: usize = 64;

/// An edge of the horizon, as the visible facet has it, with the facet beyond, which is not visible.
struct HorizonEdge {
    from: u32,
    to: u32,
    beyond: u32,
}

pub(super) struct GrowingHull<'a> {
    points: &'a [DVec3],
    /// The greatest differences between points, in each coordinate.
    extent: DVec3,
    facets: Vec<HullFacet>,
    /// How many of the facets were removed.
    removed: usize,
    /// The new facet whose side on the horizon starts at a vertex.
    starting_at: Vec<u32>,
    /// For each point of an outside set, the one before it, or `NONE`.
    before: Vec<u32>,
}

/// The greatest of the measures of points, and the first point that has it.
fn farthest(points: &[DVec3], measure: impl Fn(DVec3) -> f64) -> (f64, usize) {
    let measured = points.iter().map(|&p| measure(p)).zip(0..);
    measured.fold((f64::NEG_INFINITY, 0), |best, next| {
        if next.0 > best.0 { next } else { best }
    })
}

impl<'a> GrowingHull<'a> {
    pub fn tetrahedron(points: &'a [DVec3]) -> Result<Self, HullError> {
        let a = farthest(points, |p| -p.x).1;
        let b = farthest(points, |p| p.distance_squared(points[a])).1;
        let along = points[b] - points[a];
        let c = farthest(points, |p| along.cross(p - points[a]).length_squared()).1;
        let [least, most] = [DVec3::min, DVec3::max].map(|f| points.iter().copied().reduce(f));
        let extent = least
            .zip(most)
            .map_or(DVec3::ZERO, |(least, most)| most - least);
        let base = ExactPlane::new([a, b, c].map(|v| points[v]), extent);
        let (height, d) = farthest(points, |p| base.height(p).abs());
        if height == 0.0 {
            return Err(HullError::Flat);
        }
        let is_beneath = base.height(points[d]) < 0.0;
        let [b, c] = if is_beneath { [b, c] } else { [c, b] };
        let [a, b, c, d] = [a, b, c, d].map(to_u32);
        let mut surface = Self {
            points,
            extent,
            facets: Vec::with_capacity(FACETS_PER_POINT * points.len().min(MOSTLY_CORNERS)),
            removed: 0,
            starting_at: vec![0; points.len()],
            before: vec![NONE; points.len()],
        };
        surface.add([a, b, c], [1, 2, 3]);
        surface.add([a, d, b], [3, 2, 0]);
        surface.add([b, d, c], [1, 3, 0]);
        surface.add([c, d, a], [2, 1, 0]);
        for point in (0..points.short_len()).filter(|point| ![a, b, c, d].contains(point)) {
            surface.assign(point, 0);
        }
        Ok(surface)
    }

    fn add(&mut self, vertices: [u32; 3], beyond: [u32; 3]) {
        let plane = ExactPlane::new(vertices.map(|v| self.points.at(v)), self.extent);
        self.facets.push(HullFacet::new(vertices, plane, beyond));
    }

    fn height(&self, facet: u32, point: u32) -> f64 {
        self.facet(facet).plane.height(self.points.at(point))
    }

    /// The number of facets of the surface.
    pub fn facet_count(&self) -> usize {
        self.facets.len() - self.removed
    }

    /// The facets of the surface.
    pub fn surface(&self) -> impl Iterator<Item = &HullFacet> {
        self.facets.iter().filter(|facet| !facet.is_removed)
    }

    fn facet(&self, id: u32) -> &HullFacet {
        self.facets.at_ref(id)
    }

    fn facet_mut(&mut self, id: u32) -> &mut HullFacet {
        self.facets.at_mut(id)
    }

    /// Assigns a point to the first facet, from `first` on, that it is above, if there is one.
    fn assign(&mut self, point: u32, first: usize) {
        let at = self.points.at(point);
        for facet in &mut self.facets[first..] {
            let height = facet.plane.height(at);
            if height > 0.0 {
                facet.raise_peak(point, height, self.points);
                *self.before.at_mut(point) = mem::replace(&mut facet.last_above, point);
                return;
            }
        }
    }

    /// Expands the hull to all points that are above a facet.
    pub fn grow(&mut self) -> Result<(), HullError> {
        let (mut horizon, mut seen, mut unassigned) = (Vec::new(), Vec::new(), Vec::new());
        let mut facet = 0;
        while facet < self.facets.len() {
            if self.facets[facet].last_above != NONE {
                let eye = self.facets[facet].peak.1;
                self.remove_seen(eye, to_u32(facet), &mut horizon, &mut seen);
                self.removed += seen.len();
                let first = self.facets.len();
                self.close(eye, &horizon);
                if self.facet_count() > MOST_FACETS {
                    return Err(HullError::TooManyPoints);
                }
                for &facet in &seen {
                    let mut point = mem::replace(&mut self.facet_mut(facet).last_above, NONE);
                    while point != NONE {
                        unassigned.push(point);
                        point = self.before.at(point);
                    }
                }
                // The eye is a corner now.
                for point in unassigned.drain(..).filter(|&point| point != eye) {
                    self.assign(point, first);
                }
            }
            facet += 1;
        }
        Ok(())
    }

    /// Removes all facets that a point sees, starting from one of them, and leaves the edges around them in
    /// `horizon`.
    fn remove_seen(
        &mut self,
        eye: u32,
        facet: u32,
        horizon: &mut Vec<HorizonEdge>,
        seen: &mut Vec<u32>,
    ) {
        horizon.clear();
        seen.clear();
        seen.push(facet);
        self.facet_mut(facet).is_removed = true;
        let mut next = 0;
        while let Some(&facet) = seen.get(next) {
            let HullFacet {
                vertices, beyond, ..
            } = *self.facet(facet);
            for side in 0..3 {
                let other = beyond[side];
                if self.facet(other).is_removed {
                    continue;
                }
                if self.height(other, eye) > 0.0 {
                    self.facet_mut(other).is_removed = true;
                    seen.push(other);
                } else {
                    horizon.push(HorizonEdge {
                        from: vertices[side],
                        to: vertices[(side + 1) % 3],
                        beyond: other,
                    });
                }
            }
            next += 1;
        }
    }

    /// Adds facets between a point and the horizon.
    fn close(&mut self, eye: u32, horizon: &[HorizonEdge]) {
        let first = self.facets.short_len();
        for (id, edge) in (first..).zip(horizon) {
            self.add([edge.from, edge.to, eye], [edge.beyond, 0, 0]);
            *self.starting_at.at_mut(edge.from) = id;
            let other = self.facet_mut(edge.beyond);
            let side = other.vertices.iter().position(|&v| v == edge.to);
            other.beyond[side.expect("it has this edge")] = id;
        }
        for (id, edge) in (first..).zip(horizon) {
            let next = self.starting_at.at(edge.to);
            self.facet_mut(id).beyond[1] = next;
            self.facet_mut(next).beyond[2] = id;
        }
    }

    /// At how many edges of each vertex the surface bends, and whether it seems to be flat somewhere.
    pub fn bends(&self) -> (Vec<u32>, bool) {
        let (mut bends, mut seems_flat) = (vec![0; self.points.len()], false);
        for (id, facet) in (0..).zip(&self.facets) {
            let others = facet.beyond.iter().enumerate();
            let each_once = |&(_, &other): &(usize, &u32)| !facet.is_removed && id < other;
            for (side, &other) in others.filter(each_once) {
                let ends = [facet.vertices[side], facet.vertices[(side + 1) % 3]];
                let across = self.facet(other).vertices;
                let third = across.into_iter().find(|v| !ends.contains(v));
                let third = third.expect("it shares only two");
                let height = self.height(id, third);
                if height < 0.0 {
                    ends.iter().for_each(|&v| *bends.at_mut(v) += 1);
                }
                seems_flat |= facet.plane.seems_to_contain(self.points.at(third), height);
            }
        }
        (bends, seems_flat)
    }
}
