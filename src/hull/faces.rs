//! Faces of a hull: coplanar triangles joined to polygons, with their planes.

use std::cmp::Reverse;
use std::{iter, mem};

use glam::{DVec3, Vec3};

use super::build::half_edge::{HalfEdge, HalfEdgeMesh, next, triangle};
use super::clusters::{self, FaceClusters};
use super::graph::{EdgeGraph, pack_edge};
use crate::support::FaceId;
use crate::tolerance::{FACE_ANGLE_COS, FACE_FLATNESS, MIN_TRIANGLE_HEIGHT};

/// The faces and, after them, the outlines of the clusters.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    /// With one more to end the last one's corners.
    polygons: Box<[FaceRecord]>,
    count: usize,
    corners: Box<[FaceCorner]>,
    clusters: FaceClusters,
}

/// A face with its supporting plane, or an outline. What is read together lies together: large
/// hulls are not in the nearest cache.
#[derive(Clone, Copy, Debug)]
struct FaceRecord {
    /// Rounded to f32; the offset is exact for that normal.
    normal: Vec3,
    /// Its first corner; the others follow up to the next polygon's first. With a mark.
    first: u32,
    offset: f64,
}

/// The mark of a face that belongs to a cluster, so that of the others, which are most, nothing more need be
/// read. No hull has so many corners.
const IN_CLUSTER: u32 = 1 << 31;

impl FaceRecord {
    #[inline]
    fn first(&self) -> usize {
        (self.first & !IN_CLUSTER) as usize
    }
}

/// A corner of a polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceCorner {
    pub vertex: u16,
    /// Of the side that starts here, what the id of that edge has beside its lower vertex.
    slot: u16,
}

/// The side of an outline that cuts across faces.
const NO_EDGE: u16 = u16::MAX;

/// What became of triangles.
pub(super) struct MergedFaces {
    /// The face that each of them went to.
    pub face_of: Vec<u16>,
    /// The faces by their largest triangles.
    largest_first: Vec<u16>,
}

/// A supporting plane.
struct FacePlane {
    normal: Vec3,
    offset: f64,
}

impl FacePlane {
    /// That of a sliver whose direction is rounding only: no plane of the hull, and farther out
    /// than any. Outlines have none either.
    const NONE: Self = Self {
        normal: Vec3::ZERO,
        offset: f64::INFINITY,
    };

    /// Through the outermost of the polygon's corners and their neighbours: on a convex hull no
    /// vertex is farther out.
    fn new(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, polygon: &[HalfEdge], radius: f64) -> Self {
        let normal = polygon_normal(points, mesh, polygon).as_vec3();
        let direction = normal.as_dvec3();
        let height = |v: u32| direction.dot(points[v as usize]);
        let (mut lowest, mut offset) = (f64::INFINITY, f64::NEG_INFINITY);
        for &side in polygon {
            let corner = mesh.start(side);
            let level = height(corner);
            lowest = lowest.min(level);
            offset = offset.max(level);
            for side in mesh.outgoing(corner) {
                let level = height(side.to.into());
                // No value is NaN here, so the NaN check of `f64::max` is not needed.
                offset = if level > offset { level } else { offset };
            }
        }
        if offset - lowest > 2.0 * FACE_FLATNESS * radius {
            Self::NONE
        } else {
            Self { normal, offset }
        }
    }
}

impl Faces {
    /// Joins the triangles of a surface. The faces are in the order of their first triangles, so that
    /// those around a vertex lie together where triangles do.
    pub fn new(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, radius: f64) -> (Self, MergedFaces) {
        let count = mesh.triangles.len();
        let regions = CoplanarRegions::grow(points, mesh, radius);
        let mut face_of = vec![0_u16; count];
        let mut faces = Builder::with_capacity(count);
        let mut faces_of = vec![0..0; regions.len()];
        let mut add = |polygon: &[HalfEdge], triangles: &[u32]| {
            for &t in triangles {
                face_of[t as usize] = faces.polygons.len() as u16;
            }
            let corner = |&side: &HalfEdge| FaceCorner {
                vertex: mesh.start(side) as u16,
                slot: mesh.edge_slot(side),
            };
            let plane = FacePlane::new(points, mesh, polygon, radius);
            faces.add(&plane, polygon.iter().map(corner));
        };
        let mut polygon = Vec::new();
        let mut face_count = 0;
        for &r in &regions.of {
            if !faces_of[r as usize].is_empty() {
                continue;
            }
            let region = regions.triangles(r as usize);
            let merged = region.len() > 1
                && regions.boundary(mesh, region, &mut polygon)
                && is_convex(points, mesh, &polygon, radius);
            let first = face_count;
            if merged {
                add(&polygon, region);
                face_count += 1;
            } else {
                // Triangle by triangle where it is not one convex polygon.
                for &t in region {
                    add(&[3 * t, 3 * t + 1, 3 * t + 2], &[t]);
                    face_count += 1;
                }
            }
            faces_of[r as usize] = first..face_count;
        }
        let merged = MergedFaces {
            face_of,
            largest_first: faces_of.into_iter().flatten().collect(),
        };
        (
            faces.finish(face_count.into(), FaceClusters::default()),
            merged,
        )
    }

    /// Finds the clusters, when the `graph` knows the faces.
    pub fn add_clusters(&mut self, points: &[DVec3], graph: &EdgeGraph, merged: &MergedFaces) {
        let clusters = clusters::grow_clusters(points, self, graph, &merged.largest_first);
        if clusters.is_empty() {
            return;
        }
        let mut faces = Builder {
            polygons: mem::take(&mut self.polygons).into_vec(),
            corners: mem::take(&mut self.corners).into_vec(),
        };
        faces.polygons.pop();
        for cluster in &clusters {
            for &member in &cluster.members {
                faces.polygons[usize::from(member)].first |= IN_CLUSTER;
            }
            let ends = cluster.outline.iter().cycle().skip(1);
            let corner = |(&from, &to): (&u16, &u16)| FaceCorner {
                vertex: from,
                slot: graph.edge_slot(from.into(), to.into()).unwrap_or(NO_EDGE),
            };
            faces.add(
                &FacePlane::NONE,
                cluster.outline.iter().zip(ends).map(corner),
            );
        }
        *self = faces.finish(self.count, FaceClusters::new(&clusters, self.count));
    }

    pub fn len(&self) -> usize {
        self.count
    }

    #[inline]
    pub fn normal(&self, face: FaceId) -> DVec3 {
        self.polygons[face as usize].normal.as_dvec3()
    }

    #[inline]
    pub fn offset(&self, face: FaceId) -> f64 {
        self.polygons[face as usize].offset
    }

    /// The corners of a face or of an outline.
    #[inline]
    pub fn polygon(&self, face: FaceId) -> &[FaceCorner] {
        let f = face as usize;
        &self.corners[self.polygons[f].first()..self.polygons[f + 1].first()]
    }

    /// The id of the `i`-th edge of a face, or of an outline where that is an edge.
    #[inline]
    pub fn edge(&self, face: FaceId, i: usize) -> Option<u32> {
        let corners = self.polygon(face);
        let FaceCorner { vertex, slot } = corners[i];
        let next = corners[if i + 1 < corners.len() { i + 1 } else { 0 }].vertex;
        (slot != NO_EDGE).then(|| pack_edge(vertex.min(next).into(), slot))
    }

    /// The cluster around a face: the id of its outline, and the faces under that.
    #[inline]
    pub fn cluster(&self, face: FaceId) -> Option<(FaceId, &[u16])> {
        if self.polygons[face as usize].first & IN_CLUSTER == 0 {
            return None;
        }
        let (cluster, faces) = self.clusters.containing(face);
        Some(((self.len() + cluster) as FaceId, faces))
    }

    /// Of these faces the one that looks most in direction `dir`.
    #[inline]
    pub fn most_aligned<const N: usize>(
        &self,
        candidates: impl IntoIterator<Item = [u16; N]>,
        dir: DVec3,
    ) -> FaceId {
        let (mut best, mut most) = (0, f64::NEG_INFINITY);
        for faces in candidates {
            for face in faces {
                let aligned = self.normal(face.into()).dot(dir);
                // Selections: which face it will be is not predictable.
                let better = aligned > most;
                most = if better { aligned } else { most };
                best = if better { face } else { best };
            }
        }
        best.into()
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.polygons) + size_of_val(&*self.corners) + self.clusters.heap_bytes()
    }
}

/// Polygons one after the other.
struct Builder {
    polygons: Vec<FaceRecord>,
    corners: Vec<FaceCorner>,
}

impl Builder {
    fn with_capacity(triangles: usize) -> Self {
        Self {
            polygons: Vec::with_capacity(triangles + 1),
            corners: Vec::with_capacity(3 * triangles),
        }
    }

    fn add(&mut self, plane: &FacePlane, corners: impl Iterator<Item = FaceCorner>) {
        self.polygons.push(FaceRecord {
            normal: plane.normal,
            first: self.corners.len() as u32,
            offset: plane.offset,
        });
        self.corners.extend(corners);
    }

    /// The first `count` polygons are faces, the others outlines of clusters.
    fn finish(mut self, count: usize, clusters: FaceClusters) -> Faces {
        self.add(&FacePlane::NONE, iter::empty());
        Faces {
            polygons: self.polygons.into(),
            count,
            corners: self.corners.into(),
            clusters,
        }
    }
}

/// Twice the area vector of a triangle.
pub(super) fn area_vector(points: &[DVec3], triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|v| points[v as usize]);
    (b - a).cross(c - a)
}

pub(super) fn longest_side(points: &[DVec3], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|v| points[v as usize]);
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

/// The area vector of a polygon, normalised (Newell's method, about its first vertex).
fn polygon_normal(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, polygon: &[HalfEdge]) -> DVec3 {
    let at = |i: usize| points[mesh.start(polygon[i]) as usize];
    let origin = at(0);
    let sum: DVec3 = (1..polygon.len() - 1)
        .map(|i| (at(i) - origin).cross(at(i + 1) - origin))
        .sum();
    sum.normalize_or(DVec3::Z)
}

/// Sets of triangles that lie in one plane each.
struct CoplanarRegions {
    /// The triangles, region by region, and where the regions begin.
    triangles: Vec<u32>,
    first: Vec<usize>,
    /// The region of each triangle.
    of: Vec<u32>,
}

/// In no region yet.
const FREE: u32 = u32::MAX;

impl CoplanarRegions {
    /// Grows from the largest triangles, whose normals are the most reliable.
    fn grow(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, radius: f64) -> Self {
        let triangles = mesh.triangles;
        let vectors: Vec<DVec3> = triangles.iter().map(|&t| area_vector(points, t)).collect();
        let areas: Vec<f64> = vectors.iter().map(|vector| vector.length()).collect();
        // The bits of numbers that are not negative are in their order.
        let largest_first = |area: &f64| Reverse(area.to_bits());
        let mut seeds: Vec<_> = areas.iter().map(largest_first).zip(0..).collect();
        seeds.sort_unstable();
        let mut regions = Self {
            triangles: Vec::with_capacity(triangles.len()),
            first: vec![0],
            of: vec![FREE; triangles.len()],
        };
        let (vectors, areas) = (&vectors, &areas);
        // Whether a triangle lies in the plane of some others.
        let joins = |some: &[u32]| {
            let (normal, center) = plane(points, triangles, vectors, some);
            move |t: usize| {
                // The direction of a sliver is rounding only; its neighbours decide.
                let turned = normal.dot(vectors[t]) < FACE_ANGLE_COS * areas[t];
                let sliver = || {
                    areas[t] <= MIN_TRIANGLE_HEIGHT * radius * longest_side(points, triangles[t])
                };
                let height = |v: u32| normal.dot(points[v as usize] - center);
                let flat = |&v: &u32| height(v).abs() <= FACE_FLATNESS * radius;
                (!turned || sliver()) && triangles[t].iter().all(flat)
            }
        };
        for (_, seed) in seeds {
            if regions.of[seed as usize] != FREE {
                continue;
            }
            regions.add(mesh, seed, joins(&[seed]));
            // The corners of a small triangle are rounded, so its plane leaves a large side at the
            // far end. The plane of all triangles that it found there does not.
            if let Some(found) = regions.take_back() {
                regions.add(mesh, seed, joins(&found));
            }
        }
        regions
    }

    /// A new region: the triangles that hang together with `seed` and join it.
    fn add(&mut self, mesh: &HalfEdgeMesh<'_>, seed: u32, joins: impl Fn(usize) -> bool) {
        let region = self.len() as u32;
        let mut at = self.triangles.len();
        self.of[seed as usize] = region;
        self.triangles.push(seed);
        while let Some(&t) = self.triangles.get(at) {
            for side in 3 * t..3 * t + 3 {
                let other = triangle(mesh.twin(side));
                if self.of[other] == FREE && joins(other) {
                    self.of[other] = region;
                    self.triangles.push(other as u32);
                }
            }
            at += 1;
        }
        self.first.push(self.triangles.len());
    }

    /// Takes the last region apart again, if it is more than its seed.
    fn take_back(&mut self) -> Option<Vec<u32>> {
        let region = self.len() - 1;
        let start = self.first[region];
        if self.triangles.len() - start == 1 {
            return None;
        }
        self.first.pop();
        let found = self.triangles.split_off(start);
        for &t in &found {
            self.of[t as usize] = FREE;
        }
        Some(found)
    }

    fn len(&self) -> usize {
        self.first.len() - 1
    }

    fn triangles(&self, region: usize) -> &[u32] {
        &self.triangles[self.first[region]..self.first[region + 1]]
    }

    /// Leaves the sides around a region in `polygon`; `false` if they are not one loop.
    fn boundary(
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
                return polygon.len() == 1 + outer.count();
            }
        }
    }
}

/// The plane of some triangles with these area vectors: its normal, and their centroid.
fn plane(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    vectors: &[DVec3],
    some: &[u32],
) -> (DVec3, DVec3) {
    let (mut normal, mut moment, mut area) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for &t in some {
        let [a, b, c] = triangles[t as usize].map(|v| points[v as usize]);
        let weight = vectors[t as usize].length();
        normal += vectors[t as usize];
        moment += (a + b + c) * (weight / 3.0);
        area += weight;
    }
    (
        normal.normalize_or_zero(),
        moment / area.max(f64::MIN_POSITIVE),
    )
}

/// Whether no corner is a dent, beyond rounding.
fn is_convex(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, polygon: &[HalfEdge], radius: f64) -> bool {
    let normal = polygon_normal(points, mesh, polygon);
    let count = polygon.len();
    let at = |i: usize| points[mesh.start(polygon[i % count]) as usize];
    (0..count).all(|i| {
        let (before, here, after) = (at(i), at(i + 1), at(i + 2));
        let chord = after - before;
        let outward = normal.dot((here - before).cross(chord));
        outward >= -FACE_FLATNESS * radius * chord.length()
    })
}
