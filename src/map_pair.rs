//! What belongs to the two shapes of a pair, or to the two ends of an edge.

/// Both mapped. `array::map` does the same, but without link-time optimisation it is a call for each
/// element, and vectors go through memory.
// perf: a tenth of a manifold's update.
#[inline(always)]
pub(crate) fn map_pair<T, U>([a, b]: [T; 2], mut f: impl FnMut(T) -> U) -> [U; 2] {
    [f(a), f(b)]
}
