//! What the kernels answer: hulls, supports, simplices, GJK, EPA and ray casts.

mod balls_in_hulls;
mod boxes;
mod curved_oracle;
mod every_start;
mod feet;
mod hill_climbing;
mod hull_errors;
mod oracle;
mod polytope_cache;
mod properties;
mod ray_cast;
mod returning_vertex;
mod simplex;
mod smooth;
