//! Narrow phases of rapier with our dispatcher, compiled with this crate.
//!
//! Rapier's `NarrowPhase::with_query_dispatcher` is generic over the dispatcher. So the program that calls it compiles
//! what leads to the update of contacts, optimised as the program itself is. That takes some seconds of its build. And
//! where only its dependencies are optimised (`[profile.dev.package."*"] opt-level = 3`, without an `opt-level` for the
//! program), steps take a seventh longer. The functions here do the same, and are compiled once, as a dependency.

use rapier3d::geometry::NarrowPhase;

use crate::IsaGjkDispatcher;

/// A narrow phase that asks `dispatcher`.
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

/// Makes a narrow phase ask `dispatcher` from now on. It keeps its contacts.
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
