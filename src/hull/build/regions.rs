//! Regions of a surface, each of which lies in one plane.

use glam::DVec3;

use super::area_vectors::AreaVectors;
use super::flat_edges::NearlyFlatEdges;
use super::half_edge::{HalfEdge, HalfEdgeMesh, next, triangle};
use crate::at::{At, to_u32};
use crate::hull::lists::largest_first;
use crate::tolerance::{FACE_ANGLE_COS, FACE_FLATNESS};

/// Sets of triangles, each of which lies in one plane.
pub(super) struct CoplanarRegions {
    /// The triangles, region by region, and the first triangle of each region.
    triangles: Vec<u32>,
    first: Vec<usize>,
    /// The region of each triangle; empty if all are alone.
    of: Vec<u32>,
}

/// How far a region has grown.
#[derive(PartialEq)]
enum Grown {
    /// Over all flat edges.
    Fully,
    /// Up to triangles beyond flat edges that are not in its plane.
    UpToOthers,
}

/// In no region: alone, or not yet.
const FREE: u32 = u32::MAX;

impl CoplanarRegions {
    /// Grows regions over flat edges, starting from the largest triangles, whose normals are the most
    /// reliable.
    pub fn grow(
        points: &[DVec3],
        mesh: &HalfEdgeMesh<'_>,
        surface: &AreaVectors,
        flat: &NearlyFlatEdges,
        radius: f64,
    ) -> Self {
        if flat.is_empty() {
            return Self::alone(0);
        }
        let mut regions = Self::alone(mesh.triangles.len());
        // Whether a triangle lies in the plane of some others.
        let joins = |some: &[u32]| {
            let (normal, center) = plane(points, mesh.triangles, surface, some);
            move |t: usize| {
                // The normal of a sliver is mere rounding, so its neighbours decide.
                let triangle = &surface.triangles[t];
                let turned = normal.dot(triangle.vector) < FACE_ANGLE_COS * triangle.area;
                let height = |v: u32| normal.dot(points.at(v) - center);
                let is_near = |&v: &u32| height(v).abs() <= FACE_FLATNESS * radius;
                (!turned || surface.is_sliver(points, mesh.triangles, t, radius))
                    && mesh.triangles[t].iter().all(is_near)
            }
        };
        let is_beside = |t: &u32| (3 * t..3 * t + 3).any(|side| flat.contains(side));
        let seeds = (0..regions.of.short_len()).filter(is_beside);
        for seed in largest_first(seeds, |t| surface.triangles.at(t).area) {
            if regions.of.at(seed) != FREE {
                continue;
            }
            // The corners of a small triangle are rounded, so its plane misses the far end of a large side.
            // The plane of all triangles found so far does not.
            if regions.add(mesh, flat, seed, joins(&[seed])) == Grown::UpToOthers
                && let Some(found) = regions.take_back()
            {
                regions.add(mesh, flat, seed, joins(&found));
            }
        }
        regions
    }

    /// No region yet of so many triangles.
    fn alone(count: usize) -> Self {
        let mut first = Vec::with_capacity(count + 1);
        first.push(0);
        Self {
            triangles: Vec::with_capacity(count),
            first,
            of: vec![FREE; count],
        }
    }

    /// The region of a triangle, unless it is alone.
    #[inline]
    pub fn of(&self, triangle: usize) -> Option<usize> {
        let region = *self.of.get(triangle)?;
        (region != FREE).then_some(region as usize)
    }

    /// Adds a region: the triangles that are connected with `seed` by flat edges and lie in its plane.
    fn add(
        &mut self,
        mesh: &HalfEdgeMesh<'_>,
        flat: &NearlyFlatEdges,
        seed: u32,
        joins: impl Fn(usize) -> bool,
    ) -> Grown {
        let region = self.next_id();
        let mut grown = Grown::Fully;
        let mut at = self.triangles.len();
        *self.of.at_mut(seed) = region;
        self.triangles.push(seed);
        while let Some(&t) = self.triangles.get(at) {
            for side in 3 * t..3 * t + 3 {
                let other = triangle(mesh.twin(side));
                if !flat.contains(side) || self.of[other] != FREE {
                    continue;
                }
                if joins(other) {
                    self.of[other] = region;
                    self.triangles.push(to_u32(other));
                } else {
                    grown = Grown::UpToOthers;
                }
            }
            at += 1;
        }
        self.first.push(self.triangles.len());
        grown
    }

    /// Dissolves the last region, unless it is only its seed.
    fn take_back(&mut self) -> Option<Vec<u32>> {
        let region = self.len() - 1;
        let start = self.first[region];
        if self.triangles.len() - start == 1 {
            return None;
        }
        self.first.pop();
        let found = self.triangles.split_off(start);
        for &t in &found {
            *self.of.at_mut(t) = FREE;
        }
        Some(found)
    }

    pub fn len(&self) -> usize {
        self.first.len() - 1
    }

    /// The number of the region that is added next.
    fn next_id(&self) -> u32 {
        self.first.short_len() - 1
    }

    pub fn triangles(&self, region: usize) -> &[u32] {
        &self.triangles[self.first[region]..self.first[region + 1]]
    }

    /// Writes the sides around a region to `polygon`, from the lowest vertex on. `false` if they are not a single
    /// loop.
    pub fn boundary(
        &self,
        mesh: &HalfEdgeMesh<'_>,
        region: &[u32],
        polygon: &mut Vec<HalfEdge>,
    ) -> bool {
        let inner = |side: HalfEdge| {
            let [here, beyond] = [side, mesh.twin(side)].map(|h| self.of[triangle(h)]);
            here == beyond
        };
        let sides = region.iter().flat_map(|&t| 3 * t..3 * t + 3);
        let mut outer = sides.filter(|&side| !inner(side));
        polygon.clear();
        let Some(start) = outer.next() else {
            return false; // the whole surface
        };
        let mut side = start;
        loop {
            polygon.push(side);
            side = next(side);
            while inner(side) {
                side = next(mesh.twin(side));
            }
            if side == start {
                break;
            }
        }
        let places = 0..polygon.len();
        let lowest = places.min_by_key(|&place| mesh.start(polygon[place]));
        polygon.rotate_left(lowest.unwrap_or(0));
        polygon.len() == 1 + outer.count()
    }
}

/// The plane of some triangles: its normal, and the centroid of the triangles.
fn plane(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    surface: &AreaVectors,
    some: &[u32],
) -> (DVec3, DVec3) {
    let (mut normal, mut moment, mut area) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for &t in some {
        let [a, b, c] = triangles.at(t).map(|v| points.at(v));
        let weight = surface.triangles.at(t).area;
        normal += surface.triangles.at(t).vector;
        moment += (a + b + c) * (weight / 3.0);
        area += weight;
    }
    (
        normal.normalize_or_zero(),
        moment / area.max(f64::MIN_POSITIVE),
    )
}
