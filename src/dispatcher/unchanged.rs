//! Spans of time in which no shape changes: what was proved of a shape holds to their end.

use std::num::NonZeroU64;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A span, by a number that no other one has.
pub(super) type Span = NonZeroU64;

/// The span that is under way, if there is one; clones share it.
#[derive(Clone, Debug, Default)]
pub(super) struct Unchanged(Arc<AtomicU64>);

impl Unchanged {
    /// Runs `work` as a span. A span ends all others: those that were under way, and this one if
    /// another begins. So a clone in another thread costs proofs, and no proof outlives its span.
    pub fn run<R>(&self, work: impl FnOnce() -> R) -> R {
        /// Ends the span also where `work` panics.
        struct End<'a>(&'a AtomicU64);
        impl Drop for End<'_> {
            fn drop(&mut self) {
                self.0.store(0, Ordering::Relaxed);
            }
        }
        static LAST: AtomicU64 = AtomicU64::new(0);
        // Whatever shares the work with other threads also makes them see this.
        let span = LAST.fetch_add(1, Ordering::Relaxed) + 1;
        self.0.store(span, Ordering::Relaxed);
        let _end = End(&self.0);
        work()
    }

    #[inline]
    pub fn span(&self) -> Option<Span> {
        Span::new(self.0.load(Ordering::Relaxed))
    }
}
