//! The cached polytopes of many pairs.

use super::cached_polytope::CachedPolytope;
use super::clearance::KnownDepth;
use super::polytope::EpaScratch;
use crate::slots::Slots;
use crate::stats::Cost;
use crate::support::{Cso, Polytope, Support};

/// The cache holds 2,048 pairs if no two share a slot.
const SLOT_BITS: u32 = 11;

/// A new entry, or one that has just proved a depth, survives this many attempts to replace it. With more pairs
/// than slots, some pairs keep their proofs, and the others lose little.
const PROTECTED_MISSES: u8 = 16;

/// Polytopes that were expanded for pairs in earlier frames. They prove that depths are the least. A pair's key may
/// be any number that stays the same from frame to frame.
///
/// A lost entry only costs time. A key that now stands for another pair does no harm.
#[derive(Clone, Debug, Default)]
pub struct PolytopeCache(Slots<CacheSlot, SLOT_BITS>);

#[derive(Clone, Debug, Default)]
struct CacheSlot {
    key: u64,
    /// How many more attempts to replace this entry are refused.
    protected_misses: u8,
    polytope: Option<Box<CachedPolytope>>,
}

impl PolytopeCache {
    /// Whether the cached polytope of this pair, after a few expansions if necessary, proves that
    /// [`penetration_below`](super::penetration_below) would find no smaller depth.
    pub fn proves_depth<A: Polytope, B: Polytope>(
        &mut self,
        key: u64,
        cso: &Cso<'_, A, B>,
        known: &KnownDepth,
        scratch: &mut EpaScratch,
        cost: &mut Cost,
    ) -> bool {
        let Some(slot) = self.0.get_mut(key).filter(|slot| slot.key == key) else {
            return false;
        };
        let Some(polytope) = &mut slot.polytope else {
            return false;
        };
        let proved = polytope.proves_depth(cso, known, scratch, cost);
        slot.protected_misses = if proved { PROTECTED_MISSES } else { 0 };
        proved
    }

    /// Keeps the polytope of the last expansion for this pair.
    pub fn store<A: Support, B: Support>(
        &mut self,
        key: u64,
        cso: &Cso<'_, A, B>,
        scratch: &EpaScratch,
    ) {
        let slot = self.0.get_or_allocate(key);
        if slot.key != key {
            if slot.protected_misses > 0 {
                slot.protected_misses -= 1;
                return;
            }
            (slot.key, slot.protected_misses) = (key, PROTECTED_MISSES);
        }
        slot.polytope.get_or_insert_default().store(cso, scratch);
    }
}
