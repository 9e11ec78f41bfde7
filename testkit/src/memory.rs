//! What rapier keeps about a pair of colliders between frames.

use isa_gjk::{Stage, Stats};
use parry3d::math::{Pose, Real};
use parry3d::query::details::ContactManifoldsWorkspace;
use parry3d::query::{ContactManifold, PersistentQueryDispatcher};
use parry3d::shape::SharedShape;

pub type Manifold = ContactManifold<(), ()>;

#[derive(Clone, Default)]
pub struct Memory {
    pub manifolds: Vec<Manifold>,
    pub workspace: Option<ContactManifoldsWorkspace>,
}

impl Memory {
    /// The only manifold of a pair of convex shapes, after another frame.
    pub fn update(
        &mut self,
        dispatcher: &impl PersistentQueryDispatcher<(), ()>,
        pose: &Pose,
        shapes: [&SharedShape; 2],
        prediction: Real,
    ) -> Option<&Manifold> {
        let [shape1, shape2] = shapes;
        dispatcher
            .contact_manifolds(
                pose,
                &**shape1,
                &**shape2,
                prediction,
                &mut self.manifolds,
                &mut self.workspace,
            )
            .ok()?;
        self.manifolds.first()
    }
}

/// What a manifold without a past says.
pub fn cold_manifold(
    dispatcher: &impl PersistentQueryDispatcher,
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
