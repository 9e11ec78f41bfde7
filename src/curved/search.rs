//! Searches by GJK and EPA, for the pieces of surface in contact, and for the answer if no piece proves it.

use std::ops::ControlFlow;

use glam::DVec3;

use super::query::{CurvedAnswer, CurvedQuery, CurvedScratch, apart};
use super::separation::NormalSeparation;
use super::surface_pieces::SurfacePieces;
use crate::epa::{self, DepthSearch};
use crate::gjk::{self, Outcome};
use crate::query::{Start, moved_apart};
use crate::simplex::Preferred;
use crate::stats::Stage;
use crate::tolerance::{FINE_GAP, SAME_GAP};
use crate::tuning::COARSE_GAP;

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// A coarse search for the distance leads to the pieces in contact. If they do not prove the answer, a
    /// fine search finds it. `None` if the cores touch or overlap.
    pub(super) fn by_gjk(
        &mut self,
        at: &NormalSeparation,
        start: Start,
    ) -> Option<(CurvedAnswer, Stage)> {
        let stage = start.gjk();
        let size = self.cso.size();
        let (mut vertices, mut count) = ([at.extreme; 3], 1);
        let coarse = COARSE_GAP * self.cso.min_radius();
        for gap in [coarse, self.fine_gap()] {
            let outcome = gjk::distance_within::<Preferred, _, _>(
                self.cso,
                &vertices[..count],
                self.max_distance,
                gap / size,
                self.cost,
            );
            let closest = match outcome {
                Outcome::Separated(axis) => return Some((CurvedAnswer::Separated(axis), stage)),
                Outcome::Disjoint(closest) => closest,
                Outcome::Unsure(_) | Outcome::Overlapping(_) => return None,
            };
            let near = NormalSeparation::along(self.cso, closest.normal, &at.extreme, self.cost);
            if let ControlFlow::Break(answer) = self.stationary(&near) {
                return Some((answer, stage));
            }
            let is_fine = gap < self.tolerance();
            if is_fine && closest.distance - closest.lower_bound <= self.tolerance() {
                let patch = &mut self.scratch.patch;
                patch.aim(near.normal, &near.extreme);
                patch.complete(self.cso, self.border_radii);
                return Some((
                    CurvedAnswer::Near {
                        signed_distance: closest.distance,
                        normal: closest.normal,
                        on_1: closest.on_1 + closest.normal * self.border_radii[0],
                    },
                    stage,
                ));
            }
            count = 0;
            for (place, vertex) in vertices.iter_mut().zip(closest.simplex.vertices()) {
                *place = *vertex;
                count += 1;
            }
        }
        None
    }

    /// How near the bounds of a fine search get to each other.
    fn fine_gap(&self) -> f64 {
        FINE_GAP * self.cso.min_radius() + self.rounding()
    }

    /// A coarse search for the depth leads to the pieces in contact. If they do not prove the answer, a fine
    /// search finds it, or proves that there is no smaller depth than `best`. If `best` is from the previous
    /// frame (`is_known`), the coarse search is left out. Searches start at the pieces along the best normal.
    pub(super) fn by_epa(
        &mut self,
        mut best: NormalSeparation,
        is_known: bool,
    ) -> Option<CurvedAnswer> {
        let mut on_1 = best.extreme.on_1;
        let coarse = COARSE_GAP * self.cso.min_radius();
        let tolerances = [coarse, self.tolerance()];
        let CurvedScratch { patch, seeds, .. } = &mut *self.scratch;
        patch.aim(best.normal, &best.extreme);
        patch.find_cores(self.cso);
        patch.outline_differences(seeds);
        for tolerance in &tolerances[usize::from(is_known)..] {
            let known = if *tolerance < coarse {
                -best.distance
            } else {
                f64::INFINITY
            };
            let limits = [known, *tolerance];
            let CurvedScratch { epa, seeds, .. } = &mut *self.scratch;
            match epa::penetration_within(self.cso, seeds, limits, epa, self.cost)? {
                DepthSearch::NotBelow => return Some(self.along(&best, on_1)),
                DepthSearch::Found(found) => {
                    on_1 = found.on_1;
                    let near =
                        NormalSeparation::along(self.cso, found.normal, &best.extreme, self.cost);
                    best = match self.stationary(&near) {
                        ControlFlow::Break(answer) => return Some(answer),
                        ControlFlow::Continue(found) => best.or(found),
                    };
                    if found.depth < 0.0 {
                        let apart = self.by_gjk(&best, Start::Warm).map(|(answer, _)| answer);
                        return apart.or_else(|| Some(self.along(&best, on_1)));
                    }
                }
            }
        }
        Some(self.along(&best, on_1))
    }

    /// The answer along a normal that is known to be the best one. If no pieces overlap, the contact is at a
    /// point of the first core.
    fn along(&mut self, best: &NormalSeparation, on_1: DVec3) -> CurvedAnswer {
        if best.distance > self.max_distance {
            return apart(best);
        }
        let patch = &mut self.scratch.patch;
        patch.aim(best.normal, &best.extreme);
        patch.complete(self.cso, self.border_radii);
        let radius = self.cso.min_radius();
        let limit = best.distance - patch.borders() + SAME_GAP * radius;
        let on_1 = match patch.deepest_point() {
            Some((on_1, distance)) if distance <= limit => on_1,
            _ => self.witness(best).unwrap_or(on_1) + best.normal * self.border_radii[0],
        };
        CurvedAnswer::Near {
            signed_distance: best.distance,
            normal: best.normal,
            on_1,
        }
    }

    /// The point of the first core that is deepest along a normal.
    fn witness(&mut self, best: &NormalSeparation) -> Option<DVec3> {
        let (cso, normal) = (self.cso, best.normal);
        let closest = moved_apart(
            cso,
            normal * -best.distance,
            normal,
            |apart, cost| [apart.support(normal, best.extreme.ids, cost)],
            self.fine_gap() / cso.size(),
            self.cost,
        )?;
        Some(closest.on_1)
    }
}
