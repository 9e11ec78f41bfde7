//! The plugin: in step with the fixed clock of an `App`, with messages and diagnostics.

use std::time::Duration;

use bevy_app::{App, TaskPoolPlugin, Update};
use bevy_diagnostic::{DiagnosticPath, DiagnosticsPlugin, DiagnosticsStore};
use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use isa_gjk::bevy::{
    Collider, CollisionEvent, PhysicsContext, PhysicsPlugin, PhysicsTransform, RigidBody,
};
use rapier3d::prelude::{ColliderBuilder, SharedShape, Vector};

/// An octahedron above a floor, in an app with `frames` frames and `steps` steps a second.
fn app(frames: u32, steps: u32) -> (App, Entity) {
    let mut app = App::new();
    app.insert_resource(Time::<Fixed>::from_hz(steps.into()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(
            Duration::from_secs(1) / frames,
        ))
        .add_plugins((
            TaskPoolPlugin::default(),
            TimePlugin,
            DiagnosticsPlugin,
            PhysicsPlugin,
        ));
    let corners = [Vector::X, Vector::Y, Vector::Z]
        .map(|axis| [axis, -axis])
        .concat();
    let hull = SharedShape::convex_hull(&corners).expect("an octahedron is solid");
    let world = app.world_mut();
    world.spawn((
        Collider(ColliderBuilder::cuboid(5.0, 0.5, 5.0)),
        RigidBody::fixed(),
        PhysicsTransform::from_xyz(0.0, -0.5, 0.0),
    ));
    let place = PhysicsTransform::from_xyz(0.0, 2.0, 0.0);
    let hull = world.spawn((Collider::from(hull), place)).id();
    app.finish();
    app.cleanup();
    // The clock starts with the first frame.
    app.update();
    (app, hull)
}

fn run(app: &mut App, frames: usize) {
    (0..frames).for_each(|_| app.update());
}

#[test]
fn steps_are_those_of_the_fixed_clock_whatever_the_frame_rate() {
    let heights = [20, 40, 80].map(|frames| {
        let (mut app, hull) = app(frames, 40);
        run(&mut app, frames as usize / 4);
        let dt = app
            .world()
            .resource::<PhysicsContext>()
            .world
            .integration_parameters
            .dt;
        assert_eq!(dt, 1.0 / 40.0);
        app.world()
            .get::<PhysicsTransform>(hull)
            .unwrap()
            .translation
            .y
    });
    assert!(
        (heights[0] - 1.7).abs() < 0.05,
        "fallen for 0.25 s: {heights:?}"
    );
    assert_eq!(heights, [heights[0]; 3]);
}

#[test]
fn a_reader_that_runs_once_a_frame_hears_every_collision_once() {
    #[derive(Resource, Default)]
    struct Heard(usize);

    let (mut app, _) = app(10, 100);
    app.init_resource::<Heard>().add_systems(
        Update,
        |mut collisions: MessageReader<CollisionEvent>, mut heard: ResMut<Heard>| {
            let starts = collisions
                .read()
                .map(|c| matches!(c, CollisionEvent::Started(..)));
            heard.0 += starts.filter(|&started| started).count();
        },
    );
    run(&mut app, 6);
    assert_eq!(app.world().resource::<Heard>().0, 1);
}

#[test]
fn diagnostics_measure_pairs_and_queries() {
    let (mut app, _) = app(60, 60);
    run(&mut app, 30);
    let store = app.world().resource::<DiagnosticsStore>();
    let highest = |path: &DiagnosticPath| {
        let values = store.get(path).expect("it is registered").values();
        values.copied().fold(0.0, f64::max)
    };
    assert_eq!(highest(&PhysicsPlugin::CONTACT_PAIRS), 1.0);
    assert_eq!(highest(&PhysicsPlugin::QUERIES), 1.0);
    #[cfg(feature = "profiler")]
    assert!(highest(&PhysicsPlugin::STEP_TIME) > highest(&PhysicsPlugin::NARROW_PHASE_TIME));
}
