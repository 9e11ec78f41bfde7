//! What a thread keeps from query to query.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::epa::{EpaScratch, PolytopeCache};
use crate::manifold::ClipScratch;
use crate::parry::composite::seams::SeamsCache;
use crate::parry::hull_cache::HullCache;
use crate::parry::hull_cache::registry::PreparedHull;

/// What a thread keeps from query to query: prepared hulls, seams of compounds, and memory to work in.
#[derive(Default)]
pub(crate) struct ThreadWorkspace {
    pub hulls: HullCache,
    pub seams: SeamsCache,
    pub workspace: Workspace,
    /// How often all had been asked to trim when it was made.
    trims: u64,
}

/// How often all threads were asked to trim.
static TRIMS: AtomicU64 = AtomicU64::new(0);

thread_local! {
    static WORKSPACE: Cell<Option<Box<ThreadWorkspace>>> = const { Cell::new(None) };
}

/// Drops what threads keep: this one now, others before their next query.
pub(crate) fn trim() {
    TRIMS.fetch_add(1, Ordering::Relaxed);
    ThreadWorkspace::with(|_| ());
    PreparedHull::forget_unused();
}

impl ThreadWorkspace {
    /// Works on that of this thread, which is out of its place meanwhile: whoever asks within a query (a
    /// user's `NormalConstraints`), or while the thread ends, works on a new one.
    // perf: in a call the work would go through memory, which pairs that are apart notice.
    #[inline(always)]
    pub fn with<T>(work: impl FnOnce(&mut Self) -> T) -> T {
        let trims = TRIMS.load(Ordering::Relaxed);
        let kept = WORKSPACE.try_with(Cell::take).ok().flatten();
        let mut thread = match kept {
            Some(thread) if thread.trims == trims => thread,
            _ => Self::new(trims),
        };
        let answer = work(&mut thread);
        let _ = WORKSPACE.try_with(|location| location.set(Some(thread)));
        answer
    }

    #[cold]
    #[inline(never)]
    fn new(trims: u64) -> Box<Self> {
        Box::new(Self {
            trims,
            ..Self::default()
        })
    }
}

/// Memory to work in.
#[derive(Default)]
pub(crate) struct Workspace {
    pub epa: EpaScratch,
    pub clip: ClipScratch,
    pub polytope_cache: PolytopeCache,
}
