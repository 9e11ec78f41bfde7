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
mod witness;

pub(crate) use certificate::facet::vertex_of;
pub use certificate::facet::{Feature, vertices};
pub(crate) use certificate::verdict::Verdict;

use glam::DVec3;

use crate::epa::{self, DepthSearch, EpaScratch, Penetration, PolytopeCache};
use crate::gjk::{self, Closest, Outcome, SeparatingAxis, Simplex};
use crate::simplex::Preferred;
use crate::stats::{Cost, Stage};
use crate::support::{Cso, CsoVertex, Polytope, Support, VertexId};
use crate::tolerance::DEPTH_GAP;
use crate::tuning::{FACET_WALK_RANGE, TILT};
use certificate::{facet, neighbors};
use seeds::EpaSeeds;

/// What GJK and EPA count as in a query that goes on from a previous frame, and without one.
pub(crate) const WARM: [Stage; 2] = [Stage::WarmGjk, Stage::WarmEpa];
const COLD: [Stage; 2] = [Stage::ColdGjk, Stage::ColdEpa];

/// What is remembered of a pair from one frame to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairMemory {
    /// Nothing: the pair is new.
    None,
    /// The shapes were apart along this unit axis (frame 1), at these vertices.
    Axis(DVec3, [VertexId; 2]),
    /// The shapes were in contact along this unit normal (frame 1), at these features.
    Contact(DVec3, [Feature; 2]),
}

/// Signed distance, normal and witness points of a pair. All in frame 1.
#[derive(Clone, Copy, Debug)]
pub struct Proximity {
    /// Distance of disjoint shapes; minus the penetration depth of overlapping ones.
    pub signed_distance: f64,
    /// Unit direction from shape 1 to shape 2 along which they are that far apart.
    pub normal: DVec3,
    /// The witness point on shape 1.
    pub on_1: DVec3,
    /// The witness point on shape 2.
    pub on_2: DVec3,
    /// The features that the witness points lie on.
    pub features: [Feature; 2],
}

/// The answer to a query.
#[derive(Clone, Copy, Debug)]
pub enum Answer {
    /// Farther apart than the query asked about.
    Separated(SeparatingAxis),
    /// This near, or overlapping.
    Near(Proximity),
}

impl Answer {
    /// What the next frame's query is to be given.
    pub fn memory(&self) -> PairMemory {
        match self {
            Self::Separated(apart) => PairMemory::Axis(apart.axis, apart.ids),
            Self::Near(near) => PairMemory::Contact(near.normal, near.features),
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
            PairMemory::Axis(axis, ids) => self.start_from_axis(axis, ids, WARM),
            PairMemory::Contact(normal, features) => {
                let verdict = self.certify(features);
                self.start_from_features(normal, features, &verdict)
            }
        }
    }

    /// Without memory: along the line of centres.
    pub(crate) fn start_from_centers(&mut self) -> Option<(Answer, Stage)> {
        let axis = self.cso.towards_origin();
        self.start_from_axis(axis, self.cso.start_vertices(axis), COLD)
    }

    fn start_from_axis(
        &mut self,
        axis: DVec3,
        start: [VertexId; 2],
        gjk: [Stage; 2],
    ) -> Option<(Answer, Stage)> {
        match self.test_axis(axis, start) {
            Ok(apart) => Some((Answer::Separated(apart), Stage::Axis)),
            Err(vertex) => self.start_from_tilted_axis(axis, vertex, gjk),
        }
    }

    /// Goes on where an axis does not separate. Often one does that is tilted away from where the shapes
    /// come too near; else the facets around are the next to look at.
    pub(crate) fn start_from_tilted_axis(
        &mut self,
        axis: DVec3,
        vertex: CsoVertex,
        gjk: [Stage; 2],
    ) -> Option<(Answer, Stage)> {
        if self.skips_facet_walk() {
            return self.run_gjk(&[vertex], gjk);
        }
        let tilted = tilted(axis, &vertex);
        match self.test_axis(tilted, vertex.ids) {
            Ok(apart) => Some((Answer::Separated(apart), Stage::Axis)),
            Err(second) => match gauss_map::facet_at_vertex(self.cso, &second, tilted) {
                Some(features) => self.walk_from(tilted, features, gjk),
                None => self.run_gjk(&[vertex, second], gjk),
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
    fn run_gjk(&mut self, start: &[CsoVertex], stages: [Stage; 2]) -> Option<(Answer, Stage)> {
        match gjk::distance::<Preferred, _, _>(self.cso, start, self.max_distance, self.cost) {
            Outcome::Separated(apart) => Some((Answer::Separated(apart), stages[0])),
            Outcome::Disjoint(closest) => Some((self.near(&closest), stages[0])),
            Outcome::Unsure(closest) => {
                self.cost.fallbacks += 1;
                self.run_epa(&closest.simplex, stages[1])
            }
            Outcome::Overlapping(simplex) => self.run_epa(&simplex, stages[1]),
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
        gjk: [Stage; 2],
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
            DepthSearch::NotBelow => return Some((Answer::Near(*candidate), gjk[1])),
        };
        if let Some(apart) = self.apart(&depth) {
            return Some((Answer::Separated(apart), gjk[1]));
        }
        if depth.depth < 0.0 {
            return self.run_gjk(&depth.face, gjk);
        }
        Some((self.overlapping(&depth), gjk[1]))
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
