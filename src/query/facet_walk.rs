//! Walks from facet to facet of the Minkowski difference, until the origin projects into one.

use std::ops::ControlFlow;

use glam::DVec3;

use super::certificate::flush::FlushFaces;
use super::certificate::{boxes, facet, vertex_edge};
use super::feature::{self, Feature};
use super::gauss_map;
use super::pipeline::Found;
use super::types::{Answer, Proximity, Query, Start};
use super::verdict::{FacetEdge, Verdict};
use crate::map_pair::map_pair;
use crate::stats::Stage;
use crate::support::{Polytope, VertexId};

/// A contact rolls on by a facet or two, or by a few more on hulls of a thousand vertices. If the walk takes
/// longer, the right facet is far away, or the nearest point lies on no facet, and GJK finds it in fewer
/// steps.
const MAX_WALK: usize = 10;

/// The state of a walk.
struct FacetWalk<'f> {
    /// The features that span the current facet.
    features: [Feature; 2],
    /// The direction in which to look if these span no plane.
    normal: DVec3,
    /// Faces that may prove the depth of the facet where the walk ends.
    flush: Option<&'f FlushFaces>,
    /// The last side that was crossed.
    crossed: Option<[[VertexId; 2]; 2]>,
    steps_left: usize,
    /// The stage to report if this facet answers.
    stage: Stage,
    /// Whether GJK and EPA count as warm or cold.
    from: Start,
}

/// The next facet, if there is one, and the ends of the side across which it was sought.
type NextFacet = (Option<[Feature; 2]>, [[VertexId; 2]; 2]);

impl<A: Polytope, B: Polytope> Query<'_, '_, A, B> {
    /// Re-evaluates the facet that `features` span. If the faces in contact lie `flush`, these may prove it.
    #[inline(always)]
    pub(super) fn certify(
        &mut self,
        features: [Feature; 2],
        flush: impl FnMut() -> Option<FlushFaces>,
    ) -> Verdict {
        let limits = [self.max_distance, self.tolerance()];
        facet::certify(self.cso, features, flush, limits, self.cost)
    }

    /// Answers with the facet of a remembered contact if its `verdict` allows that. Otherwise walks on from there.
    /// The `flush` faces may prove its depth.
    pub(super) fn start_walk_from_features(
        &mut self,
        normal: DVec3,
        features: [Feature; 2],
        verdict: &Verdict,
        flush: Option<&FlushFaces>,
    ) -> Found {
        let mut walk = self.start_walk(normal, features, Stage::Feature, Start::Warm);
        walk.flush = flush;
        match self.step(verdict, &mut walk) {
            ControlFlow::Break(found) => found,
            ControlFlow::Continue(()) => self.run_walk(walk),
        }
    }

    /// Walks from the facet that `features` span.
    pub(super) fn walk_from(
        &mut self,
        normal: DVec3,
        features: [Feature; 2],
        from: Start,
    ) -> Found {
        self.run_walk(self.start_walk(normal, features, Stage::FacetWalk, from))
    }

    fn start_walk(
        &self,
        normal: DVec3,
        features: [Feature; 2],
        stage: Stage,
        from: Start,
    ) -> FacetWalk<'static> {
        FacetWalk {
            features,
            normal,
            flush: None,
            crossed: None,
            steps_left: if self.skips_facet_walk() { 0 } else { MAX_WALK },
            stage,
            from,
        }
    }

    fn run_walk(&mut self, mut walk: FacetWalk<'_>) -> Found {
        loop {
            let verdict = self.certify(walk.features, || None);
            if let ControlFlow::Break(found) = self.step(&verdict, &mut walk) {
                return found;
            }
        }
    }

    /// Answers with the current facet, or with GJK and EPA where the walk ends. Otherwise goes to the next
    /// facet.
    #[inline(always)]
    fn step(&mut self, verdict: &Verdict, walk: &mut FacetWalk<'_>) -> ControlFlow<Found> {
        let (next, ends) = match verdict {
            Verdict::Separated(apart) => {
                return ControlFlow::Break(Some((Answer::Separated(*apart), walk.stage)));
            }
            Verdict::Certified(proximity) => {
                return ControlFlow::Break(Some((Answer::Near(*proximity), walk.stage)));
            }
            Verdict::Undecided(candidate, inset) => match self.nearest_facet(walk) {
                Some(nearest) => nearest,
                None => return ControlFlow::Break(self.end_walk((candidate, *inset), walk)),
            },
            Verdict::OutsideEdge(side) => self.cross_edge(side, walk),
            Verdict::NotSupporting(vertex, normal) => (
                gauss_map::facet_at_vertex(self.cso, vertex, *normal),
                [vertex.ids; 2],
            ),
            Verdict::Degenerate => {
                let (max, tolerance) = (self.max_distance, self.tolerance());
                let at_corner =
                    vertex_edge::certify(self.cso, walk.features, max, tolerance, self.cost);
                if let Some(answer) = at_corner {
                    return ControlFlow::Break(Some((answer, walk.stage)));
                }
                self.restart_at(walk.normal, feature::vertices(self.cso, walk.features))
            }
        };
        match next {
            Some(next) if walk.steps_left > 0 => walk.features = next,
            _ => {
                let ends = map_pair(ends, |ids| self.cso.vertex(ids));
                let distinct = if ends[0].ids == ends[1].ids { 1 } else { 2 };
                return ControlFlow::Break(self.run_gjk(&ends[..distinct], walk.from));
            }
        }
        walk.steps_left -= 1;
        walk.stage = Stage::FacetWalk;
        ControlFlow::Continue(())
    }

    /// The facet that is nearest, if the shapes tell it at once, and if it is another one than the current facet.
    #[inline]
    fn nearest_facet(&mut self, walk: &FacetWalk<'_>) -> Option<NextFacet> {
        let next = boxes::nearest_facet(self.cso, self.cost)?;
        let is_next = next != walk.features && walk.steps_left > 0;
        is_next.then(|| (Some(next), [feature::vertices(self.cso, next); 2]))
    }

    /// The depth where the walk ends, given a candidate and its inset.
    #[inline]
    fn end_walk(&mut self, candidate: (&Proximity, f64), walk: &FacetWalk<'_>) -> Found {
        self.find_depth(candidate, walk.flush, walk.stage, walk.from)
    }

    /// Crosses a side, unless that leads back.
    #[inline(always)]
    fn cross_edge(&mut self, side: &FacetEdge, walk: &mut FacetWalk<'_>) -> NextFacet {
        let [from, to] = side.ends;
        // The corners of a facet with a face of shape 2 turn the other way.
        let back = walk.crossed == Some([to, from]) || walk.crossed == Some([from, to]);
        walk.crossed = Some(side.ends);
        let across = (!back)
            .then(|| gauss_map::adjacent_facet(self.cso, side))
            .flatten();
        match across {
            Some(next) if next != walk.features => (Some(next), side.ends),
            _ => self.leave_facet(walk.features, side, walk.normal),
        }
    }

    /// Handles a side across which the walk leads back. At these poses two edges may span no facet, but some
    /// arbitrary plane: then the walk restarts at the vertex that is extreme along `normal`. Otherwise the
    /// nearest point lies on the side.
    fn leave_facet(
        &mut self,
        features: [Feature; 2],
        side: &FacetEdge,
        normal: DVec3,
    ) -> NextFacet {
        if let [Feature::Edge(_), Feature::Edge(_)] = features {
            let [from, _] = side.ends;
            let vertex = self.cso.support(side.normal, from, self.cost);
            if side.normal.dot(vertex.w - self.cso.vertex(from).w) > self.tolerance() {
                return self.restart_at(normal, vertex.ids);
            }
        }
        (None, side.ends)
    }

    /// Goes to a facet at the vertex that is extreme along `normal`.
    fn restart_at(&mut self, normal: DVec3, start: [VertexId; 2]) -> NextFacet {
        let vertex = self.cso.support(normal, start, self.cost);
        (
            gauss_map::facet_at_vertex(self.cso, &vertex, normal),
            [vertex.ids; 2],
        )
    }
}
