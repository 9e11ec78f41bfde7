//! A saved world continues as if it had never been saved.
//!
//! Games save, roll back and replay. Rapier saves manifolds and parry's workspaces, but not the
//! dispatcher; whatever else influenced a step would show here as a different bit.

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::*;
use testkit::world::{Ground, check_places, deepest, mixed, ours, state};

const BODIES: usize = 28;
/// The pile is still moving when it is saved.
const BEFORE: usize = 50;
const AFTER: usize = 100;

fn save(world: &PhysicsWorld) -> Vec<u8> {
    bincode::serialize(world).expect("a world can be saved")
}

fn load(bytes: &[u8]) -> PhysicsWorld {
    bincode::deserialize(bytes).expect("a world can be loaded")
}

/// A world in which every body has a plain shape: those that are prepared come back plain, with
/// other bounding boxes in the last bit.
fn pile(ground: Ground) -> PhysicsWorld {
    let mut world = mixed(ground, BODIES, ours());
    for (_, collider) in world.colliders.iter_mut() {
        let saved = bincode::serialize(collider.shared_shape()).expect("a shape can be saved");
        collider.set_shape(bincode::deserialize(&saved).expect("a shape can be loaded"));
    }
    (0..BEFORE).for_each(|_| world.step());
    world
}

fn assert_go_on_alike(mut world: PhysicsWorld, mut other: PhysicsWorld, what: &str) {
    for frame in 0..AFTER {
        world.step();
        other.step();
        assert!(state(&world) == state(&other), "{what}: frame {frame}");
    }
    check_places(&world, what);
}

#[test]
fn a_loaded_world_goes_on_bit_for_bit() {
    for ground in Ground::ALL {
        let world = pile(ground);
        let mut loaded = load(&save(&world));
        loaded
            .narrow_phase
            .set_query_dispatcher(IsaGjkDispatcher::default());
        assert_go_on_alike(world, loaded, &format!("on {ground:?}"));
    }
}

/// On another thread nothing is prepared.
#[test]
fn a_loaded_world_goes_on_alike_in_another_thread() {
    let mut world = pile(Ground::Mesh);
    let saved = save(&world);
    let there = std::thread::spawn(move || {
        let mut loaded = load(&saved);
        loaded
            .narrow_phase
            .set_query_dispatcher(IsaGjkDispatcher::default());
        (0..AFTER).for_each(|_| loaded.step());
        state(&loaded)
    });
    (0..AFTER).for_each(|_| world.step());
    assert!(there.join().expect("no panic") == state(&world));
}

#[test]
fn a_cloned_world_goes_on_bit_for_bit() {
    for ground in Ground::ALL {
        let world = pile(ground);
        let clone = PhysicsWorld {
            islands: world.islands.clone(),
            broad_phase: world.broad_phase.clone(),
            narrow_phase: world.narrow_phase.clone(),
            bodies: world.bodies.clone(),
            colliders: world.colliders.clone(),
            ..PhysicsWorld::default()
        };
        assert_go_on_alike(world, clone, &format!("on {ground:?}"));
    }
}

/// A player without this crate.
#[test]
fn a_world_loads_without_us() {
    for ground in Ground::ALL {
        let mut world = mixed(ground, BODIES, ours());
        (0..BEFORE).for_each(|_| world.step());
        let mut loaded = load(&save(&world));
        (0..AFTER).for_each(|_| loaded.step());
        check_places(&loaded, &format!("on {ground:?}"));
        let depth = deepest(&loaded);
        assert!(depth < 0.1, "{depth} deep on {ground:?}");
    }
}
