//! Whether features still prove an answer at the present poses.

pub(super) mod boxes;
pub(super) mod facet;
pub(super) mod flush;
pub(super) mod neighbors;
mod polygon;
pub(super) mod vertex_edge;

pub(crate) use polygon::{cone_contains_ball, inset};
