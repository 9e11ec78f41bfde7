//! Queries without memory.

mod caller;
pub(crate) mod cast;
mod contact;
mod dispatch;
pub(crate) mod separation;
