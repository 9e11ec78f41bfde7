//! One step of the schedule.

use bevy_ecs::message::{MessageWriter, Messages};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemChangeTick;

use super::collision::CollisionEvent;
use super::components::{PhysicsTransform, RigidBody, Velocity};
use super::context::PhysicsContext;
use super::sync::sync;
use crate::stats::Stats;

/// The sets of systems that make a step, in their order.
///
/// What you change before `SyncBackend` takes part in the step; what you read after `Writeback` is
/// its outcome. A pose or velocity changed between the two is overwritten.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use isa_gjk::bevy::{PhysicsSystems, Velocity, install};
/// use rapier3d::prelude::Vector;
///
/// fn wind(mut velocities: Query<&mut Velocity>) {
///     for mut velocity in &mut velocities {
///         velocity.linear += Vector::X * 0.01;
///     }
/// }
///
/// let (mut world, mut schedule) = (World::new(), Schedule::default());
/// install(&mut world, &mut schedule);
/// schedule.add_systems(wind.before(PhysicsSystems::SyncBackend));
/// # schedule.run(&mut world);
/// ```
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhysicsSystems {
    /// New and changed components are written to rapier.
    SyncBackend,
    /// The rapier world is stepped.
    StepSimulation,
    /// Poses and velocities are read back.
    Writeback,
}

/// The cost of the dispatcher's queries; zero with rapier's default narrow phase.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use isa_gjk::Stage;
/// use isa_gjk::bevy::NarrowPhaseStats;
///
/// fn watch(stats: Res<NarrowPhaseStats>) {
///     let warm = stats.last_step.answered[Stage::Feature as usize];
///     println!("{warm} of {} by their features", stats.last_step.queries());
/// }
/// # let mut world = World::new();
/// # world.init_resource::<NarrowPhaseStats>();
/// # let mut schedule = Schedule::default();
/// # schedule.add_systems(watch).run(&mut world);
/// ```
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NarrowPhaseStats {
    /// In the last step.
    pub last_step: Stats,
    /// Since the [`PhysicsContext`] was made.
    pub total: Stats,
}

/// Adds the resources to `world` and the systems to `schedule`; each run of it is one step.
///
/// An existing [`PhysicsContext`] is kept. Only one schedule steps a world: a second call for the same world
/// does nothing. [`CollisionEvent`]s can be read until the end of the step after their own.
pub fn install(world: &mut World, schedule: &mut Schedule) {
    if !begin_install(world) {
        return;
    }
    // The creator of the messages also drops old ones.
    if !world.contains_resource::<Messages<CollisionEvent>>() {
        world.init_resource::<Messages<CollisionEvent>>();
        schedule.add_systems(expire_messages.in_set(PhysicsSystems::SyncBackend));
    }
    add_systems(schedule);
}

/// That something steps a world.
#[derive(Resource)]
struct Installed;

/// Adds the resources to a world that nothing steps yet; `false` for others.
pub(super) fn begin_install(world: &mut World) -> bool {
    if world.contains_resource::<Installed>() {
        return false;
    }
    world.insert_resource(Installed);
    world.init_resource::<PhysicsContext>();
    world.init_resource::<NarrowPhaseStats>();
    true
}

/// All systems but the one that forgets old messages, which an `App` has already.
pub(super) fn add_systems(schedule: &mut Schedule) {
    schedule.configure_sets(
        (
            PhysicsSystems::SyncBackend,
            PhysicsSystems::StepSimulation,
            PhysicsSystems::Writeback,
        )
            .chain(),
    );
    schedule.add_systems((
        sync.in_set(PhysicsSystems::SyncBackend),
        step.in_set(PhysicsSystems::StepSimulation),
        write_back.in_set(PhysicsSystems::Writeback),
    ));
}

fn expire_messages(mut messages: ResMut<Messages<CollisionEvent>>) {
    messages.update();
}

fn step(
    mut context: ResMut<PhysicsContext>,
    mut stats: ResMut<NarrowPhaseStats>,
    mut collisions: MessageWriter<CollisionEvent>,
) {
    collisions.write_batch(context.step());
    let total = context.stats();
    stats.last_step = total.since(&stats.total);
    stats.total = total;
}

fn write_back(
    mut context: ResMut<PhysicsContext>,
    ticks: SystemChangeTick,
    mut bodies: Query<(Entity, &mut PhysicsTransform, &mut Velocity), With<RigidBody>>,
) {
    context.written = ticks.this_run();
    for (entity, mut transform, mut velocity) in &mut bodies {
        if let Some(body) = context.body_mut(entity) {
            transform.set_if_neq((*body.position()).into());
            velocity.set_if_neq((&*body).into());
        }
    }
}
