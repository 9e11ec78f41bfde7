//! The interface to rapier and parry: which shapes are ours, their manifolds, and scene queries.

mod apart_cache;
mod balls;
mod capsules;
mod composite;
mod constraints;
mod convert;
mod core;
mod curved;
mod custom;
pub(crate) mod dispatcher;
mod half_space;
mod hull_cache;
pub(crate) mod hull_shape;
mod int_hash;
mod leaning_normals;
mod manifold;
mod operand;
mod order;
mod pair;
mod part_seams;
pub mod recording;
mod scene;
mod seams_cache;
mod still_cache;
mod update;
mod visit;
mod workspace;
