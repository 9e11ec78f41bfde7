//! Worlds in which pairs are left to the fallback say so: in the statistics, and once in the log.

use std::cell::RefCell;

use isa_gjk::{IsaGjkDispatcher, Left};
use log::{LevelFilter, Log, Metadata, Record};
use rapier3d::prelude::*;
use testkit::world::narrow_phase;

/// What this crate says in each thread.
struct Listener;

thread_local! {
    static HEARD: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

impl Log for Listener {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn log(&self, record: &Record<'_>) {
        if record.target().starts_with("isa_gjk") {
            HEARD.with_borrow_mut(|heard| heard.push(record.args().to_string()));
        }
    }

    fn flush(&self) {}
}

/// A plain hull over corners that no builder has checked.
fn unchecked(corners: Vec<Vector>, faces: &[[u32; 3]]) -> SharedShape {
    SharedShape::convex_mesh(corners, faces).expect("a closed surface")
}

/// Ten bodies of a shape over the ground.
fn world_of(shape: &SharedShape, dispatcher: &IsaGjkDispatcher) -> PhysicsWorld {
    let mut world = PhysicsWorld {
        narrow_phase: narrow_phase(dispatcher),
        ..PhysicsWorld::default()
    };
    let ground = ColliderBuilder::cuboid(20.0, 0.5, 20.0).translation(Vector::new(0.0, -0.5, 0.0));
    world.insert_collider(ground, None);
    for i in 0..10 {
        let place = Vector::new(3.0 * i as Real - 15.0, 0.01, 0.0);
        let mass = MassProperties::new(Vector::ZERO, 1.0, Vector::ONE);
        let body = RigidBodyBuilder::dynamic()
            .translation(place)
            .additional_mass_properties(mass);
        world.insert(body, ColliderBuilder::new(shape.clone()));
    }
    world
}

#[test]
fn hulls_that_are_no_solids_are_counted_and_reported() {
    // Other tests of this binary hear nothing of each other.
    let _ = log::set_logger(&Listener);
    log::set_max_level(LevelFilter::Warn);
    let (corners, faces) = Cuboid::new(Vector::new(1.0, 1e-7, 1.0)).to_trimesh();
    let wide_and_flat = unchecked(corners, &faces);
    let three_points = vec![Vector::ZERO, Vector::X, Vector::Z];
    let three_points = unchecked(three_points, &[[0, 1, 2], [0, 2, 1]]);
    for (what, shape) in [
        ("wide and flat", wide_and_flat),
        ("three points", three_points),
    ] {
        let dispatcher = IsaGjkDispatcher::default();
        let mut world = world_of(&shape, &dispatcher);
        (0..10).for_each(|_| world.step());
        let left = dispatcher.stats().left_to_fallback;
        assert!(
            left[Left::HullNotPrepared as usize] >= 10,
            "{what}: {left:?}"
        );
        assert_eq!(
            left.iter().sum::<u64>(),
            left[Left::HullNotPrepared as usize]
        );
        let heard = HEARD.take();
        assert_eq!(heard.len(), 1, "{what}: {heard:?}");
        assert!(
            heard[0].contains("flat") && heard[0].contains("HullShape"),
            "{heard:?}"
        );
    }
}

#[test]
fn pairs_without_a_hull_are_counted_and_normal() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut world = world_of(&SharedShape::ball(0.1), &dispatcher);
    (0..10).for_each(|_| world.step());
    let left = dispatcher.stats().left_to_fallback;
    assert!(left[Left::NoHull as usize] >= 10, "{left:?}");
    assert_eq!(left.iter().sum::<u64>(), left[Left::NoHull as usize]);
    assert!(HEARD.take().is_empty(), "nothing is wrong");
}
