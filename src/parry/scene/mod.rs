//! Queries without memory.

pub(crate) mod cast;
mod dispatch;
pub(crate) mod separation;
