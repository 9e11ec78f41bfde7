//! Spans of time in which no shape changes: what was proved of a shape holds to their end.

use std::num::NonZeroU64;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// An epoch, by a number that no other one has.
pub(crate) type Epoch = NonZeroU64;

/// The epoch that is under way, if there is one; clones share it.
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
        let epoch = LAST.fetch_add(1, Ordering::Relaxed) + 1;
        self.0.store(epoch, Ordering::Relaxed);
        let _end = End(&self.0);
        work()
    }

    #[inline]
    pub fn epoch(&self) -> Option<Epoch> {
        Epoch::new(self.0.load(Ordering::Relaxed))
    }
}
