//! Queries without memory.

pub(crate) mod cast;
mod contact;
mod dispatch;
pub(crate) mod separation;
