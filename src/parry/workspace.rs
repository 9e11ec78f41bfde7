//! What a thread keeps from query to query.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::curved::CurvedScratch;
use crate::epa::{EpaScratch, PolytopeCache};
use crate::manifold::ClipScratch;
use crate::parry::apart_cache::ApartCache;
use crate::parry::hull_cache::HullCache;
use crate::parry::seams_cache::SeamsCache;
use crate::parry::still_cache::StillCache;

/// What a thread keeps from query to query: prepared hulls, seams of compounds, and memory to work in.
#[derive(Default)]
pub(crate) struct ThreadWorkspace {
    pub hulls: HullCache,
    pub seams: SeamsCache,
    pub workspace: Workspace,
    /// The number of trim requests when it was made.
    trims: u64,
}

/// The number of trim requests to all threads.
static TRIMS: AtomicU64 = AtomicU64::new(0);

thread_local! {
    static WORKSPACE: Cell<Option<Box<ThreadWorkspace>>> = const { Cell::new(None) };
}

/// Drops the workspaces of all threads: of this one now, of others before their next query.
pub(crate) fn trim() {
    TRIMS.fetch_add(1, Ordering::Relaxed);
    ThreadWorkspace::with(|_| ());
}

impl ThreadWorkspace {
    /// Takes out this thread's workspace, runs `work` on it, and puts it back. A query within a query (from a
    /// user's `NormalConstraints`), or one made while the thread ends, gets a new workspace.
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
    pub curved: CurvedScratch,
    pub epa: EpaScratch,
    pub clip: ClipScratch,
    pub polytope_cache: PolytopeCache,
    pub apart_cache: ApartCache,
    pub still_cache: StillCache,
}
