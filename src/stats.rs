//! Counters of which stages answered, and at what cost. They show whether coherence pays.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, AtomicUsize, Ordering};

/// The stage of a query that gave a pair its answer, cheapest first (`docs/stages.md` in the repository).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
#[non_exhaustive]
pub enum Stage {
    /// The bounding spheres are apart, or the bounding sphere of a hull is above a half-space.
    BoundingSpheres,
    /// One or two support pairs proved separation, along the axis of the previous frame (for a new pair, the
    /// line of centres) or along a tilted one. If the pair hardly moved since, it is proved without any.
    Axis,
    /// The pair hardly moved since its distance or depth was certified, and the contacts kept their places.
    Still,
    /// The features of the previous frame, re-evaluated, certified the distance or depth, and the contacts
    /// kept their places.
    Kept,
    /// The features of the previous frame, re-evaluated, certified separation, distance or depth; or a
    /// hull's lowest vertex over a half-space, with or without a previous frame, gave them.
    Feature,
    /// Other features certified it. They were found by walking from facet to facet, from the previous
    /// features or axis.
    FacetWalk,
    /// Features and the polytope of a previous frame, re-evaluated, certified a depth.
    CachedPolytope,
    /// GJK started from the previous frame's axis and vertices.
    WarmGjk,
    /// EPA found a depth from the previous frame's features.
    WarmEpa,
    /// GJK without a previous frame, after the stages above.
    ColdGjk,
    /// EPA without a previous frame, after the stages above.
    ColdEpa,
}

impl Stage {
    /// The number of stages.
    pub const COUNT: usize = 11;
    /// All stages, in the order of [`Stats::answered`].
    pub const ALL: [Self; Self::COUNT] = [
        Self::BoundingSpheres,
        Self::Axis,
        Self::Still,
        Self::Kept,
        Self::Feature,
        Self::FacetWalk,
        Self::CachedPolytope,
        Self::WarmGjk,
        Self::WarmEpa,
        Self::ColdGjk,
        Self::ColdEpa,
    ];

    /// A short name for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BoundingSpheres => "spheres",
            Self::Axis => "axis",
            Self::Still => "still",
            Self::Kept => "kept",
            Self::Feature => "feature",
            Self::FacetWalk => "facet walk",
            Self::CachedPolytope => "cached polytope",
            Self::WarmGjk => "warm GJK",
            Self::WarmEpa => "warm EPA",
            Self::ColdGjk => "cold GJK",
            Self::ColdEpa => "cold EPA",
        }
    }
}

/// Why the contacts of a pair were left to the fallback dispatcher: an index into [`Stats::left_to_fallback`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
#[non_exhaustive]
pub enum Left {
    /// A plain hull that cannot be prepared: parry's builder made it flat or not convex, it has fewer than
    /// four points or too many, or a coordinate is not finite. [`HullShape`](crate::HullShape) reports the
    /// reason.
    HullNotPrepared,
    /// The other shape is not supported, or is degenerate.
    OtherShape,
    /// The relative pose is not finite.
    NotFinite,
    /// Other sharp polytopes or balls, or a capsule with a ball or half-space: parry's contacts are as good.
    NoHull,
}

impl Left {
    /// The number of reasons.
    pub const COUNT: usize = 4;
    /// All reasons, in the order of [`Stats::left_to_fallback`].
    pub const ALL: [Self; Self::COUNT] = [
        Self::HullNotPrepared,
        Self::OtherShape,
        Self::NotFinite,
        Self::NoHull,
    ];

    /// A short name for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HullNotPrepared => "hull not prepared",
            Self::OtherShape => "other shape",
            Self::NotFinite => "pose not finite",
            Self::NoHull => "no hull",
        }
    }

    /// What the log says when it happens first, where something is wrong with the world.
    const fn warning(self) -> Option<&'static str> {
        match self {
            Self::HullNotPrepared => Some(
                "a plain hull is flat, not convex, too large or not finite: its contacts are left to the \
                 fallback, and may be missing. `HullShape` names the reason",
            ),
            Self::NotFinite => Some("the pose of a pair with a hull is not finite"),
            Self::OtherShape | Self::NoHull => None,
        }
    }
}

/// What the contact updates of a dispatcher and its clones have cost so far. Scene queries are not counted, nor pairs
/// whose contacts rapier recycles.
///
/// ```
/// use isa_gjk::{IsaGjkDispatcher, Stage};
///
/// let stats = IsaGjkDispatcher::default().stats();
/// for (stage, count) in Stage::ALL.iter().zip(stats.answered) {
///     println!("{}: {count} of {}", stage.name(), stats.queries());
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Stats {
    /// Queries answered by each stage, indexed like [`Stage::ALL`].
    pub answered: [u64; Stage::COUNT],
    /// Contact updates that were left to the fallback, indexed like [`Left::ALL`].
    pub left_to_fallback: [u64; Left::COUNT],
    /// GJK iterations and EPA expansions.
    pub iterations: u64,
    /// Support queries, each on one shape.
    pub supports: u64,
    /// Moves of hill climbing from a vertex to a better neighbour.
    pub climb_moves: u64,
    /// Queries that were ended by a safeguard (stall, iteration limit, degenerate input) and returned their
    /// best certified answer.
    pub fallbacks: u64,
}

impl Stats {
    /// Queries answered by any stage.
    pub fn queries(&self) -> u64 {
        self.answered.iter().sum()
    }

    /// The counts since an `earlier` reading.
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            answered: differences(self.answered, earlier.answered),
            left_to_fallback: differences(self.left_to_fallback, earlier.left_to_fallback),
            iterations: self.iterations.saturating_sub(earlier.iterations),
            supports: self.supports.saturating_sub(earlier.supports),
            climb_moves: self.climb_moves.saturating_sub(earlier.climb_moves),
            fallbacks: self.fallbacks.saturating_sub(earlier.fallbacks),
        }
    }
}

fn differences<const N: usize>(now: [u64; N], before: [u64; N]) -> [u64; N] {
    std::array::from_fn(|i| now[i].saturating_sub(before[i]))
}

/// The cost of one query, added up while it runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// GJK iterations and EPA expansions.
    pub iterations: u32,
    /// Support queries, each on one shape.
    pub supports: u32,
    /// Moves of hill climbing.
    pub climb_moves: u32,
    /// Safeguards that fired.
    pub fallbacks: u32,
}

/// One thread's counters, on separate cache lines.
#[derive(Default)]
#[repr(align(128))]
struct Shard {
    answered: [AtomicU64; Stage::COUNT],
    left: [AtomicU64; Left::COUNT],
    /// Bits of those reasons that the log knows; in the first shard, for all.
    warned: AtomicU8,
    iterations: AtomicU64,
    supports: AtomicU64,
    climb_moves: AtomicU64,
    fallbacks: AtomicU64,
}

/// More shards than threads that step one world. Threads of all pools of the process take them in turn as
/// they start. Two threads that share a shard may lose counts, but nothing else.
const SHARDS: usize = 64;

/// Counters that many threads add to without waiting for each other.
#[derive(Clone)]
pub(crate) struct SharedStats(Arc<[Shard]>);

impl Default for SharedStats {
    fn default() -> Self {
        Self((0..SHARDS).map(|_| Shard::default()).collect())
    }
}

impl fmt::Debug for SharedStats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.read().fmt(f)
    }
}

thread_local! {
    static SHARD: usize = {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        NEXT.fetch_add(1, Ordering::Relaxed) % SHARDS
    };
}

impl SharedStats {
    /// The counters of this thread.
    #[inline]
    fn shard(&self) -> &Shard {
        &self.0[SHARD.with(|s| *s)]
    }

    /// Adds one answered query.
    #[inline]
    pub fn record(&self, stage: Stage, cost: &Cost) {
        let shard = self.shard();
        add(&shard.answered[stage as usize], 1);
        add(&shard.iterations, cost.iterations);
        add(&shard.supports, cost.supports);
        add(&shard.climb_moves, cost.climb_moves);
        add(&shard.fallbacks, cost.fallbacks);
    }

    /// Adds one answer that cost no query.
    #[inline]
    pub fn record_free(&self, stage: Stage) {
        add(&self.shard().answered[stage as usize], 1);
    }

    /// Adds one pair that the fallback gets. What is wrong with the world goes to the log, once.
    #[inline]
    pub fn record_left(&self, why: Left) {
        add(&self.shard().left[why as usize], 1);
        if let Some(warning) = why.warning() {
            self.warn_once(why, warning);
        }
    }

    #[cold]
    fn warn_once(&self, why: Left, warning: &str) {
        let bit = 1 << why as u8;
        if self.0[0].warned.fetch_or(bit, Ordering::Relaxed) & bit == 0 {
            log::warn!("{warning}");
        }
    }

    /// The sum over all threads.
    pub fn read(&self) -> Stats {
        let mut sum = Stats::default();
        for shard in self.0.iter() {
            for (total, count) in sum.answered.iter_mut().zip(&shard.answered) {
                *total += count.load(Ordering::Relaxed);
            }
            for (total, count) in sum.left_to_fallback.iter_mut().zip(&shard.left) {
                *total += count.load(Ordering::Relaxed);
            }
            sum.iterations += shard.iterations.load(Ordering::Relaxed);
            sum.supports += shard.supports.load(Ordering::Relaxed);
            sum.climb_moves += shard.climb_moves.load(Ordering::Relaxed);
            sum.fallbacks += shard.fallbacks.load(Ordering::Relaxed);
        }
        sum
    }
}

/// A plain load and store: a locked addition costs more than a climb, and a shard has one writer.
#[inline]
fn add(counter: &AtomicU64, count: u32) {
    counter.store(
        counter.load(Ordering::Relaxed) + u64::from(count),
        Ordering::Relaxed,
    );
}
