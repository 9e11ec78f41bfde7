//! Queries without memory.

mod bounds;
mod caller;
pub(crate) mod cast;
mod contact;
mod dispatch;
mod patch;
pub(crate) mod separation;
mod why;
