//! Spans of time in which no shape changes: what was proved of a shape holds to their end.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// While it lasts, no shape that it covers changes. Its number is one that no other has in its thread:
/// odd for steps, even for pairs. The default, 0, is that of no work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Epoch(u64);

impl Epoch {
    /// The update of one pair, for which its shapes are borrowed.
    #[inline]
    pub fn of_pair() -> Self {
        thread_local! {
            static PAIRS: Cell<u64> = const { Cell::new(0) };
        }
        let number = PAIRS.get() + 2;
        PAIRS.set(number);
        Self(number)
    }
}

/// The step that is under way, if a user promised one without change; clones share it.
#[derive(Clone, Debug, Default)]
pub(crate) struct EpochSource(Arc<AtomicU64>);

impl EpochSource {
    /// Runs `work` as an epoch. An epoch ends all others: those that were under way, and this one if
    /// another begins. So a clone in another thread costs proofs, and no proof outlives its epoch.
    pub fn run<R>(&self, work: impl FnOnce() -> R) -> R {
        /// Ends the epoch also where `work` panics.
        struct End<'a>(&'a AtomicU64);
        impl Drop for End<'_> {
            fn drop(&mut self) {
                self.0.store(0, Ordering::Relaxed);
            }
        }
        static LAST: AtomicU64 = AtomicU64::new(0);
        // Whatever shares the work with other threads also makes them see this.
        let epoch = LAST.fetch_add(2, Ordering::Relaxed) + 1;
        self.0.store(epoch, Ordering::Relaxed);
        let _end = End(&self.0);
        work()
    }

    /// That of the step, or else one of a pair.
    #[inline]
    pub fn epoch(&self) -> Epoch {
        match self.0.load(Ordering::Relaxed) {
            0 => Epoch::of_pair(),
            step => Epoch(step),
        }
    }
}
