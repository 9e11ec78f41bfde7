//! The witness points of shapes that overlap.
//!
//! EPA's last triangle may be a small part of a facet, and the origin may project beside it. If the shapes
//! are moved apart along the normal, they are nearest where they were deepest, and GJK finds these points on
//! any features.

use glam::DVec3;

use super::feature;
use super::types::Proximity;
use crate::epa::Penetration;
use crate::gjk::{self, Outcome};
use crate::simplex::Preferred;
use crate::stats::Cost;
use crate::support::{Cso, Polytope};
use crate::tolerance::{DEPTH_GAP, WITNESS_GAP};

/// The answer for a depth. Each witness point lies on its own shape.
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
    let way = through + depth.normal * (WITNESS_GAP * radius);
    let pose = cso.pose.moved(way);
    let apart = Cso {
        pose: &pose,
        ..*cso
    };
    let start = depth.face.map(|vertex| apart.vertex(vertex.ids));
    match gjk::distance::<Preferred, _, _>(&apart, &start, f64::INFINITY, cost) {
        // The points are on their shapes, whatever the bounds are.
        Outcome::Disjoint(closest) | Outcome::Unsure(closest) => {
            let simplex = closest.simplex.vertices();
            let features = feature::of_simplex(cso, simplex, depth.normal);
            proximity([closest.on_1, closest.on_2 - way], features)
        }
        _ => at_hand(),
    }
}
