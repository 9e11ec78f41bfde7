//! The faces that a manifold's contacts lie on, and the features in contact between them.

use std::iter;

use glam::Vec3;
use parry3d::query::TrackedContact;
use parry3d::shape::PackedFeatureId;

use super::kernel_manifold::{KernelManifold, pack, unpack};
use crate::map_pair::map_pair;
use crate::query::{ContactId, Feature, FlushFaces, LastContacts};
use crate::support::{Cso, FaceId, Polytope};
use crate::tuning::STILL;

impl<M, C> KernelManifold<'_, M, C> {
    /// The faces that the contacts lie on, if the contacts hardly moved: faces that a contact names, or else faces
    /// beside the features of the deepest contact.
    pub fn flush_faces<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        last: &LastContacts,
    ) -> Option<FlushFaces> {
        let normals = [self.manifold.local_n1, self.manifold.local_n2];
        let [n1, n2] = self.order.to_kernel(normals);
        if !last.are_within(n1.as_dvec3(), STILL * cso.min_radius()) {
            return None;
        }
        let points = &self.manifold.points;
        let deepest = points.get(last.deepest(n1.as_dvec3()))?;
        let face = |fid: fn(&TrackedContact<C>) -> PackedFeatureId| {
            let own = fid(deepest);
            let mut ids = iter::once(own).chain(points.iter().map(fid));
            unpack(ids.find(|id| is_face(*id)).unwrap_or(own))
        };
        let [f1, f2] = self.order.to_kernel([face(|c| c.fid1), face(|c| c.fid2)]);
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
        let points = &mut self.manifold.points;
        let old = [points[deepest].fid1, points[deepest].fid2];
        let has_face = |side: usize| old[side] == ids[side] && is_face(ids[side]);
        if old != ids && !has_face(0) && !has_face(1) {
            set_features(points, deepest, ids);
        }
    }
}

fn is_face(id: PackedFeatureId) -> bool {
    matches!(unpack(id), Some(Feature::Face(_)))
}

/// Gives a contact these features, unless another contact has them or they do not determine a single place.
#[inline(never)]
fn set_features<C>(contacts: &mut [TrackedContact<C>], contact: usize, ids: [PackedFeatureId; 2]) {
    let [Some(f1), Some(f2)] = ids.map(unpack) else {
        return;
    };
    let new = ContactId::new([f1, f2]);
    let is_place = !matches!([f1, f2], [Feature::Face(_), Feature::Face(_)]);
    if is_place && contacts.iter().all(|old| ContactId::of(old) != Some(new)) {
        [contacts[contact].fid1, contacts[contact].fid2] = ids;
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
