//! Epochs: spans of time in which no shape changes, so that a proof about a shape holds to the end.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// While an epoch lasts, no shape that it covers changes. Its number is unique in its thread: odd for steps,
/// even for pairs. The default, 0, is no epoch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Epoch(u64);

impl Epoch {
    /// The epoch of the update of one pair, which borrows its shapes.
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

/// The current step, if the user promised that its shapes do not change. Clones share it.
#[derive(Clone, Debug, Default)]
pub(crate) struct EpochSource(Arc<AtomicU64>);

impl EpochSource {
    /// Runs `work` as an epoch. Any epoch that begins ends the others, including this one. So a clone in
    /// another thread may cost proofs, but no proof outlives its epoch.
    pub fn run<R>(&self, work: impl FnOnce() -> R) -> R {
        /// Ends the epoch, even if `work` panics.
        struct End<'a>(&'a AtomicU64);
        impl Drop for End<'_> {
            fn drop(&mut self) {
                self.0.store(0, Ordering::Relaxed);
            }
        }
        static LAST: AtomicU64 = AtomicU64::new(0);
        // Whatever shares the work with other threads also makes this visible to them.
        let epoch = LAST.fetch_add(2, Ordering::Relaxed) + 1;
        self.0.store(epoch, Ordering::Relaxed);
        let _end = End(&self.0);
        work()
    }

    /// The epoch of the step, or else a new one for a pair.
    #[inline]
    pub fn epoch(&self) -> Epoch {
        match self.0.load(Ordering::Relaxed) {
            0 => Epoch::of_pair(),
            step => Epoch(step),
        }
    }
}
