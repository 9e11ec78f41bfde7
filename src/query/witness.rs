//! The witness points of shapes that overlap.
//!
//! EPA's last triangle may be a small part of a facet, and the origin may project beside it. If the shapes
//! are moved apart along the normal, they are nearest where they were deepest, and GJK finds these points on
//! any features.

use glam::DVec3;

use super::feature;
use super::types::Proximity;
use crate::epa::Penetration;
use crate::gjk::{self, Closest, Outcome};
use crate::simplex::Preferred;
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Polytope, Support};
use crate::tolerance::{DEPTH_GAP, GJK_GAP_OF_SIZE, WITNESS_GAP};

/// The answer with a known depth. Each witness point lies on its own shape.
pub(super) fn of_depth<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    depth: &Penetration,
    cost: &mut Cost,
) -> Proximity {
    let through = depth.normal * depth.depth;
    let proximity = |[on_1, on_2]: [DVec3; 2], features| Proximity {
        signed_distance: -depth.depth,
        normal: depth.normal,
        on_1,
        on_2,
        features,
    };
    let at_hand = || {
        let features = feature::of_simplex(cso, depth.face.iter(), depth.normal);
        proximity([depth.on_1, depth.on_2], features)
    };
    let radius = cso.min_radius();
    let beside = depth.on_1 - depth.on_2 - through;
    if beside.length() <= DEPTH_GAP * radius {
        return at_hand();
    }
    let closest = moved_apart(
        cso,
        through,
        depth.normal,
        |apart, _| depth.face.map(|vertex| apart.vertex(vertex.ids)),
        GJK_GAP_OF_SIZE,
        cost,
    );
    match closest {
        Some(closest) => {
            let simplex = closest.simplex.vertices();
            let features = feature::of_simplex(cso, simplex, depth.normal);
            proximity([closest.on_1, closest.on_2], features)
        }
        None => at_hand(),
    }
}

/// The nearest points after the shapes are moved apart along the `normal`: by `through`, which ends the
/// overlap, and a little farther. GJK starts from the vertices that `start` finds, and stops at a `gap`
/// between its bounds. `on_2` is the point before that motion.
pub(crate) fn moved_apart<A: Support, B: Support, const N: usize>(
    cso: &Cso<'_, A, B>,
    through: DVec3,
    normal: DVec3,
    start: impl FnOnce(&Cso<'_, A, B>, &mut Cost) -> [CsoVertex; N],
    gap: f64,
    cost: &mut Cost,
) -> Option<Closest> {
    let way = through + normal * (WITNESS_GAP * cso.min_radius());
    let pose = cso.pose.moved(way);
    let apart = Cso {
        pose: &pose,
        ..*cso
    };
    let start = start(&apart, cost);
    match gjk::distance_within::<Preferred, _, _>(&apart, &start, f64::INFINITY, gap, cost) {
        // The points are on their shapes, whatever the bounds are.
        Outcome::Disjoint(closest) | Outcome::Unsure(closest) => Some(Closest {
            on_2: closest.on_2 - way,
            ..closest
        }),
        _ => None,
    }
}
