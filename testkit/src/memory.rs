//! What rapier keeps about a pair of colliders between frames.

use isa_gjk::{IsaGjkDispatcher, Stage, Stats};
use parry3d::math::{Pose, Real};
use parry3d::query::details::{ContactManifoldsWorkspace, NormalConstraints};
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, Unsupported,
};
use parry3d::shape::{Shape, SharedShape};

use super::silent::Silent;

/// Some tests keep a number with each contact, as a solver does.
pub type Manifold = ContactManifold<(), u32>;

/// The functions of [`PersistentQueryDispatcher`], compiled with this crate. Those are generic over the solver's
/// data: each program that calls them compiles what leads to an update, and parry's routines, which takes ten seconds.
pub trait UpdateManifolds {
    fn update_manifolds(
        &self,
        pos12: &Pose,
        shapes: [&dyn Shape; 2],
        prediction: Real,
        manifolds: &mut Vec<Manifold>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported>;

    /// Of two convex shapes, whose normals may be constrained.
    fn update_manifold(
        &self,
        pos12: &Pose,
        shapes: [&dyn Shape; 2],
        constraints: [Option<&dyn NormalConstraints>; 2],
        prediction: Real,
        manifold: &mut Manifold,
    ) -> Result<(), Unsupported>;
}

macro_rules! compile {
    ($($dispatcher:ty),*) => {$(
        impl UpdateManifolds for $dispatcher {
            fn update_manifolds(
                &self,
                pos12: &Pose,
                [a, b]: [&dyn Shape; 2],
                prediction: Real,
                manifolds: &mut Vec<Manifold>,
                workspace: &mut Option<ContactManifoldsWorkspace>,
            ) -> Result<(), Unsupported> {
                self.contact_manifolds(pos12, a, b, prediction, manifolds, workspace)
            }

            fn update_manifold(
                &self,
                pos12: &Pose,
                [a, b]: [&dyn Shape; 2],
                [on_a, on_b]: [Option<&dyn NormalConstraints>; 2],
                prediction: Real,
                manifold: &mut Manifold,
            ) -> Result<(), Unsupported> {
                self.contact_manifold_convex_convex(pos12, a, b, on_a, on_b, prediction, manifold)
            }
        }
    )*};
}

compile!(
    IsaGjkDispatcher,
    IsaGjkDispatcher<Silent>,
    DefaultQueryDispatcher
);

#[derive(Clone, Default)]
pub struct Memory {
    pub manifolds: Vec<Manifold>,
    pub workspace: Option<ContactManifoldsWorkspace>,
}

impl Memory {
    /// The only manifold of a pair of convex shapes, after another frame.
    pub fn update(
        &mut self,
        dispatcher: &impl UpdateManifolds,
        pose: &Pose,
        shapes: [&SharedShape; 2],
        prediction: Real,
    ) -> Option<&Manifold> {
        let shapes = shapes.map(|shape| &**shape);
        let (manifolds, workspace) = (&mut self.manifolds, &mut self.workspace);
        dispatcher
            .update_manifolds(pose, shapes, prediction, manifolds, workspace)
            .ok()?;
        self.manifolds.first()
    }
}

/// What a manifold without a past says.
pub fn cold_manifold(
    dispatcher: &impl UpdateManifolds,
    pose: &Pose,
    shapes: [&SharedShape; 2],
    prediction: Real,
) -> Option<Manifold> {
    let mut memory = Memory::default();
    memory.update(dispatcher, pose, shapes, prediction)?;
    memory.manifolds.pop()
}

/// How many updates left the contacts where they were, with a proof of the frame or of an earlier one.
pub fn kept(stats: &Stats) -> u64 {
    [Stage::Still, Stage::Kept]
        .map(|stage| stats.answered[stage as usize])
        .iter()
        .sum()
}
