//! How long unused prepared hulls are kept.
//!
//! Age is measured in bytes: those prepared since a hull was last used. If hulls come and go quickly, unused
//! ones are dropped quickly; if no hull comes, time passes as if a little were prepared. If a dropped hull is
//! prepared again, it was dropped too early, and all hulls may grow older.

use std::time::{Duration, Instant};

use crate::parry::int_hash::IntMap;

/// How many bytes are kept even if unused, and the lowest age at which hulls beyond these are dropped.
pub(crate) const KEEP_BYTES: u64 = 32 << 20;

/// The time in which every hull ages by `KEEP_BYTES`.
const KEEP_TIME: Duration = Duration::from_secs(60);

/// Dropped hulls are remembered for this many lifetimes. If as many pass and none was dropped too early,
/// lifetimes become shorter.
const MEMORY: u64 = 4;

#[derive(Debug)]
pub(crate) struct Aging {
    now: u64,
    /// Older hulls are dropped.
    lifetime: u64,
    /// When each dropped hull was last used.
    gone: IntMap<u64, u64>,
    /// When a dropped hull last came back, or the lifetime last became shorter.
    changed: u64,
    /// Time has been counted up to here.
    counted: Option<Instant>,
}

impl Default for Aging {
    fn default() -> Self {
        Self {
            now: 0,
            lifetime: KEEP_BYTES,
            gone: IntMap::default(),
            changed: 0,
            counted: clock(),
        }
    }
}

/// `None` if there is no clock, as in browsers: there, only bytes count.
fn clock() -> Option<Instant> {
    let has_clock = !cfg!(all(target_family = "wasm", target_os = "unknown"));
    has_clock.then(Instant::now)
}

impl Aging {
    #[inline(always)]
    pub fn now(&self) -> u64 {
        self.now
    }

    /// Notes that the hull with this key was prepared.
    pub fn prepared(&mut self, key: u64, bytes: usize) {
        self.now += bytes as u64;
        if let Some(used) = self.gone.remove(&key) {
            self.lifetime = self.lifetime.max(2 * (self.now - used));
            self.changed = self.now;
        }
    }

    /// Counts the time that has passed.
    pub fn pass(&mut self) {
        let Some(counted) = &mut self.counted else {
            return;
        };
        let passed = counted.elapsed();
        *counted += passed;
        let share = passed.as_secs_f64() / KEEP_TIME.as_secs_f64();
        self.now += (share * KEEP_BYTES as f64) as u64;
    }

    /// Prepares to drop hulls. The result says whether a hull that was last used at some time is too old.
    pub fn limit(&mut self) -> impl Fn(u64) -> bool + use<> {
        if self.now - self.changed > MEMORY * self.lifetime {
            self.lifetime = KEEP_BYTES.max(self.lifetime / 2);
            self.changed = self.now;
        }
        let (now, memory) = (self.now, MEMORY * self.lifetime);
        self.gone.retain(|_, used| now - *used < memory);
        let oldest = now.saturating_sub(self.lifetime);
        move |used| used < oldest
    }

    /// Notes that a hull is dropped.
    pub fn dropped(&mut self, key: u64, used: u64) {
        self.gone.insert(key, used);
    }
}
