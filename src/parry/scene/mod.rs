//! Queries without memory.

pub(crate) mod cast;
pub(crate) mod separation;
