//! Curved convex shapes in f64: what answers about any two of ball, capsule, cylinder, cone, half-space,
//! cuboid, triangle and hull, rounded or not, are measured against. No code of the crate is used.

mod body;
mod cell;
mod judge;
mod meeting;
mod separation;
mod surface;

pub use body::{Body, Core};
pub use judge::{Faults, Judge};
pub use meeting::{Meeting, tilted};
pub use separation::{Difference, SignedDistance};
