//! How long prepared hulls stay that nobody asks for.
//!
//! Age is measured in bytes: those prepared since a hull was used last. Where hulls come and go
//! quickly, those of yesterday go quickly; where nothing comes, time passes as if a little came.
//! Hulls that were dropped too early are noticed when they are prepared again: then all may grow older.

use std::time::{Duration, Instant};

use crate::parry::int_hash::IntMap;

/// Bytes that are kept whether or not they are in use; and the least age at which those beyond go.
pub(crate) const KEEP_BYTES: u64 = 32 << 20;

/// In this time all grows older by `KEEP_BYTES`.
const KEEP_TIME: Duration = Duration::from_secs(60);

/// What was dropped is remembered for this many lifetimes; when as many have passed without
/// a regret, they become shorter.
const MEMORY: u64 = 4;

#[derive(Debug)]
pub(crate) struct Aging {
    now: u64,
    /// Hulls that are older go.
    lifetime: u64,
    /// When each was used last that is gone.
    gone: IntMap<u64, u64>,
    /// When the last one came back, or the lifetime became shorter.
    changed: u64,
    /// Up to when time has been counted.
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

/// `None` where there is no clock, as in browsers: ages are of bytes alone there.
fn clock() -> Option<Instant> {
    let has_clock = !cfg!(all(target_family = "wasm", target_os = "unknown"));
    has_clock.then(Instant::now)
}

impl Aging {
    #[inline(always)]
    pub fn now(&self) -> u64 {
        self.now
    }

    /// A hull was prepared, which is known again by a key.
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

    /// Before hulls are dropped. Whether one is too old that was used at a time.
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

    /// A hull is dropped.
    pub fn dropped(&mut self, key: u64, used: u64) {
        self.gone.insert(key, used);
    }
}
