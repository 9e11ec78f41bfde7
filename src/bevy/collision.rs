//! rapier's collision events, with entities in place of colliders.

use std::sync::{Mutex, PoisonError};

use bevy_ecs::entity::Entity;
use bevy_ecs::message::Message;
use rapier3d::prelude::{
    self as rapier, ColliderHandle, ColliderSet, ContactPair, EventHandler, Real, RigidBodySet,
    SoftBodySet, SoftBodyTearEvent,
};

/// Two colliders began or ceased to touch in the last step.
///
/// Every start has one stop, even if an entity is despawned. That message then names an entity that no longer
/// exists.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use isa_gjk::bevy::CollisionEvent;
///
/// fn hear(mut collisions: MessageReader<CollisionEvent>) {
///     for collision in collisions.read() {
///         match collision {
///             CollisionEvent::Started(a, b) => println!("{a} hits {b}"),
///             CollisionEvent::Stopped(a, b) => println!("{a} leaves {b}"),
///         }
///     }
/// }
/// # let mut world = World::new();
/// # let mut schedule = Schedule::default();
/// # isa_gjk::bevy::install(&mut world, &mut schedule);
/// # schedule.add_systems(hear.after(isa_gjk::bevy::PhysicsSystems::StepSimulation));
/// # schedule.run(&mut world);
/// ```
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CollisionEvent {
    /// They touch now, and did not in the step before.
    Started(Entity, Entity),
    /// They touched in the step before, and no longer do.
    Stopped(Entity, Entity),
}

impl CollisionEvent {
    /// The same event with entities for handles, if both have one.
    pub(super) fn new(
        event: rapier::CollisionEvent,
        owner: impl Fn(ColliderHandle) -> Option<Entity>,
    ) -> Option<Self> {
        let pair = (owner(event.collider1())?, owner(event.collider2())?);
        Some(if event.started() {
            Self::Started(pair.0, pair.1)
        } else {
            Self::Stopped(pair.0, pair.1)
        })
    }
}

/// Keeps the collisions of a step; rapier reports them in a fixed order.
#[derive(Default)]
pub(super) struct CollisionRecorder(Mutex<Vec<rapier::CollisionEvent>>);

impl CollisionRecorder {
    pub(super) fn into_events(self) -> Vec<rapier::CollisionEvent> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl EventHandler for CollisionRecorder {
    fn handle_collision_event(
        &self,
        _: &RigidBodySet,
        _: &ColliderSet,
        event: rapier::CollisionEvent,
        _: Option<&ContactPair>,
    ) {
        let mut events = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        events.push(event);
    }

    fn handle_contact_force_event(
        &self,
        _: Real,
        _: &RigidBodySet,
        _: &ColliderSet,
        _: &ContactPair,
        _: Real,
    ) {
    }

    fn handle_soft_body_tear_event(&self, _: &SoftBodySet, _: &SoftBodyTearEvent) {}
}
