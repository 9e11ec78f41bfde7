//! What the dispatcher answers about pairs of shapes, against exact answers and parry's.

mod axis_frame;
mod bad_input;
mod balls;
mod changed_shapes;
mod coherence;
mod contacts;
mod curved;
mod exact_cases;
mod fallback;
mod fuzz;
mod hull_shape;
mod hull_shape_solid;
mod kept;
mod many_parts;
mod meshes;
mod near_touch;
mod no_allocations;
mod no_pair_lost;
mod parry_regressions;
mod round_pairs;
mod scene_queries;
mod sizes;
mod touching;
mod unusual_callers;
mod walk;
mod witnesses;
