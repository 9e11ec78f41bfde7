//! A user's own convex shapes, by the traits of parry that they implement: `SupportMap`, and `PolygonalFeatureMap` if
//! they have faces or edges.

mod face;
mod feature;
mod pieces;
mod shape;

pub(crate) use shape::{CustomShape, has_support_map, is_custom};
