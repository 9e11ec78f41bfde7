//! How long random tests run.

use std::time::{Duration, Instant};

fn number(name: &str) -> Option<u64> {
    let value = std::env::var(name).ok()?;
    Some(value.parse().expect("a number"))
}

/// The seed of random tests: `FUZZ_SEED`, or always the same.
pub fn seed() -> u64 {
    number("FUZZ_SEED").unwrap_or(1)
}

/// The turns of a random test: so many as `FUZZ_RUNS` says, or as fit into `FUZZ_SECONDS`; else as many
/// as `usual`.
pub fn turns(usual: u64) -> impl Iterator<Item = u64> {
    let time = number("FUZZ_SECONDS").map(Duration::from_secs);
    let start = Instant::now();
    let most = match time {
        Some(_) => u64::MAX,
        None => number("FUZZ_RUNS").unwrap_or(usual),
    };
    (0..most).take_while(move |_| time.is_none_or(|time| start.elapsed() < time))
}
