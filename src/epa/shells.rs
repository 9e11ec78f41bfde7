//! The shells of many pairs.

use super::EpaScratch;
use super::shell::Shell;
use crate::stats::Cost;
use crate::support::{Cso, Polytope, Support};

/// Room for the shells of so many pairs, if each has a place of its own.
const PLACES: usize = 1 << PLACE_BITS;
const PLACE_BITS: u32 = 11;

/// A new entry, or one that has just proved a depth, survives this many attempts to replace it. Where
/// there are more pairs than places, some prove and the others lose little.
const PATIENCE: u8 = 16;

/// What was expanded for pairs in earlier frames, for proofs that their depths are the least. A pair
/// is found by a key, any number that stays the same from frame to frame.
///
/// Nothing depends on what is kept and what was lost but how long an answer takes; a key that means
/// another pair by now is no danger.
#[derive(Clone, Debug)]
pub struct Shells(Box<[Place]>);

#[derive(Clone, Debug, Default)]
struct Place {
    key: u64,
    /// So many wishes of other pairs for the place are refused.
    patience: u8,
    shell: Option<Box<Shell>>,
}

impl Default for Shells {
    fn default() -> Self {
        Self(vec![Place::default(); PLACES].into())
    }
}

impl Shells {
    /// Whether [`penetration_below`](super::penetration_below) would say that the depth is known, as
    /// far as the shell of this pair can tell, or what it grows to in a few expansions.
    pub fn prove<A: Polytope, B: Polytope>(
        &mut self,
        key: u64,
        cso: &Cso<'_, A, B>,
        known_depth: f64,
        scratch: &mut EpaScratch,
        cost: &mut Cost,
    ) -> bool {
        let place = self.place(key);
        match &mut place.shell {
            Some(shell) if place.key == key => {
                let proved = shell.prove(cso, known_depth, scratch, cost);
                place.patience = if proved { PATIENCE } else { 0 };
                proved
            }
            _ => false,
        }
    }

    /// Keeps the polytope of the last expansion as the shell of this pair.
    pub fn keep<A: Support, B: Support>(
        &mut self,
        key: u64,
        cso: &Cso<'_, A, B>,
        scratch: &EpaScratch,
    ) {
        let place = self.place(key);
        if place.key != key {
            if place.patience > 0 {
                place.patience -= 1;
                return;
            }
            (place.key, place.patience) = (key, PATIENCE);
        }
        place.shell.get_or_insert_default().keep(cso, scratch);
    }

    fn place(&mut self, key: u64) -> &mut Place {
        // Fibonacci hashing: the highest bits depend on all bits of the key.
        let hash = key.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        &mut self.0[(hash >> (u64::BITS - PLACE_BITS)) as usize]
    }
}
