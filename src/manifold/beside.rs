//! Faces beside the one in contact. Shapes that overlap far enough touch with these faces, too: a stone
//! pressed into the ground has corners below the surface that belong to no single face.

use super::contact_frame::{ContactFrame, FaceHeight};
use crate::support::{FaceCorners, FaceId, Polytope, VertexId};
use crate::tuning::STEEPEST_BESIDE;

/// Adds the planes of the adjacent faces of `face` that face the other shape.
pub(super) fn add_planes(
    frame: &ContactFrame,
    shape: &impl Polytope,
    face: FaceId,
    sign: f32,
    planes: &mut Vec<FaceHeight>,
) {
    // Of the two faces at an edge, the other one is that whose normal is farther from the normal of `face`.
    let behind = -shape.face_normal(face);
    let corners = shape.face_corners(face);
    let edges = (0..corners.count()).filter_map(|i| corners.edge(i));
    let beside = edges.map(|edge| shape.face_at_edge(edge, behind));
    let seen = beside.filter_map(|other| frame.plane(shape, other, sign));
    planes.extend(seen.filter(|plane| plane.slope_squared() < STEEPEST_BESIDE * STEEPEST_BESIDE));
}

/// The corners of the faces in `planes` that are not corners of `face`, some more than once.
pub(super) fn corners(
    shape: &impl Polytope,
    face: FaceId,
    planes: &[FaceHeight],
) -> impl Iterator<Item = VertexId> {
    let around = move |face| {
        let corners = shape.face_corners(face);
        (0..corners.count()).map(move |i| corners.vertex(i))
    };
    let own = around(face);
    let others = planes.iter().flat_map(move |plane| around(plane.face));
    others.filter(move |&vertex| own.clone().all(|corner| corner != vertex))
}
