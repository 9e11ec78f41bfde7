//! Contacts along a normal that was corrected for the internal edges of a mesh or a compound.

use glam::DVec3;

use super::contacts::Contacts;
use super::patch::SurfacePair;
use super::reduce::Selection;
use super::scratch::ClipScratch;
use crate::query::{self, Feature, Proximity};
use crate::stats::Cost;
use crate::support::{Cso, FaceId, Polytope, VertexId};
use crate::tolerance::SAME_DEPTH;
use crate::tuning::SAME_POINT;

/// The contacts along another `normal` than the query's, at distances from `least` to `most`: corners of the
/// patch between the faces whose normals are nearest to `normal`. The query's features are not used: if the
/// correction is large, they lie beside these faces. `None` if one of the faces is edge-on to `normal`.
pub fn contacts_along<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    proximity: &Proximity,
    normal: DVec3,
    [least, most]: [f64; 2],
    scratch: &mut ClipScratch,
) -> Option<Contacts> {
    let ClipScratch {
        planes,
        clipper,
        candidates,
    } = scratch;
    let [v1, v2] = query::vertices(cso, proximity.features);
    let f1 = extreme_face(cso.shape_1, normal, v1);
    let f2 = extreme_face(cso.shape_2, -cso.pose.direction_to_2(normal), v2);
    let features = [f1, f2].map(Feature::Face);
    let proximity = Proximity {
        features,
        ..*proximity
    };
    let patch = SurfacePair::new(cso, &proximity, normal, planes)?;
    let polygons = patch.polygons(cso);
    patch.clip(polygons, clipper);
    let corners = &clipper.corners;
    let scale = cso.min_radius();
    let least = least - SAME_DEPTH * scale;
    let same = SAME_POINT * scale as f32;
    let distances = |_, x, y| patch.distances(x, y);
    let range = least as f32..=most as f32;
    let summary = candidates.set(corners, distances, range, same);
    let mut selection = Selection::default();
    if let Some(deepest) = summary.deepest {
        selection.push(summary.deepest);
        let from = (corners.at(deepest), candidates.distance(deepest));
        selection.push_all(candidates.spread_out(corners, from, same));
    }
    let witness = (least, features);
    Some(patch.contacts(polygons, witness, (clipper, candidates), &selection))
}

/// The face at the extreme vertex in direction `dir` whose normal is nearest to `dir`.
fn extreme_face(shape: &impl Polytope, dir: DVec3, start: VertexId) -> FaceId {
    let (_, vertex) = shape.support(dir, start, &mut Cost::default());
    shape.face_at_vertex(vertex, dir)
}
