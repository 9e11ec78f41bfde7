//! Merging coplanar triangles into faces.

use std::mem;

use glam::DVec3;

use super::area_vectors::AreaVectors;
use super::bends::Bends;
use super::face_plane::{FacePlane, normal_of};
use super::flat_edges::NearlyFlatEdges;
use super::half_edge::{HalfEdge, HalfEdgeMesh, triangle};
use super::regions::CoplanarRegions;
use crate::at::{At, to_u16};
use crate::hull::faces::{FaceRecord, Faces, HAS_SIMILAR_NEIGHBOR};
use crate::hull::graph::FaceCorner;
use crate::tolerance::{CLUSTER_ANGLE_COS, FACE_FLATNESS};

/// The result of merging triangles.
pub(super) struct MergedFaces {
    /// The face of each triangle.
    pub face_of: Vec<u16>,
    /// The faces with a neighbouring vertex that is higher than one of their corners.
    pub overtopped: Vec<u16>,
}

impl Faces {
    /// Merges the triangles of a surface. Faces are in the order of their first triangles, so that faces
    /// around a vertex lie as near in memory as the triangles do.
    pub(super) fn new(
        points: &[DVec3],
        mesh: &HalfEdgeMesh<'_>,
        surface: &AreaVectors,
        bends: &Bends,
        radius: f64,
    ) -> (Self, MergedFaces) {
        // No other edge is flat enough for a face.
        let flat = NearlyFlatEdges::among(&bends.not_steep, points, mesh, surface, radius);
        let regions = CoplanarRegions::grow(points, mesh, surface, &flat, radius);
        let mut builder = Builder {
            points,
            mesh,
            surface,
            bends,
            radius,
            polygons: Vec::with_capacity(mesh.triangles.len() + 1),
            corners: Vec::with_capacity(3 * mesh.triangles.len()),
            merged: MergedFaces {
                face_of: vec![0; mesh.triangles.len()],
                overtopped: Vec::new(),
            },
            has_planes: true,
        };
        builder.add_all(&regions);
        let has_planes = builder.has_planes;
        let (mut faces, merged) = builder.finish();
        if !has_planes {
            // A face without a plane may be in any cluster.
            let all = faces.polygons.iter_mut().take(faces.count);
            all.for_each(|face| face.first |= HAS_SIMILAR_NEIGHBOR);
        } else if flat.is_empty() {
            faces.mark_similar_neighbors(mesh, &merged.face_of, bends.nearly_flat.iter().copied());
        } else {
            // The normal of a merged face is not that of its triangles.
            let edges = (0..).zip(mesh.triangles.as_flattened());
            faces.mark_similar_neighbors(mesh, &merged.face_of, edges.map(|(h, _)| h));
        }
        (faces, merged)
    }

    /// Marks the faces of about the same direction that meet at some of these edges.
    fn mark_similar_neighbors(
        &mut self,
        mesh: &HalfEdgeMesh<'_>,
        face_of: &[u16],
        edges: impl Iterator<Item = HalfEdge>,
    ) {
        for h in edges {
            let faces = [h, mesh.twin(h)].map(|h| face_of[triangle(h)]);
            let [here, beyond] = faces.map(|face| self.normal(face.into()));
            if faces[0] != faces[1] && here.dot(beyond) >= CLUSTER_ANGLE_COS {
                for face in faces {
                    self.polygons[usize::from(face)].first |= HAS_SIMILAR_NEIGHBOR;
                }
            }
        }
    }
}

/// Adds one face after the other.
struct Builder<'a> {
    points: &'a [DVec3],
    mesh: &'a HalfEdgeMesh<'a>,
    surface: &'a AreaVectors,
    bends: &'a Bends,
    radius: f64,
    polygons: Vec<FaceRecord>,
    corners: Vec<FaceCorner>,
    merged: MergedFaces,
    has_planes: bool,
}

impl Builder<'_> {
    fn add_all(&mut self, regions: &CoplanarRegions) {
        if self.bends.are_steep() {
            return self.add_steep_triangles();
        }
        let mut is_added = vec![false; regions.len()];
        let mut polygon = Vec::new();
        for t in 0..self.mesh.triangles.len() {
            let Some(region) = regions.of(t) else {
                self.add_triangle(t);
                continue;
            };
            if mem::replace(&mut is_added[region], true) {
                continue;
            }
            let triangles = regions.triangles(region);
            let is_polygon = triangles.len() > 1
                && regions.boundary(self.mesh, triangles, &mut polygon)
                && is_convex(self.points, self.mesh, &polygon, self.radius);
            let plane = is_polygon.then(|| self.plane(&polygon));
            if let Some(plane) = plane.filter(FacePlane::is_some) {
                self.add_polygon(&polygon, &plane, triangles);
            } else {
                // A region that is not a flat, convex polygon becomes one face per triangle.
                triangles
                    .iter()
                    .for_each(|&t| self.add_triangle(t as usize));
            }
        }
    }

    /// Adds all triangles of a surface whose edges are all steep: each is a face of its own.
    fn add_steep_triangles(&mut self) {
        let corners = self.mesh.corners();
        for (t, (triangle, corners)) in (0..).zip(self.surface.triangles.iter().zip(corners)) {
            let plane = FacePlane::of_triangle(triangle, self.radius);
            self.merged.face_of[usize::from(t)] = t;
            self.add_plane(&plane);
            self.corners.extend_from_slice(&corners);
        }
    }

    /// Adds a triangle as a face of its own.
    #[inline]
    fn add_triangle(&mut self, t: usize) {
        let corners = self.mesh.triangles[t];
        let sides = self.mesh.sides_of(t);
        let is_steep = corners.iter().all(|&v| self.bends.is_steep(v));
        let plane = if is_steep {
            FacePlane::of_triangle(&self.surface.triangles[t], self.radius)
        } else {
            self.plane(&sides)
        };
        self.merged.face_of[t] = self.add_plane(&plane);
        self.corners
            .extend(sides.map(|side| self.mesh.corner(side)));
    }

    /// Adds a polygon that consists of some triangles.
    fn add_polygon(&mut self, polygon: &[HalfEdge], plane: &FacePlane, triangles: &[u32]) {
        let face = self.add_plane(plane);
        for &t in triangles {
            *self.merged.face_of.at_mut(t) = face;
        }
        let mesh = self.mesh;
        self.corners
            .extend(polygon.iter().map(|&side| mesh.corner(side)));
    }

    fn plane(&self, polygon: &[HalfEdge]) -> FacePlane {
        FacePlane::new(self.points, self.mesh, polygon, self.bends, self.radius)
    }

    /// Adds the plane of a face whose corners come next, and returns the number of the face.
    #[inline]
    fn add_plane(&mut self, plane: &FacePlane) -> u16 {
        let face = to_u16(self.polygons.len());
        if plane.is_overtopped {
            self.merged.overtopped.push(face);
        }
        self.has_planes &= plane.is_some();
        self.polygons.push(FaceRecord {
            normal: plane.normal,
            first: self.corners.short_len(),
            offset: plane.offset,
        });
        face
    }

    fn finish(mut self) -> (Faces, MergedFaces) {
        self.polygons.push(FaceRecord::end(&self.corners));
        let faces = Faces::from_lists(self.polygons.into(), self.corners.into(), self.radius);
        (faces, self.merged)
    }
}

/// Whether no corner is a dent, beyond rounding.
fn is_convex(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, polygon: &[HalfEdge], radius: f64) -> bool {
    let normal = normal_of(points, mesh, polygon);
    let count = polygon.len();
    let at = |i: usize| points.at(mesh.start(polygon[i % count]));
    (0..count).all(|i| {
        let (before, here, after) = (at(i), at(i + 1), at(i + 2));
        let chord = after - before;
        let outward = normal.dot((here - before).cross(chord));
        outward >= -FACE_FLATNESS * radius * chord.length()
    })
}
