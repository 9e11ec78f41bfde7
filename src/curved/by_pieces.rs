//! Answers by the pieces of surface that meet along a normal, or close to it.

use std::ops::ControlFlow;

use glam::DVec3;

use super::bends;
use super::query::{CurvedAnswer, CurvedQuery, apart};
use super::rim_edge::{self, RimPartner};
use super::separation::NormalSeparation;
use super::stationary;
use super::surface_pieces::SurfacePieces;
use crate::stats::Cost;
use crate::support::Cso;
use crate::tolerance::DEPTH_GAP;
use crate::tuning::{FLUSH_TIE, LARGE_TURN, SMALL_TURN, STILL};

/// Finds a candidate for a better normal than the one at hand.
type FindNormal<A, B> =
    fn(&Cso<'_, A, B>, &NormalSeparation, &mut Cost) -> Option<NormalSeparation>;

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// The answer, if the pieces of surface near a normal give it, or of round shapes in contact, farther ruled sides;
    /// otherwise the best normal found.
    pub(super) fn by_pieces(
        &mut self,
        at: &NormalSeparation,
        are_in_contact: bool,
    ) -> ControlFlow<CurvedAnswer, NormalSeparation> {
        match self.stationary(at) {
            ControlFlow::Continue(best) if are_in_contact && self.are_both_round(at) => {
                self.far_stationary(at, best)
            }
            found => found,
        }
    }

    /// Whether both shapes have a rim. The normal of a pair with a polytope is mostly that of a face, and its many edges
    /// would take as long as a search.
    fn are_both_round(&self, at: &NormalSeparation) -> bool {
        let outward_2 = -self.cso.pose.direction_to_2(at.normal);
        let Cso {
            shape_1, shape_2, ..
        } = self.cso;
        shape_1.rim(at.normal).is_some() && shape_2.rim(outward_2).is_some()
    }

    /// The answer, if the pieces of surface near a normal give it; otherwise the best normal found.
    pub(super) fn stationary(
        &mut self,
        at: &NormalSeparation,
    ) -> ControlFlow<CurvedAnswer, NormalSeparation> {
        let steps: [FindNormal<A, B>; 5] = [
            |cso, at, cost| stationary::flat(cso, at, SMALL_TURN, cost),
            |cso, at, cost| stationary::ruled(cso, at, SMALL_TURN, cost),
            |cso, at, cost| stationary::along_rulings(cso, at, SMALL_TURN, cost),
            stationary::smooth,
            |cso, at, cost| stationary::flat(cso, at, f64::INFINITY, cost),
        ];
        self.first_proved(at, *at, &steps)
    }

    /// The same by ruled sides that the normal `at` misses by more; `best` is the best normal so far.
    fn far_stationary(
        &mut self,
        at: &NormalSeparation,
        best: NormalSeparation,
    ) -> ControlFlow<CurvedAnswer, NormalSeparation> {
        let steps: [FindNormal<A, B>; 2] = [
            |cso, at, cost| stationary::ruled(cso, at, LARGE_TURN, cost),
            |cso, at, cost| stationary::along_rulings(cso, at, LARGE_TURN, cost),
        ];
        self.first_proved(at, best, &steps)
    }

    /// The first answer that candidates for a better normal give; otherwise the best of them.
    fn first_proved(
        &mut self,
        at: &NormalSeparation,
        mut best: NormalSeparation,
        steps: &[FindNormal<A, B>],
    ) -> ControlFlow<CurvedAnswer, NormalSeparation> {
        for step in steps {
            let Some(found) = step(self.cso, at, self.cost) else {
                continue;
            };
            if found.distance > self.max_distance {
                return ControlFlow::Break(apart(&found));
            }
            // A normal that is worse than the best one cannot be proved.
            if found.distance < best.distance - self.tolerance() {
                continue;
            }
            best = found;
            if let Some(answer) = self.prove(&found) {
                return ControlFlow::Break(answer);
            }
        }
        ControlFlow::Continue(best)
    }

    pub(super) fn tolerance(&self) -> f64 {
        DEPTH_GAP * self.cso.min_radius() + self.rounding()
    }

    /// How far the difference may reach beyond a support point.
    pub(super) fn rounding(&self) -> f64 {
        self.cso.shape_1.rounding() + self.cso.shape_2.rounding()
    }

    /// The answer along a normal, if the extreme points or the patch prove it.
    fn prove(&mut self, found: &NormalSeparation) -> Option<CurvedAnswer> {
        let near = |on_1| CurvedAnswer::Near {
            signed_distance: found.distance,
            normal: found.normal,
            on_1,
        };
        let tolerance = self.tolerance();
        let moved = found.normal * self.border_radii[0];
        self.scratch.patch.aim(found.normal, &found.extreme);
        let is_distance = found.distance > 0.0;
        if is_distance && found.extreme.w.length() <= found.distance + tolerance
            || bends::prove_depth(self.cso, found, tolerance)
        {
            return Some(near(found.extreme.on_1 + moved));
        }
        if let Some(on_1) = self.prove_by_patch(found) {
            return Some(near(on_1 + moved));
        }
        let patch = &mut self.scratch.patch;
        patch.complete(self.cso, self.border_radii);
        if let Some(deepest) = patch.proved(self.cso, found.distance, tolerance) {
            return Some(near(deepest.on_1));
        }
        let on_1 = rim_edge::proved_crossing(self.cso, RimPartner::Line, found, tolerance)?;
        Some(near(on_1 + moved))
    }

    /// The point of core 1 where a few places of the patch, or a rim that crosses an edge, prove a normal.
    fn prove_by_patch(&mut self, found: &NormalSeparation) -> Option<DVec3> {
        let (cso, tolerance) = (self.cso, self.tolerance());
        let patch = &mut self.scratch.patch;
        patch.find_cores(cso);
        let drift = STILL * cso.min_radius();
        let last = self.last;
        if let Some(last) = last.filter(|last| last.are_within(found.normal, drift)) {
            patch.add_guess(last.middle_of_deepest(found.normal, FLUSH_TIE * tolerance));
            if let Some(place) = patch.proved(cso, found.distance, tolerance) {
                return Some(place.on_1);
            }
        }
        patch.find_extremes();
        match patch.proved(cso, found.distance, tolerance) {
            Some(place) => Some(place.on_1),
            None => rim_edge::proved_crossing(cso, RimPartner::Edge, found, tolerance),
        }
    }
}
