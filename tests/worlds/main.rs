//! What happens in rapier's worlds.

mod character;
mod curved;
mod determinism;
mod fast_hull;
mod hull_shape_world;
mod inner_edges;
mod large_grounds;
mod left;
mod logs;
mod mid_run;
mod one_way;
mod prepared_shapes;
mod resting;
mod rolling;
mod scenes;
#[cfg(feature = "serde-serialize")]
mod snapshots;
mod soak;
mod unchanged_shapes;
