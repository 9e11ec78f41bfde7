//! The coherent query: from what the previous frame knew, the cheapest stage that can *prove*
//! its answer gives it.
//!
//! 1. [`Stage::BoundingSpheres`]: the bounding spheres are apart.
//! 2. [`Stage::Axis`]: one support pair along the previous axis still separates.
//! 3. [`Stage::Feature`]: the previous nearest features still prove distance or depth.
//! 4. [`Stage::FacetWalk`]: features next to them do.
//! 5. [`Stage::CachedPolytope`]: those features do, with the polytope of the previous expansion.
//! 6. [`Stage::WarmGjk`]: incremental GJK from the previous axis and vertices.
//! 7. [`Stage::WarmEpa`]: the depth, expanded from the previous features.
//!
//! A pair without a previous frame starts with the line of centres as its axis; GJK and EPA count
//! as cold for it. A stale or wrong memory costs time, never accuracy: nothing is believed that is not
//! re-evaluated at the present poses.

mod certificate;
mod facet_walk;
mod gauss_map;
mod seeds;
mod types;
mod witness;

pub(crate) use certificate::facet::vertex_of;
pub use certificate::facet::vertices;
pub(crate) use certificate::verdict::Verdict;
pub use types::{Answer, Feature, PairMemory, Proximity};

pub use crate::epa::EpaScratch;
pub use crate::gjk::SeparatingAxis;
pub use crate::pose::RelativePose;
pub use crate::ray_cast::{Impact, RayCast, ray_cast};
pub use crate::stats::Cost;
pub use crate::support::{Cso, FaceId, Polytope, Support, VertexId};

use glam::DVec3;

use crate::epa::{self, DepthSearch, Penetration, PolytopeCache};
use crate::gjk::{self, Closest, Outcome, Simplex};
use crate::simplex::Preferred;
use crate::stats::Stage;
use crate::support::CsoVertex;
use crate::tolerance::DEPTH_GAP;
use crate::tuning::{FACET_WALK_RANGE, TILT};
use certificate::{facet, neighbors};
use seeds::EpaSeeds;

/// Whether a query goes on from a previous frame: what GJK and EPA count as.
#[derive(Clone, Copy)]
pub(crate) enum Start {
    Warm,
    Cold,
}

impl Start {
    fn gjk(self) -> Stage {
        match self {
            Self::Warm => Stage::WarmGjk,
            Self::Cold => Stage::ColdGjk,
        }
    }

    fn epa(self) -> Stage {
        match self {
            Self::Warm => Stage::WarmEpa,
            Self::Cold => Stage::ColdEpa,
        }
    }
}

/// A query between two shapes.
pub struct Query<'a, 'c, A, B> {
    /// The pair.
    pub cso: &'a Cso<'c, A, B>,
    /// Answers beyond this distance are [`Answer::Separated`].
    pub max_distance: f64,
    /// Polytopes of earlier expansions, and the pair's key among them. They save work where a deep
    /// pair is asked about in every frame, and change no bit of an answer.
    pub polytope_cache: Option<(&'a mut PolytopeCache, u64)>,
    /// Memory for the expanding polytope.
    pub scratch: &'a mut EpaScratch,
    /// Filled in with what the query cost.
    pub cost: &'a mut Cost,
}

impl<A: Support, B: Support> Query<'_, '_, A, B> {
    /// The stages that need no faces, for shapes that have none: whether the bounding spheres are too far apart,
    /// or the axis that is remembered, or else the line of centres, separates. `None` proves nothing.
    pub fn prove_apart(&mut self, memory: &PairMemory) -> Option<(SeparatingAxis, Stage)> {
        if let Some(apart) = self.spheres_apart(memory) {
            return Some((apart, Stage::BoundingSpheres));
        }
        let (axis, start) = match *memory {
            PairMemory::Axis(axis, ids) => (axis, ids),
            _ => {
                let axis = self.cso.towards_origin();
                (axis, self.cso.start_vertices(axis))
            }
        };
        let apart = self
            .test_axis(axis, start)
            .or_else(|vertex| self.test_axis(tilted(axis, &vertex), vertex.ids));
        Some((apart.ok()?, Stage::Axis))
    }

    /// Whether the bounding spheres are too far apart already: no vertex is looked at. What
    /// was remembered of the vertices stays.
    #[inline(always)]
    fn spheres_apart(&self, memory: &PairMemory) -> Option<SeparatingAxis> {
        let (axis, separation) = self.cso.spheres_apart(self.max_distance)?;
        Some(SeparatingAxis {
            axis,
            separation,
            ids: match *memory {
                PairMemory::Axis(_, ids) => ids,
                _ => self.cso.start_vertices(axis),
            },
        })
    }

    /// Whether an axis separates; if not, the vertex that is too near along it. `ids` may be those of a
    /// memory: it is started from those that there are.
    #[inline(always)]
    pub(crate) fn test_axis(
        &mut self,
        axis: DVec3,
        ids: [VertexId; 2],
    ) -> Result<SeparatingAxis, CsoVertex> {
        let start = self.clamp_vertices(ids);
        gjk::test_axis(self.cso, axis, start, self.max_distance, self.cost)
    }

    fn clamp_vertices(&self, ids: [VertexId; 2]) -> [VertexId; 2] {
        [
            self.cso.shape_1.clamp_vertex(ids[0]),
            self.cso.shape_2.clamp_vertex(ids[1]),
        ]
    }
}

/// An axis tilted away from where the shapes come too near along it.
#[inline]
fn tilted(axis: DVec3, too_near: &CsoVertex) -> DVec3 {
    let sideways = too_near.w - axis * axis.dot(too_near.w);
    (axis - sideways.normalize_or_zero() * TILT).normalize()
}

impl<A: Polytope, B: Polytope> Query<'_, '_, A, B> {
    /// Answers from `memory` where that is possible, cold otherwise. `None` only if the shapes
    /// have no volume between them or are not finite.
    pub fn run(&mut self, memory: &PairMemory) -> Option<(Answer, Stage)> {
        match self.spheres_apart(memory) {
            Some(apart) => Some((Answer::Separated(apart), Stage::BoundingSpheres)),
            None => self.run_near(memory),
        }
    }

    /// As [`run`](Self::run), of a pair whose bounding spheres are known not to be too far apart.
    fn run_near(&mut self, memory: &PairMemory) -> Option<(Answer, Stage)> {
        match *memory {
            PairMemory::None => self.start_from_centers(),
            PairMemory::Axis(axis, ids) => self.start_from_axis(axis, ids, Start::Warm),
            PairMemory::Contact(normal, features) => {
                let verdict = self.certify(features);
                self.start_from_features(normal, features, &verdict)
            }
        }
    }

    /// Without memory: along the line of centres.
    pub(crate) fn start_from_centers(&mut self) -> Option<(Answer, Stage)> {
        let axis = self.cso.towards_origin();
        self.start_from_axis(axis, self.cso.start_vertices(axis), Start::Cold)
    }

    fn start_from_axis(
        &mut self,
        axis: DVec3,
        start: [VertexId; 2],
        from: Start,
    ) -> Option<(Answer, Stage)> {
        match self.test_axis(axis, start) {
            Ok(apart) => Some((Answer::Separated(apart), Stage::Axis)),
            Err(vertex) => self.start_from_tilted_axis(axis, vertex, from),
        }
    }

    /// Goes on where an axis does not separate. Often one does that is tilted away from where the shapes
    /// come too near; else the facets around are the next to look at.
    pub(crate) fn start_from_tilted_axis(
        &mut self,
        axis: DVec3,
        vertex: CsoVertex,
        from: Start,
    ) -> Option<(Answer, Stage)> {
        if self.skips_facet_walk() {
            return self.run_gjk(&[vertex], from);
        }
        let tilted = tilted(axis, &vertex);
        match self.test_axis(tilted, vertex.ids) {
            Ok(apart) => Some((Answer::Separated(apart), Stage::Axis)),
            Err(second) => match gauss_map::facet_at_vertex(self.cso, &second, tilted) {
                Some(features) => self.walk_from(tilted, features, from),
                None => self.run_gjk(&[vertex, second], from),
            },
        }
    }

    /// Two bounds on a depth that differ by at most this count as equal.
    fn tolerance(&self) -> f64 {
        DEPTH_GAP * self.cso.min_radius()
    }

    fn skips_facet_walk(&self) -> bool {
        self.max_distance > FACET_WALK_RANGE * self.cso.size()
    }

    /// GJK from vertices of the Minkowski difference, and EPA if the shapes overlap, or may.
    fn run_gjk(&mut self, start: &[CsoVertex], from: Start) -> Option<(Answer, Stage)> {
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

    /// EPA from GJK's last simplex. What it finds apart is so by hardly more than rounding.
    fn run_epa(&mut self, simplex: &Simplex, stage: Stage) -> Option<(Answer, Stage)> {
        let mut seeds = EpaSeeds::default();
        simplex.vertices().for_each(|vertex| seeds.push(*vertex));
        let seeds = seeds.as_slice();
        let depth = epa::penetration(self.cso, seeds, self.scratch, self.cost)?;
        self.store_polytope();
        let answer = self
            .apart(&depth)
            .map_or_else(|| self.overlapping(&depth), Answer::Separated);
        Some((answer, stage))
    }

    /// The normal of a face that EPA found to separate farther than was asked about.
    fn apart(&self, depth: &Penetration) -> Option<SeparatingAxis> {
        (-depth.depth > self.max_distance).then(|| SeparatingAxis {
            axis: depth.normal,
            separation: -depth.depth,
            ids: depth.face[0].ids,
        })
    }

    /// The depth, which may be proved to be the candidate's by a polytope of a previous frame, or by the
    /// facets around. If not EPA grows one from points near the candidate; where it finds the shapes
    /// separate, GJK finds how far.
    fn find_depth(
        &mut self,
        candidate: &Proximity,
        stage: Stage,
        from: Start,
    ) -> Option<(Answer, Stage)> {
        let known = -candidate.signed_distance;
        if let Some((cache, key)) = &mut self.polytope_cache
            && cache.proves_depth(*key, self.cso, known, self.scratch, self.cost)
        {
            return Some((Answer::Near(*candidate), Stage::CachedPolytope));
        }
        if neighbors::contains_ball(self.cso, candidate, self.tolerance()) {
            return Some((Answer::Near(*candidate), stage));
        }
        let seeds = EpaSeeds::under(self.cso, candidate.features);
        let (cso, seeds) = (self.cso, seeds.as_slice());
        let depth = epa::penetration_below(cso, seeds, known, self.scratch, self.cost)?;
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

    /// Keeps the polytope that EPA expanded for the frames to come.
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
            features: facet::of_simplex(self.cso, closest.simplex.vertices(), closest.normal),
        })
    }

    fn overlapping(&mut self, depth: &Penetration) -> Answer {
        Answer::Near(witness::of_depth(self.cso, depth, self.cost))
    }
}
