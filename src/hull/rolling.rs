//! Whether a hull rolls over faces that bend so little that its side is as good as round.

use glam::DVec3;

use crate::primitive::turns;
use crate::stats::Cost;
use crate::support::Polytope;
use crate::tuning::{AHEAD, ROUND_COS};

/// Whether the outward normal of contacts turns over such faces, from one unit vector to another.
#[cold]
pub(super) fn rolls_over_faces(hull: &impl Polytope, from: DVec3, to: DVec3) -> bool {
    if !turns(from, to) {
        return false;
    }
    let face_along = |dir: DVec3| {
        let start = hull.start_vertex(dir);
        let (_, vertex) = hull.support(dir, start, &mut Cost::default());
        hull.face_at_vertex(vertex, dir)
    };
    let face = face_along(to);
    let turning = (to - from).normalize_or_zero();
    let ahead = AHEAD.map(|tangent| face_along(to + turning * tangent));
    let next = ahead.into_iter().find(|next| *next != face);
    next.is_some_and(|next| hull.face_normal(face).dot(hull.face_normal(next)) >= ROUND_COS)
}
