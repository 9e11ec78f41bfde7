//! A pair of hulls on a coherent trajectory, as the benches of pairs measure it.

mod hull;
mod resting;
mod trajectory;
mod update;

pub use hull::hull;
pub use resting::{REST, SHAKEN, resting, trembling};
pub use trajectory::{FRAMES, GAPS, PREDICTION, VERTICES, trajectory};
pub use update::{Manifolds, update};
