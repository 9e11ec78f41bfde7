//! Rapier's narrow phase with our dispatcher, compiled with this crate (feature `rapier`).
//!
//! Rapier's `NarrowPhase::with_query_dispatcher` is generic over the dispatcher, so the program that calls it compiles
//! what leads to the update of contacts, and optimises it as little as itself. The functions here do the same, but are
//! compiled once, as part of a dependency. That saves some seconds of the program's build. And if only dependencies are
//! optimised, as often during development (`[profile.dev.package."*"] opt-level = 3`), steps are a seventh faster.

use rapier3d::geometry::NarrowPhase;

use crate::IsaGjkDispatcher;

/// A new narrow phase that uses `dispatcher`, for `PhysicsWorld` or `PhysicsPipeline::step`.
///
/// ```
/// use isa_gjk::{IsaGjkDispatcher, rapier};
/// use rapier3d::prelude::*;
///
/// let mut world = PhysicsWorld {
///     narrow_phase: rapier::narrow_phase(IsaGjkDispatcher::default()),
///     ..PhysicsWorld::default()
/// };
/// world.step();
/// ```
pub fn narrow_phase(dispatcher: IsaGjkDispatcher) -> NarrowPhase {
    NarrowPhase::with_query_dispatcher(dispatcher)
}

/// Makes a narrow phase use `dispatcher` from now on, such as that of a world that is running or was loaded. It keeps
/// its contacts.
///
/// ```
/// use isa_gjk::{IsaGjkDispatcher, rapier};
/// use rapier3d::prelude::*;
///
/// let mut world = PhysicsWorld::default();
/// world.step();
/// rapier::set_dispatcher(&mut world.narrow_phase, IsaGjkDispatcher::default());
/// world.step();
/// ```
pub fn set_dispatcher(narrow_phase: &mut NarrowPhase, dispatcher: IsaGjkDispatcher) {
    narrow_phase.set_query_dispatcher(dispatcher);
}
