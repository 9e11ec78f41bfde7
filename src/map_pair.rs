//! Maps over pairs, such as the two shapes of a query or the two ends of an edge.

/// Maps both elements. `array::map` does the same, but without link-time optimisation it calls the closure
/// for each element, and vectors go through memory.
// perf: a tenth of a manifold's update.
#[inline(always)]
pub(crate) fn map_pair<T, U>([a, b]: [T; 2], mut f: impl FnMut(T) -> U) -> [U; 2] {
    [f(a), f(b)]
}
