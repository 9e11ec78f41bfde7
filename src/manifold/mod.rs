//! The contact manifold: the two faces in contact, clipped against each other and reduced to
//! four points.
//!
//! If a face has neighbours that lie nearly in its plane, they are taken together. Both surfaces are
//! projected along the contact normal onto one plane, where their polygons are intersected. Every corner of
//! the intersection is a contact: its points lie on the two surfaces, on one line along the normal. Shapes
//! that are pressed into each other have further contacts, at corners of the adjacent faces. The witness of
//! the query is always kept, first in the list, so the manifold's deepest point is the query's answer.

mod beside;
mod border;
pub(crate) mod capsules;
mod clip;
mod clip_vertices;
mod contact_frame;
mod contacts;
mod corrected;
mod face_border;
mod half_space;
mod outline;
mod patch;
mod polygon;
mod reduce;
mod scratch;
mod sectors;

use glam::Vec2;

use crate::query::Proximity;
use crate::support::{Cso, Polytope};
use crate::tolerance::SAME_DEPTH;
use crate::tuning::{PRESSED, SAME_POINT};
use clip::Clipper;
use patch::SurfacePair;
use reduce::{Candidates, Selection};

pub use contacts::{ContactPoint, Contacts, MAX_POINTS};
pub use corrected::contacts_along;
pub use face_border::FaceBorder;
pub use half_space::{half_space_contacts, half_space_polygon};
pub use outline::{PatchCorner, contact_polygon};
pub use scratch::ClipScratch;

/// The contacts around the witness of a query along its normal: those nearer than `max_distance` first, then
/// the nearest of the others, which a solver needs for fast bodies.
pub fn contacts<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let ClipScratch {
        planes,
        clipper,
        candidates,
    } = scratch;
    let patch = SurfacePair::new(cso, proximity, proximity.normal, planes);
    let Some(mut patch) = patch else {
        return Contacts::witness(proximity, cso.pose);
    };
    // Along the query's normal nothing is deeper than the query's answer.
    let least = proximity.signed_distance;
    let scale = cso.min_radius();
    let polygons = patch.polygons(cso);
    patch.clip(polygons, clipper);
    let mut selection = choose(&patch, clipper, candidates, [least, max_distance], scale);
    let is_pressed = least < -PRESSED * scale;
    if is_pressed && selection.len < MAX_POINTS && patch.widen(cso, proximity, clipper) {
        selection = choose(&patch, clipper, candidates, [least, max_distance], scale);
    }
    let witness = (least, proximity.features);
    patch.contacts(polygons, witness, (clipper, candidates), &selection)
}

/// Chooses among the corners of the patch, and the witness, which is `least` deep. Corners nearer than
/// `max_distance` come first. `scale` is the radius of the smaller shape.
// perf: most pairs need it once, and a call would cost each of them.
#[inline(always)]
fn choose(
    patch: &SurfacePair<'_>,
    clipper: &Clipper,
    candidates: &mut Candidates,
    [least, max_distance]: [f64; 2],
    scale: f64,
) -> Selection {
    let corners = &clipper.corners;
    let distances = |_, x, y| patch.distances(x, y);
    let range = f32::NEG_INFINITY..=max_distance as f32;
    let same = SAME_POINT * scale as f32;
    let summary = candidates.set(corners, distances, range, same);
    let mut first = None;
    // The distance of two faces is linear, so a corner is deepest. A witness that is not a corner and not
    // deeper (somewhere inside two parallel faces) must not take a corner's place.
    if !summary.at_origin
        && let Some(deepest) = summary.deepest
        && f64::from(candidates.distance(deepest)) <= least + SAME_DEPTH * scale
    {
        first = Some(deepest);
    }
    let mut selection = Selection::default();
    selection.push(first);
    let first_at = first.map_or(Vec2::ZERO, |corner| corners.at(corner));
    let from = (first_at, least as f32);
    selection.push_all(candidates.spread_out(corners, from, same));
    selection.fill_up(candidates);
    selection
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use parry3d::math::{Pose, Rotation};

    use super::*;
    use crate::epa::EpaScratch;
    use crate::hull::Hull;
    use crate::pose::RelativePose;
    use crate::primitive::nearest_share;
    use crate::query::{Answer, Feature, PairMemory, Query};
    use crate::stats::Cost;

    fn prism(sides: u32, radius: f32) -> Hull {
        let points: Vec<Vec3> = (0..sides)
            .flat_map(|side| {
                let (sin, cos) = (std::f32::consts::TAU * side as f32 / sides as f32).sin_cos();
                [-0.5, 0.5].map(|y| Vec3::new(radius * cos, y, radius * sin))
            })
            .collect();
        Hull::from_points(&points).expect("a solid")
    }

    fn distance_to(shape: &impl Polytope, feature: Feature, point: DVec3) -> f64 {
        match feature {
            Feature::Vertex(v) => shape.vertex(v).distance(point),
            Feature::Edge(e) => {
                let ends = shape.edge_ends(e).expect("an edge");
                let [a, b] = ends.map(|v| shape.vertex(v));
                a.lerp(b, nearest_share([a, b], point)).distance(point)
            }
            Feature::Face(f) => (shape.face_normal(f).dot(point) - shape.face_offset(f)).abs(),
        }
    }

    /// Whichever polygon is the window: one inside the other, and both overhanging.
    #[test]
    fn contacts_lie_on_the_features_they_name() {
        for (sides, radii) in [
            ([4, 9], [1.0, 1.0]),
            ([9, 4], [1.0, 1.0]),
            ([9, 4], [1.0, 0.3]),
        ] {
            let shapes = [prism(sides[0], radii[0]), prism(sides[1], radii[1])];
            let turn = Rotation::from_scaled_axis(Vec3::new(1e-3, 0.4, 2e-3));
            let pose = Pose::from_parts(Vec3::new(0.3, 0.99, 0.1), turn);
            let pose = RelativePose::new(&pose).expect("a finite pose");
            let cso = Cso {
                shape_1: &shapes[0],
                shape_2: &shapes[1],
                pose: &pose,
            };
            let (mut scratch, mut cost) = (EpaScratch::default(), Cost::default());
            let answer = Query::new(&cso, 0.1, &mut scratch, &mut cost).run(&PairMemory::None);
            let Some((Answer::Near(near), _)) = answer else {
                panic!("no contact: {answer:?}");
            };
            let found = contacts(&cso, &near, 0.1, &mut ClipScratch::default());
            assert_eq!(found.len, MAX_POINTS);
            for contact in found.iter() {
                let [on_1, on_2] = [contact.on_1, contact.on_2].map(|p| p.as_dvec3());
                let off = distance_to(&shapes[0], contact.features[0], on_1).max(distance_to(
                    &shapes[1],
                    contact.features[1],
                    on_2,
                ));
                // A point between tilted faces leaves its vertex or edge by depth times tilt.
                assert!(off < 1e-4, "{sides:?}: {contact:?} is {off} off");
            }
        }
    }
}
