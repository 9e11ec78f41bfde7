//! The contact manifold of two convex shapes, from frame to frame.

mod axis_frame;
mod curved;
mod erased;
mod flush;
mod half_space;
mod inherit;
mod kept;
mod kernel_manifold;
mod normals;
mod on_plane;
mod own_contacts;
mod packed_feature;
mod polytopes;
mod sink;
mod still;
mod update;

pub(crate) use erased::ErasedManifold;
pub(crate) use update::UpdateManifold;
