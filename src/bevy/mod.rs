//! Rapier worlds in [Bevy](https://bevy.org)'s entity-component-system, without a window or an
//! `App` (feature `bevy`); as a plugin for an `App`, `PhysicsPlugin` (feature `bevy_app`).
//!
//! One resource, [`PhysicsContext`], holds the rapier world, whose hulls meet through
//! [`IsaGjkDispatcher`](crate::IsaGjkDispatcher). Spawning a [`Collider`] makes a dynamic body of
//! the entity; the components it requires say what else can be set. [`install`] adds three sets
//! of systems to a schedule:
//!
//! 1. [`SyncBackend`](PhysicsSystems::SyncBackend) brings new and changed components to rapier.
//! 2. [`StepSimulation`](PhysicsSystems::StepSimulation) steps the world, writes
//!    [`CollisionEvent`]s, and updates [`NarrowPhaseStats`].
//! 3. [`Writeback`](PhysicsSystems::Writeback) writes [`PhysicsTransform`] and [`Velocity`].
//!
//! Despawned entities and removed components leave the rapier world at once. The bodies of entities with Bevy's
//! `Disabled` are disabled in the next step, and return as they were, or as you changed them meanwhile, when the
//! entity does. Lengths are metres, times
//! seconds, angles radians, as rapier has them; one run of the schedule is one step of
//! `integration_parameters.dt`, a sixtieth of a second unless you change it.
//!
//! ```
//! use bevy_ecs::prelude::*;
//! use isa_gjk::bevy::{Collider, PhysicsTransform, RigidBody, install};
//! use rapier3d::prelude::{ColliderBuilder, SharedShape, Vector};
//!
//! let mut world = World::new();
//! let mut schedule = Schedule::default();
//! install(&mut world, &mut schedule);
//!
//! let corners = [Vector::X, Vector::Y, Vector::Z].map(|axis| [axis, -axis]).concat();
//! let hull = SharedShape::convex_hull(&corners).expect("an octahedron is solid");
//! world.spawn((Collider(ColliderBuilder::cuboid(5.0, 0.5, 5.0)), RigidBody::fixed()));
//! let falling = world
//!     .spawn((Collider::from(hull), PhysicsTransform::from_xyz(0.0, 5.0, 0.0)))
//!     .id();
//!
//! for _ in 0..60 {
//!     schedule.run(&mut world);
//! }
//! let height = world.get::<PhysicsTransform>(falling).unwrap().translation.y;
//! assert!(height < 2.0, "after a second it has come down from 5 m to {height} m");
//! ```
//!
//! There is one collider for each body; for a body of several shapes use `SharedShape::compound`. Joints,
//! queries and everything else of rapier are reached through [`PhysicsContext::world`], and its physics hooks are
//! [`PhysicsContext::hooks`]; only its contact force events are not passed on. Some types have the
//! same names as rapier's: import them by name, and they take precedence over `rapier3d::prelude::*`.

mod collision;
mod components;
mod context;
mod disabled;
#[cfg(feature = "bevy_app")]
mod plugin;
mod sync;
mod systems;

pub use collision::CollisionEvent;
pub use components::{Collider, PhysicsTransform, RigidBody, Velocity};
pub use context::PhysicsContext;
#[cfg(feature = "bevy_app")]
pub use plugin::PhysicsPlugin;
pub use systems::{NarrowPhaseStats, PhysicsSystems, install};
