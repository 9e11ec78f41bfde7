//! GJK and EPA, continuing from the cheaper stages.

use super::certificate::flush::FlushFaces;
use super::certificate::neighbors;
use super::feature::{self, Feature};
use super::pipeline::Found;
use super::seeds::EpaSeeds;
use super::types::{Answer, Proximity, Query, Start};
use super::witness;
use crate::epa::{self, DepthSearch, KnownDepth, Penetration};
use crate::gjk::{self, Closest, Outcome, SeparatingAxis, Simplex};
use crate::simplex::Preferred;
use crate::stats::Stage;
use crate::support::{CsoVertex, Polytope, Support};

impl<A: Support, B: Support> Query<'_, '_, A, B> {
    /// The distance by GJK, up to a `gap` between its bounds; `None` if the shapes overlap.
    pub(super) fn measure(&mut self, vertex: CsoVertex, gap: f64, from: Start) -> Found {
        let outcome = gjk::distance_within::<Preferred, _, _>(
            self.cso,
            &[vertex],
            self.max_distance,
            gap,
            self.cost,
        );
        let (closest, normal, signed_distance) = match outcome {
            Outcome::Separated(apart) => return Some((Answer::Separated(apart), from.gjk())),
            Outcome::Overlapping(_) => return None,
            Outcome::Disjoint(closest) => (closest, closest.normal, closest.distance),
            // As in `run_gjk`.
            Outcome::Unsure(closest) => {
                let depth = self.expand(&closest.simplex)?;
                (closest, depth.normal, -depth.depth)
            }
        };
        let answer = if signed_distance > self.max_distance {
            Answer::Separated(SeparatingAxis {
                axis: normal,
                separation: signed_distance,
                ids: vertex.ids,
            })
        } else {
            Answer::Near(Proximity {
                signed_distance,
                normal,
                on_1: closest.on_1,
                on_2: closest.on_2,
                features: vertex.ids.map(Feature::Vertex),
            })
        };
        Some((answer, from.gjk()))
    }

    /// EPA from GJK's last simplex.
    fn expand(&mut self, simplex: &Simplex) -> Option<Penetration> {
        let mut seeds = EpaSeeds::default();
        simplex.vertices().for_each(|vertex| seeds.push(*vertex));
        epa::penetration(self.cso, seeds.as_slice(), self.scratch, self.cost)
    }
}

impl<A: Polytope, B: Polytope> Query<'_, '_, A, B> {
    /// GJK from vertices of the Minkowski difference, and EPA if the shapes overlap, or may.
    pub(super) fn run_gjk(&mut self, start: &[CsoVertex], from: Start) -> Found {
        match gjk::distance::<Preferred, _, _>(self.cso, start, self.max_distance, self.cost) {
            Outcome::Separated(apart) => Some((Answer::Separated(apart), from.gjk())),
            Outcome::Disjoint(closest) => Some((self.near(&closest), from.gjk())),
            Outcome::Unsure(closest) => {
                self.cost.fallbacks += 1;
                self.run_epa(&closest.simplex, from.epa())
            }
            Outcome::Overlapping(simplex) => self.run_epa(&simplex, from.epa()),
        }
    }

    /// EPA from GJK's last simplex. If it finds the shapes apart, their distance is hardly more than
    /// rounding.
    fn run_epa(&mut self, simplex: &Simplex, stage: Stage) -> Found {
        let depth = self.expand(simplex)?;
        self.store_polytope();
        let answer = self
            .apart(&depth)
            .map_or_else(|| self.overlapping(&depth), Answer::Separated);
        Some((answer, stage))
    }

    /// The normal of EPA's last face, if it separates the shapes by more than the maximum distance.
    fn apart(&self, depth: &Penetration) -> Option<SeparatingAxis> {
        (-depth.depth > self.max_distance).then(|| SeparatingAxis {
            axis: depth.normal,
            separation: -depth.depth,
            ids: depth.face[0].ids,
        })
    }

    /// The depth, given a candidate and its inset. Faces that lie flush on each other, a polytope of a
    /// previous frame, or the adjacent facets may prove that the candidate is the least depth. Otherwise EPA
    /// expands a polytope from points near the candidate. If EPA finds that the shapes are apart, GJK finds
    /// the distance.
    pub(super) fn find_depth(
        &mut self,
        (candidate, inset): (&Proximity, f64),
        flush: Option<&FlushFaces>,
        stage: Stage,
        from: Start,
    ) -> Found {
        let known = KnownDepth {
            depth: -candidate.signed_distance,
            normal: candidate.normal,
            inset,
        };
        debug_assert!(known.depth >= 0.0, "they do not overlap: {candidate:?}");
        if flush.is_some_and(|flush| flush.is_depth(self.cso, candidate)) {
            return Some((Answer::Near(*candidate), stage));
        }
        if let Some((cache, key)) = &mut self.polytope_cache
            && cache.proves_depth(*key, self.cso, &known, self.scratch, self.cost)
        {
            return Some((Answer::Near(*candidate), Stage::CachedPolytope));
        }
        if neighbors::contains_ball(self.cso, candidate, self.tolerance()) {
            return Some((Answer::Near(*candidate), stage));
        }
        let seeds = EpaSeeds::under(self.cso, candidate.features);
        let (cso, seeds) = (self.cso, seeds.as_slice());
        let depth = epa::penetration_below(cso, seeds, known.depth, self.scratch, self.cost)?;
        self.store_polytope();
        let depth = match depth {
            DepthSearch::Found(depth) => depth,
            DepthSearch::NotBelow => return Some((Answer::Near(*candidate), from.epa())),
        };
        if let Some(apart) = self.apart(&depth) {
            return Some((Answer::Separated(apart), from.epa()));
        }
        if depth.depth < 0.0 {
            return self.run_gjk(&depth.face, from);
        }
        Some((self.overlapping(&depth), from.epa()))
    }

    /// Keeps the polytope that EPA expanded, for later frames.
    fn store_polytope(&mut self) {
        if let Some((cache, key)) = &mut self.polytope_cache {
            cache.store(*key, self.cso, self.scratch);
        }
    }

    fn near(&self, closest: &Closest) -> Answer {
        Answer::Near(Proximity {
            signed_distance: closest.distance,
            normal: closest.normal,
            on_1: closest.on_1,
            on_2: closest.on_2,
            features: feature::of_simplex(self.cso, closest.simplex.vertices(), closest.normal),
        })
    }

    fn overlapping(&mut self, depth: &Penetration) -> Answer {
        Answer::Near(witness::of_depth(self.cso, depth, self.cost))
    }
}
