//! Merging coplanar triangles into faces.

use std::cmp::Reverse;
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
use crate::tolerance::{CLUSTER_ANGLE_COS, FACE_FLATNESS};

/// The result of merging triangles.
pub(super) struct MergedFaces {
    /// The face of each triangle.
    pub face_of: Vec<u16>,
    /// The faces from which clusters may grow, ordered by their largest triangles.
    seeds: Vec<ClusterSeed>,
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
    pub(super) fn new(
        points: &[DVec3],
        mesh: &HalfEdgeMesh<'_>,
        surface: &AreaVectors,
        is_steep: &[bool],
        radius: f64,
    ) -> (Self, MergedFaces) {
        let count = mesh.triangles.len();
        let flat = NearlyFlatEdges::new(mesh, surface);
        let regions = CoplanarRegions::grow(points, mesh, surface, &flat, radius);
        let mut merged = MergedFaces {
            face_of: vec![0; count],
            seeds: Vec::new(),
            overtopped: Vec::new(),
        };
        let mut faces = Builder::with_capacity(count);
        let mut is_added = vec![false; regions.len()];
        // The largest triangle of the region of each face.
        let mut largest = Vec::with_capacity(count);
        let mut add = |polygon: &[HalfEdge], triangles: &[u32]| {
            let plane = FacePlane::new(points, mesh, polygon, is_steep, radius);
            merged.note(faces.polygons.len() as u16, triangles, &plane);
            let corner = |&side: &HalfEdge| FaceCorner {
                vertex: mesh.start(side) as u16,
                slot: mesh.edge_slot(side),
            };
            faces.add(&plane, polygon.iter().map(corner));
        };
        let mut polygon = Vec::new();
        for &r in &regions.of {
            if mem::replace(&mut is_added[r as usize], true) {
                continue;
            }
            let region = regions.triangles(r as usize);
            let is_one_face = region.len() > 1
                && regions.boundary(mesh, region, &mut polygon)
                && is_convex(points, mesh, &polygon, radius);
            if is_one_face {
                add(&polygon, region);
                largest.push(region[0]);
            } else {
                // A region that is not a convex polygon becomes one face per triangle.
                for &t in region {
                    add(&[3 * t, 3 * t + 1, 3 * t + 2], &[t]);
                    largest.push(region[0]);
                }
            }
        }
        let faces = faces.finish(largest.len(), FaceClusters::default());
        merged.seeds = faces.cluster_seeds(mesh, &flat, &merged.face_of);
        merged.seeds.sort_unstable_by_key(|seed| {
            let t = largest[usize::from(seed.face)];
            (Reverse(surface.areas[t as usize].to_bits()), t, seed.face)
        });
        (faces, merged)
    }

    /// The faces that have a nearly flat edge to another face, in their order.
    fn cluster_seeds(
        &self,
        mesh: &HalfEdgeMesh<'_>,
        flat: &NearlyFlatEdges,
        face_of: &[u16],
    ) -> Vec<ClusterSeed> {
        if flat.is_empty() {
            return Vec::new();
        }
        // A face without a plane may join any cluster.
        let has_planes = (0..self.len()).all(|face| self.normal(FaceId::new(face)) != DVec3::ZERO);
        let mut seeds = vec![(!has_planes, !has_planes); self.len()];
        for h in (0..3 * face_of.len() as HalfEdge).filter(|&h| flat.contains(h)) {
            let [here, beyond] = [h, mesh.twin(h)].map(|h| face_of[triangle(h)]);
            if here != beyond {
                let [one, other] = [here, beyond].map(|face| self.normal(face.into()));
                let (is_seed, has_company) = &mut seeds[usize::from(here)];
                *is_seed = true;
                *has_company |= one.dot(other) >= CLUSTER_ANGLE_COS;
            }
        }
        let mut all = Vec::new();
        for (face, (is_seed, has_company)) in (0..).zip(seeds) {
            if is_seed {
                all.push(ClusterSeed { face, has_company });
            }
        }
        all
    }

    /// Finds the clusters. The `graph` must know the faces already.
    pub(super) fn add_clusters(
        &mut self,
        points: &[DVec3],
        graph: &EdgeGraph,
        merged: &MergedFaces,
    ) {
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

/// A face from which a cluster may grow.
pub(super) struct ClusterSeed {
    pub face: u16,
    /// Whether a face beside it may be a member, too.
    pub has_company: bool,
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
