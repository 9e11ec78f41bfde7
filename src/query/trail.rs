//! From facet to facet of the Minkowski difference, to where the origin projects into one.

use std::ops::ControlFlow;

use glam::DVec3;

use super::feature::{self, Feature, Side, Verdict};
use super::{Answer, Query, WARM, corner, walk};
use crate::both::both;
use crate::stats::Stage;
use crate::support::{Polytope, VertexId};

/// A contact rolls over to the next facet or the one after, on hulls of a thousand vertices over some
/// more; one that is not found by then is not near, or the nearest point is no facet's, and GJK finds it
/// in fewer steps.
const MAX_WALK: usize = 10;

/// On the way from facet to facet.
struct Trail {
    /// The features that span the facet to look at.
    features: [Feature; 2],
    /// Where these span no plane, it tells where to look.
    normal: DVec3,
    /// The side that was crossed last.
    crossed: Option<[[VertexId; 2]; 2]>,
    steps_left: usize,
    /// That of an answer by this facet.
    stage: Stage,
    /// Those of answers by GJK and EPA.
    gjk: [Stage; 2],
}

/// The facet to look at next, if there is one, and the ends of where it was looked for.
type Way = (Option<[Feature; 2]>, [[VertexId; 2]; 2]);

type Found = Option<(Answer, Stage)>;

impl<A: Polytope, B: Polytope> Query<'_, '_, A, B> {
    /// Re-evaluates the facet that `features` span.
    #[inline(always)]
    pub(crate) fn certify(&mut self, features: [Feature; 2]) -> Verdict {
        let (max, tolerance) = (self.max_distance, self.tolerance());
        feature::certify(self.cso, features, max, tolerance, self.cost)
    }

    /// Answers by the facet of a contact that is remembered, if the `verdict` on it allows that, or goes
    /// on from there.
    pub(crate) fn follow_contact(
        &mut self,
        normal: DVec3,
        features: [Feature; 2],
        verdict: &Verdict,
    ) -> Found {
        let mut trail = self.trail(normal, features, Stage::Feature, WARM);
        match self.step(verdict, &mut trail) {
            ControlFlow::Break(found) => found,
            ControlFlow::Continue(()) => self.walk(trail),
        }
    }

    /// Walks from the facet that `features` span.
    pub(super) fn follow(
        &mut self,
        normal: DVec3,
        features: [Feature; 2],
        gjk: [Stage; 2],
    ) -> Found {
        self.walk(self.trail(normal, features, Stage::Walk, gjk))
    }

    fn trail(&self, normal: DVec3, features: [Feature; 2], stage: Stage, gjk: [Stage; 2]) -> Trail {
        Trail {
            features,
            normal,
            crossed: None,
            steps_left: if self.is_far_sighted() { 0 } else { MAX_WALK },
            stage,
            gjk,
        }
    }

    fn walk(&mut self, mut trail: Trail) -> Found {
        loop {
            let verdict = self.certify(trail.features);
            if let ControlFlow::Break(found) = self.step(&verdict, &mut trail) {
                return found;
            }
        }
    }

    /// Answers by the facet at hand, or by GJK and EPA where the way ends; else goes to the next facet.
    #[inline(always)]
    fn step(&mut self, verdict: &Verdict, trail: &mut Trail) -> ControlFlow<Found> {
        let (next, ends) = match verdict {
            Verdict::Apart(apart) => {
                return ControlFlow::Break(Some((Answer::Apart(*apart), trail.stage)));
            }
            Verdict::Certified(proximity) => {
                return ControlFlow::Break(Some((Answer::Near(*proximity), trail.stage)));
            }
            Verdict::Unproved(candidate) => {
                return ControlFlow::Break(self.find_depth(candidate, trail.stage, trail.gjk));
            }
            Verdict::Beyond(side) => self.cross(side, trail),
            Verdict::Cut(vertex, normal) => {
                (walk::around(self.cso, vertex, *normal), [vertex.ids; 2])
            }
            Verdict::NoPlane => {
                let (max, tolerance) = (self.max_distance, self.tolerance());
                let at_corner =
                    corner::certify(self.cso, trail.features, max, tolerance, self.cost);
                if let Some(answer) = at_corner {
                    return ControlFlow::Break(Some((answer, trail.stage)));
                }
                self.start_anew(trail.normal, feature::vertices(self.cso, trail.features))
            }
        };
        match next {
            Some(next) if trail.steps_left > 0 => trail.features = next,
            _ => {
                let ends = both(ends, |ids| self.cso.vertex(ids));
                let distinct = if ends[0].ids == ends[1].ids { 1 } else { 2 };
                return ControlFlow::Break(self.run_gjk(&ends[..distinct], trail.gjk));
            }
        }
        trail.steps_left -= 1;
        trail.stage = Stage::Walk;
        ControlFlow::Continue(())
    }

    /// Over a side, unless that leads back.
    #[inline(always)]
    fn cross(&mut self, side: &Side, trail: &mut Trail) -> Way {
        let [from, to] = side.ends;
        // A facet that has its face of shape 2 goes around the other way.
        let back = trail.crossed == Some([to, from]) || trail.crossed == Some([from, to]);
        trail.crossed = Some(side.ends);
        let across = (!back).then(|| walk::across(self.cso, side)).flatten();
        match across {
            Some(next) if next != trail.features => (Some(next), side.ends),
            _ => self.leave(trail.features, side, trail.normal),
        }
    }

    /// Where the way over a side leads back. Two edges may span no facet at these poses, and any plane
    /// then: they are left by the vertex that is extreme along `normal`. Else the nearest point lies on the
    /// side.
    fn leave(&mut self, features: [Feature; 2], side: &Side, normal: DVec3) -> Way {
        if let [Feature::Edge(_), Feature::Edge(_)] = features {
            let [from, _] = side.ends;
            let vertex = self.cso.support(side.normal, from, self.cost);
            if side.normal.dot(vertex.w - self.cso.vertex(from).w) > self.tolerance() {
                return self.start_anew(normal, vertex.ids);
            }
        }
        (None, side.ends)
    }

    /// To a facet at the vertex that is extreme along `normal`.
    fn start_anew(&mut self, normal: DVec3, start: [VertexId; 2]) -> Way {
        let vertex = self.cso.support(normal, start, self.cost);
        (walk::around(self.cso, &vertex, normal), [vertex.ids; 2])
    }
}
