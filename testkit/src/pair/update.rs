//! A manifold update, called as rapier does.

use std::hint::black_box;

use parry3d::math::Pose;
use parry3d::query::details::ContactManifoldsWorkspace;
use parry3d::query::{ContactManifold, PersistentQueryDispatcher};
use parry3d::shape::SharedShape;

use super::trajectory::PREDICTION;

/// What the contact graph keeps of a pair.
#[derive(Default)]
pub struct Manifolds {
    pub list: Vec<ContactManifold<(), ()>>,
    workspace: Option<ContactManifoldsWorkspace>,
}

/// Brings the manifolds of a pair up to date.
#[inline]
pub fn update(
    dispatcher: &impl PersistentQueryDispatcher,
    [a, b]: &[SharedShape; 2],
    pose: &Pose,
    manifolds: &mut Manifolds,
) {
    dispatcher
        .contact_manifolds(
            black_box(pose),
            &**a,
            &**b,
            PREDICTION,
            &mut manifolds.list,
            &mut manifolds.workspace,
        )
        .expect("both dispatchers know these shapes");
}
