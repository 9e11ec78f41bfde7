//! A coherent convex-hull narrow phase for rapier.
#![forbid(unsafe_code)]

pub mod dispatcher;
pub mod simplex;
pub mod stats;

pub use dispatcher::IsaGjkDispatcher;
pub use stats::{Stage, Stats};
