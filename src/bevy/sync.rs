//! Components that users have changed are brought to rapier.

use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemChangeTick;
use rapier3d::prelude::RigidBodyType;

use super::components::{Collider, PhysicsTransform, RigidBody, Velocity};
use super::context::PhysicsContext;
use super::disabled::Synced;

type BodyQuery<'w> = (
    Entity,
    Ref<'w, RigidBody>,
    Option<Ref<'w, Collider>>,
    Ref<'w, PhysicsTransform>,
    Ref<'w, Velocity>,
);
type AnythingChanged = Or<(
    Changed<RigidBody>,
    Changed<Collider>,
    Changed<PhysicsTransform>,
    Changed<Velocity>,
)>;

pub(super) fn sync(
    mut context: ResMut<PhysicsContext>,
    ticks: SystemChangeTick,
    bodies: Query<BodyQuery<'_>>,
    changed: Query<BodyQuery<'_>, AnythingChanged>,
    disabled: Query<Entity, (With<RigidBody>, With<Disabled>)>,
) {
    let context = &mut *context;
    let synced = Synced {
        at: ticks.last_run(),
        written: context.written,
    };
    for entity in &disabled {
        context.disable(entity, synced);
    }
    // They may have been changed while they were disabled, when no query saw it.
    for (entity, synced) in context.take_enabled(|entity| disabled.contains(entity)) {
        if let Ok(body) = bodies.get(entity) {
            sync_body(context, body, Some(synced).filter(|_| context.has(entity)));
            context.enable(entity, &body.1.0);
        }
    }
    for body in &changed {
        sync_body(context, body, Some(synced));
    }
}

/// Brings a body up to date. `synced` is when that was last done, if it was.
fn sync_body(
    context: &mut PhysicsContext,
    (entity, body, collider, transform, velocity): BodyQuery<'_>,
    synced: Option<Synced>,
) {
    let body_changed = synced.is_none_or(|synced| synced.is_changed(&body));
    if body_changed {
        let builder = body.0.clone().pose((*transform).into());
        let moving = builder.linvel(velocity.linear).angvel(velocity.angular);
        context.set_body(entity, moving);
    } else if let Some(synced) = synced {
        apply_user_changes(context, entity, synced, &transform, &velocity);
    }
    if let Some(collider) = collider
        && (synced.is_none_or(|synced| synced.is_changed(&collider))
            || body_changed && context.collider(entity).is_none())
    {
        context.set_collider(entity, &collider.0);
    }
}

/// Moves a body to where the user moved its entity.
fn apply_user_changes(
    context: &mut PhysicsContext,
    entity: Entity,
    synced: Synced,
    transform: &Ref<'_, PhysicsTransform>,
    velocity: &Ref<'_, Velocity>,
) {
    let moved = synced.is_changed_by_user(transform);
    let pushed = synced.is_changed_by_user(velocity);
    if !(moved || pushed) {
        return;
    }
    let Some(body) = context.body_mut(entity) else {
        return;
    };
    if moved {
        let pose = (**transform).into();
        if body.body_type() == RigidBodyType::KinematicPositionBased {
            body.set_next_kinematic_position(pose);
        } else {
            body.set_position(pose, true);
        }
    }
    if pushed {
        body.set_linvel(velocity.linear, true);
        body.set_angvel(velocity.angular, true);
    }
}
