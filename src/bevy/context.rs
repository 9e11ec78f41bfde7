//! The rapier world as a resource, and the entities that own its bodies and colliders.

use std::collections::{BTreeMap, HashMap};

use bevy_ecs::change_detection::Tick;
use bevy_ecs::entity::{Entity, EntityHashMap};
use bevy_ecs::prelude::Resource;
use rapier3d::prelude::{
    self as rapier, ActiveEvents, ColliderBuilder, ColliderHandle, NarrowPhase, PhysicsHooks,
    PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
};

use super::collision::{CollisionEvent, CollisionRecorder};
use super::disabled::{DisabledEntities, Synced};
use crate::IsaGjkDispatcher;
use crate::stats::Stats;

/// The rapier world of all bodies and colliders.
///
/// [`install`](super::install) inserts one that is empty. To start from other settings, insert it
/// yourself, before any entity has a body; an entity's body does not follow into another context.
/// Despawn nothing while the context is out of the world, as in `World::resource_scope`: its body
/// would stay behind.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use isa_gjk::bevy::{Collider, PhysicsContext, RigidBody, install};
/// use rapier3d::prelude::{ColliderBuilder, Vector};
///
/// let mut context = PhysicsContext::default();
/// context.world.gravity = Vector::Y * -1.62;
///
/// let (mut world, mut schedule) = (World::new(), Schedule::default());
/// world.insert_resource(context);
/// install(&mut world, &mut schedule);
/// let stone = world.spawn(Collider(ColliderBuilder::ball(0.1))).id();
/// schedule.run(&mut world);
///
/// let context = world.resource::<PhysicsContext>();
/// let handle = context.body(stone).expect("the step brought it there");
/// assert!(context.world.bodies[handle].linvel().y < 0.0, "it falls");
/// ```
#[derive(Resource)]
pub struct PhysicsContext {
    /// Rapier's sets and pipelines, for settings, forces, joints and queries.
    ///
    /// Bodies and colliders that you insert here are stepped with the others and left alone;
    /// those of entities come and go with their components.
    pub world: PhysicsWorld,
    /// Called within each step for colliders with `active_hooks`; none unless you set it. The `user_data` of a
    /// `ColliderBuilder` tells a hook which collider it is about.
    ///
    /// ```
    /// use isa_gjk::bevy::PhysicsContext;
    /// use rapier3d::prelude::{ContactModificationContext, PhysicsHooks};
    ///
    /// struct Ice;
    ///
    /// impl PhysicsHooks for Ice {
    ///     fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
    ///         if let Some(manifold) = context.rigid_mut() {
    ///             *manifold.friction = 0.0;
    ///         }
    ///     }
    /// }
    ///
    /// let mut context = PhysicsContext::default();
    /// context.hooks = Box::new(Ice);
    /// ```
    pub hooks: Box<dyn PhysicsHooks + Send + Sync>,
    dispatcher: IsaGjkDispatcher,
    entities: EntityHashMap<Handles>,
    owners: HashMap<ColliderHandle, Entity>,
    /// Removed colliders whose last collisions end in the next step. They have an owner until then.
    removed: Vec<ColliderHandle>,
    disabled: DisabledEntities,
    /// When we last wrote components. Anything that changed at another time was changed by the user.
    pub(super) written: Tick,
}

struct Handles {
    body: RigidBodyHandle,
    collider: Option<ColliderHandle>,
}

impl Default for PhysicsContext {
    /// An empty world whose hulls meet through this crate's dispatcher.
    fn default() -> Self {
        let dispatcher = IsaGjkDispatcher::default();
        let narrow_phase = crate::rapier::narrow_phase(dispatcher.clone());
        Self {
            world: PhysicsWorld {
                narrow_phase,
                ..PhysicsWorld::default()
            },
            hooks: Box::new(()),
            dispatcher,
            entities: EntityHashMap::default(),
            owners: HashMap::new(),
            removed: Vec::new(),
            disabled: DisabledEntities::default(),
            written: Tick::default(),
        }
    }
}

impl PhysicsContext {
    /// An empty world with rapier's own dispatcher, to compare with.
    ///
    /// ```
    /// use bevy_ecs::prelude::*;
    /// use isa_gjk::bevy::{PhysicsContext, install};
    ///
    /// let (mut world, mut schedule) = (World::new(), Schedule::default());
    /// world.insert_resource(PhysicsContext::with_default_narrow_phase());
    /// install(&mut world, &mut schedule);
    /// ```
    pub fn with_default_narrow_phase() -> Self {
        let mut context = Self::default();
        context.world.narrow_phase = NarrowPhase::new();
        context
    }

    /// The dispatcher whose statistics are reported. Within a step it relies on unchanged shapes. If you
    /// replace `world`, give this dispatcher to the narrow phase of the new one.
    pub fn dispatcher(&self) -> &IsaGjkDispatcher {
        &self.dispatcher
    }

    /// The body of an entity, once a step has begun since it was spawned.
    pub fn body(&self, entity: Entity) -> Option<RigidBodyHandle> {
        self.entities.get(&entity).map(|handles| handles.body)
    }

    /// The collider of an entity, once a step has begun since it was spawned.
    pub fn collider(&self, entity: Entity) -> Option<ColliderHandle> {
        self.entities.get(&entity)?.collider
    }

    /// The entity that a collider belongs to, as found by a query.
    ///
    /// ```
    /// use bevy_ecs::prelude::*;
    /// use isa_gjk::bevy::PhysicsContext;
    /// use rapier3d::prelude::{QueryFilter, Ray};
    ///
    /// fn entity_hit_by(ray: &Ray, context: &PhysicsContext) -> Option<Entity> {
    ///     let world = &context.world;
    ///     let (collider, _) = world.cast_ray(ray, 100.0, true, QueryFilter::default())?;
    ///     context.entity(collider)
    /// }
    /// ```
    pub fn entity(&self, collider: ColliderHandle) -> Option<Entity> {
        self.owners.get(&collider).copied()
    }

    pub(super) fn stats(&self) -> Stats {
        self.dispatcher.stats()
    }

    /// Inserts the body of an entity, or resets the existing one.
    pub(super) fn set_body(&mut self, entity: Entity, body: RigidBodyBuilder) {
        let built = body.build();
        if let Some(known) = self.body_mut(entity) {
            known.copy_from(&built);
        } else {
            let handles = Handles {
                body: self.world.insert_body(built),
                collider: None,
            };
            // The user removed the body, and the collider with it.
            let lost = self.entities.insert(entity, handles);
            self.removed.extend(lost.and_then(|lost| lost.collider));
        }
    }

    /// Inserts the collider of an entity with a body, or resets the existing one.
    pub(super) fn set_collider(&mut self, entity: Entity, collider: &ColliderBuilder) {
        let Some(handles) = self.entities.get_mut(&entity) else {
            return;
        };
        let events = collider.active_events | ActiveEvents::COLLISION_EVENTS;
        let built = collider.clone().active_events(events).build();
        let known = handles
            .collider
            .and_then(|c| self.world.colliders.get_mut(c));
        if let Some(known) = known {
            known.copy_from(&built);
            known.set_position_wrt_parent(collider.position);
            self.world.wake_up(handles.body, true);
        } else if self.world.bodies.contains(handles.body) {
            let handle = self.world.insert_collider(built, Some(handles.body));
            handles.collider = Some(handle);
            self.owners.insert(handle, entity);
        }
    }

    pub(super) fn remove_body(&mut self, entity: Entity) {
        if let Some(handles) = self.entities.remove(&entity) {
            self.removed.extend(handles.collider);
            self.world.remove_body(handles.body);
        }
    }

    pub(super) fn remove_collider(&mut self, entity: Entity) {
        let handles = self.entities.get_mut(&entity);
        if let Some(handle) = handles.and_then(|handles| handles.collider.take()) {
            self.removed.push(handle);
            self.world.remove_collider(handle);
        }
    }

    /// Whether the entity was ever given a body that is not yet removed with its component.
    pub(super) fn has(&self, entity: Entity) -> bool {
        self.entities.contains_key(&entity)
    }

    /// Disables the body of a disabled entity, if it has one, until [`enable`](Self::enable).
    pub(super) fn disable(&mut self, entity: Entity, synced: Synced) {
        if self.disabled.insert(entity, synced)
            && let Some(body) = self.body_mut(entity)
        {
            body.set_enabled(false);
        }
    }

    /// The entities that are disabled no more, and when their components were last looked at.
    pub(super) fn take_enabled(
        &mut self,
        is_disabled: impl Fn(Entity) -> bool,
    ) -> BTreeMap<Entity, Synced> {
        self.disabled.take_unless(is_disabled)
    }

    /// Lets the body take part again, unless its builder says otherwise.
    pub(super) fn enable(&mut self, entity: Entity, builder: &RigidBodyBuilder) {
        if let Some(body) = self.body_mut(entity) {
            body.set_enabled(builder.enabled);
        }
    }

    pub(super) fn body_mut(&mut self, entity: Entity) -> Option<&mut rapier::RigidBody> {
        let handle = self.body(entity)?;
        self.world.bodies.get_mut(handle)
    }

    /// Steps the world and returns the pairs that began or ceased to touch.
    pub(super) fn step(&mut self) -> Vec<CollisionEvent> {
        let recorder = CollisionRecorder::default();
        let (world, hooks) = (&mut self.world, &*self.hooks);
        self.dispatcher
            .with_unchanged_shapes(|| world.step_with_events(hooks, &recorder));
        let events = recorder.into_events().into_iter();
        let told = events
            .filter_map(|event| CollisionEvent::new(event, |collider| self.entity(collider)))
            .collect();
        for collider in self.removed.drain(..) {
            self.owners.remove(&collider);
        }
        told
    }
}
