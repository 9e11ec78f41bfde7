//! Faces, edges and vertices of the hull by parry's ids.

use glam::DVec3;
use parry3d::math::Vector;
use parry3d::shape::{FeatureId, PackedFeatureId, PolygonalFeature, PolygonalFeatureMap};

use super::HullShape;
use crate::hull::Hull;
use crate::support::{FaceId, Polytope, VertexId};
use crate::tolerance::{FEATURE_ANGLE_COS, FEATURE_ANGLE_SIN};

impl Hull {
    /// The extreme feature in the unit direction `dir`: a face or an edge if one is nearly extreme, and
    /// otherwise a vertex.
    pub(super) fn feature_toward(&self, dir: DVec3) -> FeatureId {
        let vertex = self.support_vertex(dir);
        let face = self.face_at_vertex(vertex, dir);
        let Some(at) = self.place_around(face, vertex) else {
            return FeatureId::Face(face.into());
        };
        if self.face_normal(face).dot(dir) >= FEATURE_ANGLE_COS {
            return FeatureId::Face(face.into());
        }
        let len = self.face_len(face);
        let level = |other: &VertexId| {
            let edge = self.vertex(*other) - self.vertex(vertex);
            edge.dot(dir).abs() <= FEATURE_ANGLE_SIN * edge.length()
        };
        [at + 1, at + len - 1]
            .map(|i| self.face_vertex(face, i % len))
            .into_iter()
            .find(level)
            .and_then(|other| self.edge_between(vertex, other))
            .map_or(FeatureId::Vertex(vertex.into()), |edge| {
                FeatureId::Edge(edge.into())
            })
    }

    /// The position of a vertex among the corners of a face; `None` if it is no corner.
    fn place_around(&self, face: FaceId, vertex: VertexId) -> Option<usize> {
        (0..self.face_len(face)).find(|&i| self.face_vertex(face, i) == vertex)
    }

    /// The outward unit normal of a feature. For an edge or a vertex it is the mean normal of its faces.
    /// `None` if there is no such feature.
    pub(super) fn feature_normal(&self, feature: FeatureId) -> Option<Vector> {
        let normal = match feature {
            FeatureId::Face(face) if self.has_face(face.into()) => self.face_normal(face.into()),
            FeatureId::Edge(edge) => self.mean_normal(&self.edge_ends(edge.into())?)?,
            FeatureId::Vertex(vertex) => self.mean_normal(&[vertex.into()])?,
            FeatureId::Face(_) | FeatureId::Unknown => return None,
        };
        Some(normal.as_vec3())
    }

    /// The mean normal of the faces that have all of `corners`.
    fn mean_normal(&self, corners: &[VertexId]) -> Option<DVec3> {
        self.face_ids()
            .filter(|&face| {
                corners
                    .iter()
                    .all(|&v| self.place_around(face, v).is_some())
            })
            .map(|face| self.face_normal(face))
            .sum::<DVec3>()
            .try_normalize()
    }

    /// At most four corners of a face, as positions around it: `first`, the farthest from it, and on both
    /// sides the farthest from the line through these two.
    fn far_corners(&self, face: FaceId, first: usize) -> impl Iterator<Item = usize> {
        let len = self.face_len(face);
        let at = |step: usize| self.vertex(self.face_vertex(face, (first + step) % len));
        let farthest = |steps: std::ops::Range<usize>, distance: &dyn Fn(DVec3) -> f64| {
            steps.max_by(|&i, &j| distance(at(i)).total_cmp(&distance(at(j))))
        };
        let start = at(0);
        let across = farthest(1..len, &|p| p.distance_squared(start)).unwrap_or(0);
        let line = at(across) - start;
        let aside = |p: DVec3| line.cross(p - start).length_squared();
        [
            Some(0),
            farthest(1..across, &aside),
            Some(across),
            farthest(across + 1..len, &aside),
        ]
        .into_iter()
        .flatten()
        .map(move |step| (first + step) % len)
    }
}

impl PolygonalFeatureMap for Hull {
    /// The face at the extreme vertex whose normal is nearest to `dir`. If it has more corners than parry has
    /// room for, these are the extreme one and others far from each other: a coin stands on its whole rim,
    /// not on four neighbouring points of it.
    fn local_support_feature(&self, dir: Vector, out_feature: &mut PolygonalFeature) {
        let vertex = self.support_vertex(dir.as_dvec3());
        let face = self.face_at_vertex(vertex, dir.as_dvec3());
        let len = self.face_len(face);
        let corner = |i: usize| self.face_vertex(face, i % len);
        let first = self.place_around(face, vertex).unwrap_or(0);
        let mut count = 0;
        for (slot, i) in self.far_corners(face, first).enumerate() {
            let edge = self.edge_between(corner(i), corner(i + 1));
            out_feature.vertices[slot] = self.points()[corner(i).index()];
            out_feature.vids[slot] = PackedFeatureId::vertex(corner(i).into());
            out_feature.eids[slot] = edge.map_or(PackedFeatureId::UNKNOWN, |edge| {
                PackedFeatureId::edge(edge.into())
            });
            count = slot + 1;
        }
        out_feature.fid = PackedFeatureId::face(face.into());
        out_feature.num_vertices = count;
    }

    fn is_convex_polyhedron(&self) -> bool {
        true
    }
}

impl PolygonalFeatureMap for HullShape {
    fn local_support_feature(&self, dir: Vector, out_feature: &mut PolygonalFeature) {
        self.hull().local_support_feature(dir, out_feature);
    }

    fn is_convex_polyhedron(&self) -> bool {
        true
    }
}
