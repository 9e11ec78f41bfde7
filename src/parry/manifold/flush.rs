//! The faces that a manifold's contacts lie on, and the features in contact between them.

use std::iter;

use glam::Vec3;
use parry3d::shape::PackedFeatureId;

use super::erased::ErasedManifold;
use super::kernel_manifold::KernelManifold;
use super::packed_feature::{pack, unpack};
use crate::map_pair::map_pair;
use crate::query::{ContactId, Feature, FlushFaces, LastContacts};
use crate::support::{Cso, FaceId, Polytope};
use crate::tuning::STILL;

impl KernelManifold<'_, '_> {
    /// The faces that the contacts lie on, if the contacts hardly moved: faces that a contact names, or else faces
    /// beside the features of the deepest contact.
    pub fn flush_faces<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        last: &LastContacts,
    ) -> Option<FlushFaces> {
        let normals = [*self.manifold.local_n1, *self.manifold.local_n2];
        let [n1, n2] = self.order.to_kernel(normals);
        if !last.are_within(n1.as_dvec3(), STILL * cso.min_radius()) {
            return None;
        }
        let deepest = last.deepest(n1.as_dvec3());
        let own = self.manifold.points().features(deepest)?;
        let face = |shape: usize| {
            let others = self.manifold.features().map(|ids| ids[shape]);
            let mut ids = iter::once(own[shape]).chain(others);
            unpack(ids.find(|id| is_face(*id)).unwrap_or(own[shape]))
        };
        let [f1, f2] = self.order.to_kernel([face(0), face(1)]);
        Some(FlushFaces {
            faces: [
                face_of(cso.shape_1, f1?, n1)?,
                face_of(cso.shape_2, f2?, n2)?,
            ],
            middle: last.middle(),
        })
    }

    /// Gives the deepest contact the features of the query's witness, from which the next query starts. They may belong
    /// to a corner without a contact, hardly deeper than this one. If both corners touch the same face, the next query starts there
    /// anyway.
    #[inline]
    pub fn set_deepest_features(&mut self, deepest: usize, features: [Feature; 2]) {
        let ids = self.order.to_caller(map_pair(features, pack));
        let Some(old) = self.manifold.points().features(deepest) else {
            return;
        };
        let has_face = |shape: usize| old[shape] == ids[shape] && is_face(ids[shape]);
        if old != ids && !has_face(0) && !has_face(1) {
            set_features(self.manifold, deepest, ids);
        }
    }
}

fn is_face(id: PackedFeatureId) -> bool {
    matches!(unpack(id), Some(Feature::Face(_)))
}

/// Gives a contact these features, unless another contact has them or they do not determine a single place.
#[inline(never)]
fn set_features(manifold: &mut ErasedManifold<'_>, contact: usize, ids: [PackedFeatureId; 2]) {
    let [Some(f1), Some(f2)] = ids.map(unpack) else {
        return;
    };
    let new = ContactId::new([f1, f2]);
    let is_place = !matches!([f1, f2], [Feature::Face(_), Feature::Face(_)]);
    let is_new = |old: [PackedFeatureId; 2]| ContactId::unpacked(old) != Some(new);
    if is_place && manifold.features().all(is_new) {
        manifold.points_mut().set_features(contact, ids);
    }
}

/// The face itself if the feature is one; otherwise the adjacent face that faces outward most.
fn face_of(shape: &impl Polytope, feature: Feature, outward: Vec3) -> Option<FaceId> {
    let is_there = match feature {
        Feature::Face(face) => shape.has_face(face),
        Feature::Edge(edge) => shape.edge_ends(edge).is_some(),
        Feature::Vertex(vertex) => shape.clamp_vertex(vertex) == vertex,
    };
    is_there.then(|| feature.face(shape, outward.as_dvec3()))
}
