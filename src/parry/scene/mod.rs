//! Queries without memory.

mod bounds;
mod caller;
mod capsules;
pub(crate) mod cast;
mod contact;
mod convex;
mod dispatch;
mod motion;
mod nonlinear;
mod patch;
pub(crate) mod separation;
mod why;
