//! Joining coplanar triangles to faces.

use std::{iter, mem};

use glam::{DVec3, Vec3};

use super::clusters::grow_clusters;
use super::half_edge::{HalfEdge, HalfEdgeMesh};
use super::regions::CoplanarRegions;
use crate::hull::clusters::FaceClusters;
use crate::hull::faces::{FaceCorner, FaceRecord, Faces, IN_CLUSTER, NO_EDGE};
use crate::hull::graph::EdgeGraph;
use crate::tolerance::FACE_FLATNESS;

/// What became of triangles.
pub(in crate::hull) struct MergedFaces {
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
        let clusters = grow_clusters(points, self, graph, &merged.largest_first);
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

/// The area vector of a polygon, normalised (Newell's method, about its first vertex).
fn polygon_normal(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, polygon: &[HalfEdge]) -> DVec3 {
    let at = |i: usize| points[mesh.start(polygon[i]) as usize];
    let origin = at(0);
    let sum: DVec3 = (1..polygon.len() - 1)
        .map(|i| (at(i) - origin).cross(at(i + 1) - origin))
        .sum();
    sum.normalize_or(DVec3::Z)
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
