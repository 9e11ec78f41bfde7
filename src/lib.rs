//! A coherent convex-hull narrow phase for rapier.
#![forbid(unsafe_code)]

pub mod dispatcher;
pub mod epa;
pub mod gjk;
pub mod hull;
pub mod hull_shape;
pub mod manifold;
pub mod pose;
pub mod primitive;
pub mod query;
pub mod ray_cast;
pub mod simplex;
pub mod stats;
pub mod support;
pub mod tolerance;

pub use dispatcher::IsaGjkDispatcher;
pub use hull::{Hull, HullError};
pub use hull_shape::HullShape;
pub use stats::{Stage, Stats};
