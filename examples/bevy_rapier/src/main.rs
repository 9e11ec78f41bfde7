//! `bevy_rapier3d` with our dispatcher, from the first step on and installed in a running world.

use std::time::Duration;

use bevy::prelude::*;
use bevy::time::{TimePlugin, TimeUpdateStrategy};
use bevy_rapier3d::prelude::*;
use isa_gjk::IsaGjkDispatcher;

/// A clone of what the contexts get, to read the statistics from.
#[derive(Resource, Clone, Default)]
struct Dispatcher(IsaGjkDispatcher);

/// For each context, as soon as it is there: before it has any collider.
fn install(
    added: On<Add<RapierContextSimulation>>,
    dispatcher: Res<Dispatcher>,
    mut contexts: Query<&mut RapierContextSimulation>,
) {
    if let Ok(mut context) = contexts.get_mut(added.entity) {
        context.set_query_dispatcher(dispatcher.0.clone());
    }
}

/// For contexts that run already: the narrow phase itself keeps its contacts, while the context's
/// own `set_query_dispatcher` would replace it by an empty one.
fn install_mid_run(dispatcher: Res<Dispatcher>, mut contexts: Query<&mut RapierContextSimulation>) {
    for mut context in &mut contexts {
        context
            .narrow_phase
            .set_query_dispatcher(dispatcher.0.clone());
    }
}

fn main() {
    let dispatcher = Dispatcher::default();
    let (mut app, hull) = falling_hull(&dispatcher);
    app.add_observer(install);
    run(&mut app, 90);
    report("installed at the start", &app, &dispatcher, hull);

    let dispatcher = Dispatcher::default();
    let (mut app, hull) = falling_hull(&dispatcher);
    run(&mut app, 90);
    assert_eq!(dispatcher.0.stats().queries(), 0, "not installed yet");
    assert_eq!(contact_pairs(&mut app), 1);
    let world = app.world_mut();
    world
        .run_system_cached(install_mid_run)
        .expect("its parameters exist");
    assert_eq!(contact_pairs(&mut app), 1, "the contact is kept");
    // Rapier does not ask again about a pair at rest.
    let push = Velocity::linear(Vec3::X);
    app.world_mut().entity_mut(hull).insert(push);
    run(&mut app, 30);
    report("installed under a hull at rest", &app, &dispatcher, hull);
}

fn run(app: &mut App, frames: usize) {
    (0..frames).for_each(|_| app.update());
}

fn report(when: &str, app: &App, dispatcher: &Dispatcher, hull: Entity) {
    let queries = dispatcher.0.stats().queries();
    assert!(queries > 0, "{when}: our dispatcher was not asked");
    let transform = app.world().get::<Transform>(hull).expect("a hull");
    let height = transform.translation.y;
    assert!(
        (height - 0.25).abs() < 0.01,
        "{when}: the hull lies at {height} m instead of 0.25 m"
    );
    println!("{when}: {queries} queries, the hull lies at {height:.3} m");
}

fn contact_pairs(app: &mut App) -> usize {
    let world = app.world_mut();
    let mut contexts = world.query::<&RapierContextSimulation>();
    let pairs = contexts
        .iter(world)
        .map(|c| c.narrow_phase.contact_pairs().count());
    pairs.sum()
}

/// A cube of half a metre, as a hull, three metres above the ground.
fn falling_hull(dispatcher: &Dispatcher) -> (App, Entity) {
    let tick = Duration::from_secs_f32(1.0 / 60.0);
    let mut app = App::new();
    app.insert_resource(dispatcher.clone())
        .insert_resource(TimestepMode::Fixed {
            dt: tick.as_secs_f32(),
            substeps: 1,
        })
        .insert_resource(TimeUpdateStrategy::ManualDuration(tick))
        .add_plugins((
            TaskPoolPlugin::default(),
            TransformPlugin,
            TimePlugin,
            RapierPhysicsPlugin::<NoUserData>::default(),
        ));
    let corners: Vec<Vec3> = (0..8)
        .map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5)
        .map(|corner| corner * 0.5)
        .collect();
    let world = app.world_mut();
    world.spawn((
        Collider::cuboid(5.0, 0.5, 5.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
    ));
    let hull = world
        .spawn((
            RigidBody::Dynamic,
            Collider::convex_hull(&corners).expect("a cube is solid"),
            Transform::from_xyz(0.0, 3.0, 0.0),
        ))
        .id();
    app.finish();
    app.cleanup();
    (app, hull)
}
