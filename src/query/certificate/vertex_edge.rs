//! Nearest features that span no facet: a vertex against an edge or another vertex, for instance if a ball or
//! the end of a capsule rolls over an edge.
//!
//! Their nearest points bound the distance from above, and a support pair along the line between them bounds
//! it from below.

use glam::DVec3;

use crate::gjk::{self, AxisTest};
use crate::map_pair::map_pair;
use crate::query::feature::Feature;
use crate::query::types::{Answer, Proximity};
use crate::stats::Cost;
use crate::support::{Cso, Polytope};
use crate::tolerance::MIN_DIRECTED_DISTANCE;

/// The answer that `features` prove, if both bounds meet or the lower one exceeds the maximum distance.
pub(in crate::query) fn certify<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    features: [Feature; 2],
    max_distance: f64,
    tolerance: f64,
    cost: &mut Cost,
) -> Option<Answer> {
    let ends_1 = features[0].ends(cso.shape_1)?;
    let ends_2 = features[1].ends(cso.shape_2)?;
    if ends_1[0] != ends_1[1] && ends_2[0] != ends_2[1] {
        return None;
    }
    let [a, b] = map_pair(ends_1, |v| cso.shape_1.vertex(v));
    let [c, d] = map_pair(ends_2, |v| cso.pose.point_to_1(cso.shape_2.vertex(v)));
    let (on_1, on_2) = (nearest([a, b], c), nearest([c, d], a));
    let distance = on_1.distance(on_2);
    if distance.partial_cmp(&(MIN_DIRECTED_DISTANCE * cso.size()))
        != Some(std::cmp::Ordering::Greater)
    {
        return None;
    }
    let normal = (on_2 - on_1) / distance;
    let start = [ends_1[0], ends_2[0]];
    match gjk::test_axis(cso, normal, start, max_distance, cost) {
        AxisTest::Separating(apart) => Some(Answer::Separated(apart)),
        AxisTest::Supporting(vertex) => {
            (distance + normal.dot(vertex.w) <= tolerance).then_some(Answer::Near(Proximity {
                signed_distance: distance,
                normal,
                on_1,
                on_2,
                features,
            }))
        }
    }
}

/// The point of a segment that is nearest to `p`.
fn nearest([a, b]: [DVec3; 2], p: DVec3) -> DVec3 {
    let along = b - a;
    let share = (p - a).dot(along) / along.length_squared();
    // For a single point the share is NaN.
    if share > 0.0 {
        a + along * share.min(1.0)
    } else {
        a
    }
}
