//! Proofs of a depth by the adjacent facets.
//!
//! A pyramid over a polygon of points of the difference, with its apex in the difference, lies in the
//! difference. The ball with the radius of the depth may stick out through a side of the pyramid under the
//! nearest facet. Then the pyramid under the facet across that side may contain the rest: it does if the ball
//! is beneath its plane and inside its other sides. So no direction has a smaller depth, and no polytope need
//! be expanded to show this.

use std::array;

use glam::DVec3;

use super::polygon::ball_is_inside;
use crate::query::feature::{CORNERS, Feature};
use crate::query::gauss_map;
use crate::query::types::Proximity;
use crate::query::verdict::FacetEdge;
use crate::support::{Cso, CsoVertex, Polytope, VertexId};

/// A ball that sticks out through more sides than this is larger than the facet and its neighbours.
const MAX_SIDES: usize = 2;

/// Whether the pyramids under a facet and under its neighbours together contain the ball around the origin
/// that reaches to the facet's plane, up to `tolerance`. The plane must support the difference.
pub(in crate::query) fn contains_ball<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    facet: &Proximity,
    tolerance: f64,
) -> bool {
    let pyramids = Pyramids {
        apex: cso.center(),
        radius: (-facet.signed_distance - tolerance).max(0.0),
        tolerance,
    };
    let Some(here) = Facet::new(cso, facet.features) else {
        return false;
    };
    let open: [bool; CORNERS] =
        array::from_fn(|i| i < here.len && !pyramids.edge_contains_ball(&here, i));
    let mut open_sides = (0..here.len).filter(|&i| open[i]);
    open_sides.clone().count() <= MAX_SIDES
        && open_sides.all(|i| {
            let across = gauss_map::adjacent_facet(cso, &here.side(i, facet.normal));
            let there = across.and_then(|next| pyramids.facet(cso, next));
            there.is_some_and(|there| pyramids.contains_remainder([&here, &there], i))
        })
}

/// Pyramids with a common apex, and the ball that they may contain.
struct Pyramids {
    apex: DVec3,
    radius: f64,
    /// If a facet is no farther than this from the apex, its pyramid counts as flat.
    tolerance: f64,
}

impl Pyramids {
    /// The facet that features span, if the ball is beneath its plane.
    fn facet<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        features: [Feature; 2],
    ) -> Option<Facet> {
        let facet = Facet::new(cso, features)?;
        let [a, b, c] = [0, 1, 2].map(|i| facet.corners[i].w);
        let normal = (b - a).cross(c - a).try_normalize()?;
        let height = normal.dot(a - self.apex);
        let outward = normal * height.signum();
        let corners = &facet.corners[..facet.len];
        let is_beyond = |corner: &CsoVertex| outward.dot(corner.w) >= self.radius;
        let has_room = height.abs() > self.tolerance && corners.iter().all(is_beyond);
        has_room.then_some(facet)
    }

    /// The plane through a side and the apex: a normal, and the height of the facet's middle over the plane.
    fn side_plane(&self, facet: &Facet, i: usize) -> (DVec3, f64) {
        let [from, to] = facet.ends(i).map(|end| end.w);
        let normal = (to - from).cross(self.apex - from);
        (normal, normal.dot(facet.middle - from))
    }

    /// Whether the ball is on the inner side of the plane through a side and the apex.
    fn edge_contains_ball(&self, facet: &Facet, i: usize) -> bool {
        let (normal, middle) = self.side_plane(facet, i);
        ball_is_inside(facet.corners[i].w, normal * middle.signum(), self.radius)
    }

    /// Whether the second facet is across side `i` of the first, and the ball is inside all of its other
    /// sides.
    fn contains_remainder(&self, [here, there]: [&Facet; 2], i: usize) -> bool {
        let side = here.ends(i).map(|end| end.ids);
        let is_shared = |&k: &usize| {
            let [from, to] = there.ends(k).map(|end| end.ids);
            side == [from, to] || side == [to, from]
        };
        let mut sides = 0..there.len;
        let Some(shared) = sides.clone().find(is_shared) else {
            return false;
        };
        let (normal, middle_here) = self.side_plane(here, i);
        let beyond = normal.dot(there.middle - here.corners[i].w);
        beyond * middle_here < 0.0
            && sides.all(|k| k == shared || self.edge_contains_ball(there, k))
    }
}

/// A polygon of points of the difference, which may be a facet.
struct Facet {
    corners: [CsoVertex; CORNERS],
    len: usize,
    /// A point inside.
    middle: DVec3,
}

impl Facet {
    /// The facet that features span.
    fn new<A: Polytope, B: Polytope>(cso: &Cso<'_, A, B>, features: [Feature; 2]) -> Option<Self> {
        let (ids, len) = corners(cso, features)?;
        let corners = ids.map(|ids| cso.vertex(ids));
        let sum: DVec3 = corners[..len].iter().map(|corner| corner.w).sum();
        Some(Self {
            corners,
            len,
            middle: sum / len as f64,
        })
    }

    fn ends(&self, i: usize) -> [&CsoVertex; 2] {
        [&self.corners[i], &self.corners[(i + 1) % self.len]]
    }

    /// A side in the form that walks use. The facet has this outward normal.
    fn side(&self, i: usize, normal: DVec3) -> FacetEdge {
        let [from, to] = self.ends(i);
        let outward = (to.w - from.w).cross(normal);
        FacetEdge {
            ends: [from.ids, to.ids],
            normal,
            outward: outward * outward.dot(from.w - self.middle).signum(),
        }
    }
}

/// The corners of the polygon that two features span, in order, and their number. `None` if there are more
/// than [`CORNERS`]: such a facet is large, and mostly its own pyramid proves the depth.
fn corners<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    features: [Feature; 2],
) -> Option<([[VertexId; 2]; CORNERS], usize)> {
    let (corners_1, count_1) = features[0].corners(cso.shape_1);
    let (corners_2, count_2) = features[1].corners(cso.shape_2);
    let [[a, b, ..], [c, d, ..]] = [corners_1, corners_2];
    match (count_1, count_2) {
        (2, 2) => Some(([[a, c], [b, c], [b, d], [a, d]], 4)),
        (3..=CORNERS, 1) => Some((corners_1.map(|v1| [v1, c]), count_1)),
        (1, 3..=CORNERS) => Some((corners_2.map(|v2| [a, v2]), count_2)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epa::{self, EpaScratch};
    use crate::hull::Hull;
    use crate::query::certificate::facet;
    use crate::query::gauss_map::tests::{direction, random_pose};
    use crate::query::seeds::EpaSeeds;
    use crate::query::verdict::Verdict;
    use crate::stats::Cost;
    use crate::tolerance::DEPTH_GAP;
    use glam::Vec3;

    fn hull(rng: &mut oorandom::Rand64) -> Hull {
        let sizes = [(); 3].map(|()| 0.4 + 0.6 * rng.rand_float());
        let count = rng.rand_range(8..120);
        let points: Vec<Vec3> = (0..count)
            .map(|_| (direction(rng) * DVec3::from(sizes)).as_vec3())
            .collect();
        Hull::from_points(&points).expect("points on an ellipsoid are their own hull")
    }

    /// Walks from random directions to facets into which the origin projects, at all kinds of depths. A facet
    /// that is not the nearest must never be proved to be.
    #[test]
    fn only_the_depth_is_proved() {
        let mut rng = oorandom::Rand64::new(3);
        let [mut proved, mut others] = [0; 2];
        for _ in 0..3000 {
            let hulls = [hull(&mut rng), hull(&mut rng)];
            let pose = random_pose(1.8, &mut rng);
            let cso = Cso {
                shape_1: &hulls[0],
                shape_2: &hulls[1],
                pose: &pose,
            };
            let mut cost = Cost::default();
            let normal = direction(&mut rng);
            let vertex = cso.support(normal, cso.start_vertices(normal), &mut cost);
            let mut next = gauss_map::facet_at_vertex(&cso, &vertex, normal);
            let candidate = (0..20).find_map(|_| {
                match facet::certify(&cso, next?, || None, [f64::INFINITY, DEPTH_GAP], &mut cost) {
                    Verdict::OutsideEdge(side) => next = gauss_map::adjacent_facet(&cso, &side),
                    Verdict::Undecided(candidate, _) => return Some(candidate),
                    _ => next = None,
                }
                None
            });
            let Some(candidate) = candidate else { continue };
            let seeds = EpaSeeds::under(&cso, candidate.features);
            let scratch = &mut EpaScratch::default();
            let depth = epa::penetration(&cso, seeds.as_slice(), scratch, &mut cost);
            let depth = depth.expect("they overlap").depth;
            let excess = -candidate.signed_distance - depth;
            if contains_ball(&cso, &candidate, DEPTH_GAP) {
                assert!(excess < 2.0 * DEPTH_GAP, "{excess} deeper than need be");
                proved += 1;
            } else if excess > 2.0 * DEPTH_GAP {
                others += 1;
            }
        }
        assert!(proved > 50 && others > 50, "{proved} proved, {others} not");
    }
}
