//! The coherent query: starting from the previous frame, the cheapest stage that can *prove* its answer gives
//! it. The order of the stages is written once for all shapes and all kinds of queries.
//!
//! 1. [`Stage::BoundingSpheres`]: the bounding spheres are apart.
//! 2. [`Stage::Axis`]: one support pair along the previous axis still separates.
//! 3. [`Stage::Feature`]: the previous nearest features still prove distance or depth.
//! 4. [`Stage::FacetWalk`]: features next to them prove it.
//! 5. [`Stage::CachedPolytope`]: those features prove it, together with the polytope of the previous
//!    expansion.
//! 6. [`Stage::WarmGjk`]: incremental GJK from the previous axis and vertices.
//! 7. [`Stage::WarmEpa`]: the depth, expanded from the previous features.
//!
//! A pair without a previous frame starts with the line of centres as its axis, and its GJK and EPA count as
//! cold. A stale or wrong memory costs time, never accuracy: everything is re-evaluated at the present poses.

use glam::DVec3;

use super::certificate::flush::FlushFaces;
use super::feature::Feature;
use super::gauss_map;
use super::types::{Answer, PairMemory, Proximity, Query, Start};
use super::verdict::Verdict;
use crate::gjk::{self, AxisTest, SeparatingAxis};
use crate::stats::Stage;
use crate::support::{CsoVertex, Polytope, Support, VertexId};
use crate::tuning::TILT;

/// Receives the answer of a query by reference, where it is found: copying an answer stalls on store
/// forwarding.
pub(crate) trait Sink {
    /// The memory of the pair. It is read only if the bounding spheres are within reach.
    fn memory(&mut self) -> PairMemory {
        PairMemory::None
    }

    /// The faces of contacts that hardly moved.
    fn flush_faces(&mut self) -> Option<FlushFaces> {
        None
    }

    /// The bounding spheres are too far apart. No axis was computed.
    fn spheres_apart(&mut self);

    /// The shapes are farther apart than the query's maximum distance.
    fn separated(&mut self, axis: &SeparatingAxis);

    /// The same, along the axis of the memory.
    #[inline]
    fn still_separated(&mut self, axis: &SeparatingAxis) {
        self.separated(axis);
    }

    /// The shapes are this near, or overlap.
    fn near(&mut self, proximity: &Proximity);
}

/// The answer of a search, and the stage that found it.
pub(crate) type Found = Option<(Answer, Stage)>;

/// How a query continues if neither the bounding spheres nor a remembered axis separate the shapes.
pub(crate) trait Strategy<A: Support, B: Support>: Copy {
    /// Re-evaluates features that were in contact. Shapes without faces have none.
    #[inline(always)]
    fn certify(
        self,
        query: &mut Query<'_, '_, A, B>,
        features: [Feature; 2],
        flush: impl FnMut() -> Option<FlushFaces>,
    ) -> Verdict {
        let _ = (query, features, flush);
        Verdict::Degenerate
    }

    /// Continues from features that are no longer the answer, by their `verdict`.
    fn start_from_features(
        self,
        query: &mut Query<'_, '_, A, B>,
        normal: DVec3,
        features: [Feature; 2],
        verdict: &Verdict,
        flush: Option<&FlushFaces>,
    ) -> Found {
        let _ = (features, verdict, flush);
        query.search_along(self, normal)
    }

    /// Continues from an axis that does not separate. Along it, `vertex` is too near.
    fn start_from_axis(
        self,
        query: &mut Query<'_, '_, A, B>,
        axis: DVec3,
        vertex: CsoVertex,
        start: Start,
    ) -> Found;
}

/// Runs every stage. There is no answer if the Minkowski difference has no volume or is not finite.
#[derive(Clone, Copy)]
pub(crate) struct Full;

impl<A: Polytope, B: Polytope> Strategy<A, B> for Full {
    #[inline(always)]
    fn certify(
        self,
        query: &mut Query<'_, '_, A, B>,
        features: [Feature; 2],
        flush: impl FnMut() -> Option<FlushFaces>,
    ) -> Verdict {
        query.certify(features, flush)
    }

    fn start_from_features(
        self,
        query: &mut Query<'_, '_, A, B>,
        normal: DVec3,
        features: [Feature; 2],
        verdict: &Verdict,
        flush: Option<&FlushFaces>,
    ) -> Found {
        query.start_walk_from_features(normal, features, verdict, flush)
    }

    /// Often the axis separates once it is tilted away from the place where the shapes come too near.
    /// Otherwise the facets around the vertex come next.
    fn start_from_axis(
        self,
        query: &mut Query<'_, '_, A, B>,
        axis: DVec3,
        vertex: CsoVertex,
        start: Start,
    ) -> Found {
        if query.skips_facet_walk() {
            return query.run_gjk(&[vertex], start);
        }
        let tilted = tilted(axis, &vertex);
        match query.test_axis(tilted, vertex.ids) {
            AxisTest::Separating(apart) => Some((Answer::Separated(apart), Stage::Axis)),
            AxisTest::Supporting(second) => {
                match gauss_map::facet_at_vertex(query.cso, &second, tilted) {
                    Some(features) => query.walk_from(tilted, features, start),
                    None => query.run_gjk(&[vertex, second], start),
                }
            }
        }
    }
}

/// Runs GJK after the axis. It stops when its bounds differ by less than this share of the pair's size. There
/// is no answer if the shapes overlap.
#[derive(Clone, Copy)]
pub(crate) struct Distance {
    pub gap: f64,
}

impl<A: Support, B: Support> Strategy<A, B> for Distance {
    fn start_from_axis(
        self,
        query: &mut Query<'_, '_, A, B>,
        _: DVec3,
        vertex: CsoVertex,
        start: Start,
    ) -> Found {
        query.measure(vertex, self.gap, start)
    }
}

/// The axis, tilted away from the place where the shapes come too near.
#[inline]
fn tilted(axis: DVec3, too_near: &CsoVertex) -> DVec3 {
    let sideways = too_near.w - axis * axis.dot(too_near.w);
    (axis - sideways.normalize_or_zero() * TILT).normalize()
}

impl<A: Support, B: Support> Query<'_, '_, A, B> {
    /// Hands the answer to `sink`, and returns the stage that found it. `None` if the strategy finds none.
    // perf: in calls the sink's answers would go through memory, which pairs that are apart notice.
    #[inline(always)]
    pub(crate) fn run_into(
        &mut self,
        strategy: impl Strategy<A, B>,
        sink: &mut impl Sink,
    ) -> Option<Stage> {
        // At least half of the separated pairs end here, before anything else is done for them.
        if self.cso.are_spheres_apart(self.max_distance) {
            sink.spheres_apart();
            return Some(Stage::BoundingSpheres);
        }
        let found = match sink.memory() {
            PairMemory::None => self.search_along(strategy, self.cso.towards_origin()),
            PairMemory::Axis(axis, ids) => match self.test_cached_axis(axis, ids) {
                AxisTest::Separating(apart) => {
                    sink.still_separated(&apart);
                    return Some(Stage::Axis);
                }
                AxisTest::Supporting(vertex) => {
                    strategy.start_from_axis(self, axis, vertex, Start::Warm)
                }
            },
            PairMemory::Contact(normal, features) => {
                let verdict = strategy.certify(self, features, || sink.flush_faces());
                if let Verdict::Certified(near) = &verdict {
                    sink.near(near);
                    return Some(Stage::Feature);
                }
                let flush = sink.flush_faces();
                strategy.start_from_features(self, normal, features, &verdict, flush.as_ref())
            }
        };
        let (answer, stage) = found.as_ref()?;
        match answer {
            Answer::Separated(apart) => sink.separated(apart),
            Answer::Near(near) => sink.near(near),
        }
        Some(*stage)
    }

    /// Starts without memory, along an axis, usually the line of centres.
    fn search_along(&mut self, strategy: impl Strategy<A, B>, axis: DVec3) -> Found {
        match self.test_axis(axis, self.cso.start_vertices(axis)) {
            AxisTest::Separating(apart) => Some((Answer::Separated(apart), Stage::Axis)),
            AxisTest::Supporting(vertex) => {
                strategy.start_from_axis(self, axis, vertex, Start::Cold)
            }
        }
    }

    /// Whether an axis separates. The `ids` are only remembered, and may be of other shapes.
    #[inline(always)]
    fn test_axis(&mut self, axis: DVec3, ids: [VertexId; 2]) -> AxisTest {
        let start = self.cso.clamp_vertices(ids);
        gjk::test_axis(self.cso, axis, start, self.max_distance, self.cost)
    }

    /// The same for an axis that separated the shapes before.
    #[inline]
    fn test_cached_axis(&mut self, axis: DVec3, ids: [VertexId; 2]) -> AxisTest {
        let start = self.cso.clamp_vertices(ids);
        gjk::test_cached_axis(self.cso, axis, start, self.max_distance, self.cost)
    }
}

impl<A: Polytope, B: Polytope> Query<'_, '_, A, B> {
    /// Answers from `memory` if possible, and otherwise cold. `None` only if the Minkowski difference has no
    /// volume or is not finite.
    pub fn run(&mut self, memory: &PairMemory) -> Option<(Answer, Stage)> {
        let mut sink = Collect {
            memory,
            answer: None,
        };
        let stage = self.run_into(Full, &mut sink)?;
        let answer = sink
            .answer
            .unwrap_or_else(|| Answer::Separated(self.line_of_centers(memory)));
        Some((answer, stage))
    }

    /// The axis of shapes whose bounding spheres are apart. Remembered vertices are kept.
    fn line_of_centers(&self, memory: &PairMemory) -> SeparatingAxis {
        let axis = self.cso.towards_origin();
        SeparatingAxis {
            axis,
            separation: self.cso.center().length() - self.cso.size(),
            ids: match *memory {
                PairMemory::Axis(_, ids) => ids,
                _ => self.cso.start_vertices(axis),
            },
        }
    }
}

/// Keeps the answer, unless the bounding spheres are apart.
struct Collect<'a> {
    memory: &'a PairMemory,
    answer: Option<Answer>,
}

impl Sink for Collect<'_> {
    fn memory(&mut self) -> PairMemory {
        *self.memory
    }

    fn spheres_apart(&mut self) {}

    fn separated(&mut self, axis: &SeparatingAxis) {
        self.answer = Some(Answer::Separated(*axis));
    }

    fn near(&mut self, proximity: &Proximity) {
        self.answer = Some(Answer::Near(*proximity));
    }
}
