//! Merging coplanar triangles into faces.

use std::{iter, mem};

use glam::DVec3;

use super::clusters::grow_clusters;
use super::face_plane::{FacePlane, polygon_normal};
use super::flat_edges::{AreaVectors, NearlyFlatEdges};
use super::half_edge::{HalfEdge, HalfEdgeMesh, triangle};
use super::regions::CoplanarRegions;
use crate::hull::clusters::FaceClusters;
use crate::hull::faces::{FaceCorner, FaceRecord, Faces, IN_CLUSTER, NO_EDGE};
use crate::hull::graph::EdgeGraph;
use crate::support::FaceId;
use crate::tolerance::FACE_FLATNESS;

/// The result of merging triangles.
pub(in crate::hull) struct MergedFaces {
    /// The face of each triangle.
    pub face_of: Vec<u16>,
    /// The faces from which clusters may grow, ordered by their largest triangles.
    seeds: Vec<u16>,
    /// The faces with a neighbouring vertex that is higher than one of their corners.
    pub overtopped: Vec<u16>,
}

impl MergedFaces {
    /// Notes a face, and the triangles that it was made of.
    fn note(&mut self, face: u16, triangles: &[u32], plane: &FacePlane) {
        for &t in triangles {
            self.face_of[t as usize] = face;
        }
        if plane.is_overtopped {
            self.overtopped.push(face);
        }
    }
}

impl Faces {
    /// Merges the triangles of a surface. Faces are in the order of their first triangles, so that faces
    /// around a vertex lie as near in memory as the triangles do.
    pub fn new(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, radius: f64) -> (Self, MergedFaces) {
        let count = mesh.triangles.len();
        let surface = AreaVectors::new(points, mesh.triangles, radius);
        let flat = NearlyFlatEdges::new(mesh, &surface);
        let regions = CoplanarRegions::grow(points, mesh, &surface, &flat, radius);
        let mut merged = MergedFaces {
            face_of: vec![0; count],
            seeds: Vec::new(),
            overtopped: Vec::new(),
        };
        let mut faces = Builder::with_capacity(count);
        let mut faces_of = vec![0..0; regions.len()];
        let mut add = |polygon: &[HalfEdge], triangles: &[u32]| {
            let plane = FacePlane::new(points, mesh, polygon, radius);
            merged.note(faces.polygons.len() as u16, triangles, &plane);
            let corner = |&side: &HalfEdge| FaceCorner {
                vertex: mesh.start(side) as u16,
                slot: mesh.edge_slot(side),
            };
            faces.add(&plane, polygon.iter().map(corner));
        };
        let mut polygon = Vec::new();
        let mut face_count = 0;
        for &r in &regions.of {
            if !faces_of[r as usize].is_empty() {
                continue;
            }
            let region = regions.triangles(r as usize);
            let is_one_face = region.len() > 1
                && regions.boundary(mesh, region, &mut polygon)
                && is_convex(points, mesh, &polygon, radius);
            let first = face_count;
            if is_one_face {
                add(&polygon, region);
                face_count += 1;
            } else {
                // A region that is not a convex polygon becomes one face per triangle.
                for &t in region {
                    add(&[3 * t, 3 * t + 1, 3 * t + 2], &[t]);
                    face_count += 1;
                }
            }
            faces_of[r as usize] = first..face_count;
        }
        let faces = faces.finish(face_count.into(), FaceClusters::default());
        let largest_first = faces_of.into_iter().flatten();
        merged.seeds = faces.cluster_seeds(mesh, &flat, &merged.face_of, largest_first);
        (faces, merged)
    }

    /// The faces that have a nearly flat edge to another face.
    fn cluster_seeds(
        &self,
        mesh: &HalfEdgeMesh<'_>,
        flat: &NearlyFlatEdges,
        face_of: &[u16],
        largest_first: impl Iterator<Item = u16>,
    ) -> Vec<u16> {
        if flat.is_empty() {
            return Vec::new();
        }
        // A face without a plane may join any cluster.
        let has_planes = (0..self.len()).all(|face| self.normal(FaceId::new(face)) != DVec3::ZERO);
        let mut may_grow = vec![!has_planes; self.len()];
        for h in (0..3 * face_of.len() as HalfEdge).filter(|&h| flat.contains(h)) {
            let [here, beyond] = [h, mesh.twin(h)].map(|h| face_of[triangle(h)]);
            may_grow[usize::from(here)] |= here != beyond;
        }
        largest_first
            .filter(|&face| may_grow[usize::from(face)])
            .collect()
    }

    /// Finds the clusters. The `graph` must know the faces already.
    pub fn add_clusters(&mut self, points: &[DVec3], graph: &EdgeGraph, merged: &MergedFaces) {
        let clusters = grow_clusters(points, self, graph, &merged.seeds);
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

    /// The first `count` polygons are faces; the others are outlines of clusters.
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
