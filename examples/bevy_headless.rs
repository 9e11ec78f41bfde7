//! 500 hulls stirred in a box, in two Bevy worlds without a window: one with rapier's own narrow
//! phase and one with `isa-gjk`. The two take turns in blocks of frames, so that whatever else the
//! machine does meets both: `cargo run --release --features bevy --example bevy_headless`.

use std::f32::consts::PI;
use std::time::Instant;

use bevy_ecs::prelude::*;
use isa_gjk::Stage;
use isa_gjk::bevy::{
    Collider, NarrowPhaseStats, PhysicsContext, PhysicsSystems, PhysicsTransform, RigidBody,
    install,
};
use oorandom::Rand32;
use rapier3d::prelude::*;

const HULLS: usize = 500;
const VERTICES: usize = 100;
/// How many hulls are different.
const SHAPES: usize = 16;
/// Hulls along a side of the box, and the distance between them, in metres.
const SIDE: usize = 8;
const SPACING: Real = 1.1;
/// Frames in a block, of which the first finds the other world's data in the caches and does not
/// count; and blocks before and after counting begins.
const BLOCK: usize = 8;
const WARM_UP: usize = 8;
const BLOCKS: usize = 40;

#[derive(Component)]
struct Paddle;

struct Simulation {
    world: World,
    schedule: Schedule,
    /// Milliseconds of each counted frame: all of the schedule, and the narrow phase in it.
    times: [Vec<f64>; 2],
}

fn main() {
    let default = PhysicsContext::with_default_narrow_phase();
    let mut simulations = [default, PhysicsContext::default()].map(Simulation::new);
    for block in 0..WARM_UP + BLOCKS {
        for simulation in &mut simulations {
            for frame in 0..BLOCK {
                simulation.frame(block >= WARM_UP && frame > 0);
            }
        }
    }

    println!("{HULLS} hulls of {VERTICES} vertices, median per frame");
    println!(
        "{:16} {:>10} {:>10} {:>6}",
        "", "default", "isa-gjk", "ratio"
    );
    for (i, name) in ["frame ms", "narrow phase ms"].into_iter().enumerate() {
        let [default, ours] = simulations.each_mut().map(|s| median(&mut s.times[i]));
        println!(
            "{name:16} {default:10.3} {ours:10.3} {:6.2}",
            default / ours
        );
    }
    let [default, ours] = simulations.each_ref().map(|s| {
        s.world
            .resource::<PhysicsContext>()
            .world
            .contact_pairs()
            .count()
    });
    println!("{:16} {default:10} {ours:10}\n", "pairs at the end");

    let stats = simulations[1].world.resource::<NarrowPhaseStats>().total;
    println!("{} queries of isa-gjk, answered by", stats.queries());
    for stage in Stage::ALL {
        let share = stats.answered[stage as usize] as f64 / stats.queries() as f64;
        println!("{:16} {:10.1} %", stage.name(), 100.0 * share);
    }
}

impl Simulation {
    fn new(context: PhysicsContext) -> Self {
        let (mut world, mut schedule) = (World::new(), Schedule::default());
        world.insert_resource(context);
        install(&mut world, &mut schedule);
        schedule.add_systems(stir.before(PhysicsSystems::SyncBackend));
        spawn_box(&mut world);
        spawn_hulls(&mut world);
        Self {
            world,
            schedule,
            times: Default::default(),
        }
    }

    fn frame(&mut self, counted: bool) {
        let start = Instant::now();
        self.schedule.run(&mut self.world);
        let frame = start.elapsed().as_secs_f64() * 1e3;
        if counted {
            let context = self.world.resource::<PhysicsContext>();
            let counters = &context.world.physics_pipeline.counters;
            self.times[0].push(frame);
            self.times[1].push(counters.narrow_phase_time_ms());
        }
    }
}

/// Turns the paddle by two radians a second.
fn stir(context: Res<PhysicsContext>, mut paddles: Query<&mut PhysicsTransform, With<Paddle>>) {
    let turn = Rotation::from_rotation_y(2.0 * context.world.integration_parameters.dt);
    for mut transform in &mut paddles {
        transform.rotation = (turn * transform.rotation).normalize();
    }
}

/// A floor, four walls, and a paddle to stir with.
fn spawn_box(world: &mut World) {
    let half = SPACING * (SIDE as Real / 2.0 + 0.5);
    let floor = ColliderBuilder::cuboid(half + 1.0, 0.5, half + 1.0);
    world.spawn((
        Collider(floor),
        RigidBody::fixed(),
        PhysicsTransform::from_xyz(0.0, -0.5, 0.0),
    ));
    for quarter in 0..4 {
        let turn = Rotation::from_rotation_y(PI / 2.0 * quarter as Real);
        let wall = Pose::from_parts(turn * Vector::new(half + 0.5, 8.0, 0.0), turn);
        world.spawn((
            Collider(ColliderBuilder::cuboid(0.5, 8.0, half + 1.0)),
            RigidBody::fixed(),
            PhysicsTransform::from(wall),
        ));
    }
    world.spawn((
        Collider(ColliderBuilder::cuboid(half - 0.1, 0.4, 0.2)),
        RigidBody(RigidBodyBuilder::kinematic_position_based()),
        PhysicsTransform::from_xyz(0.0, 0.4, 0.0),
        Paddle,
    ));
}

/// Layers of hulls above the paddle.
fn spawn_hulls(world: &mut World) {
    let mut random = Rand32::new(1);
    let shapes: Vec<_> = (0..SHAPES).map(|_| random_hull(&mut random)).collect();
    let along = |step: usize| (step as Real - (SIDE - 1) as Real / 2.0) * SPACING;
    for i in 0..HULLS {
        let layer = (i / (SIDE * SIDE)) as Real;
        let (x, z) = (along(i % SIDE), along(i / SIDE % SIDE));
        world.spawn((
            Collider::from(shapes[i % SHAPES].clone()),
            PhysicsTransform::from_xyz(x, 1.5 + layer * SPACING, z),
        ));
    }
}

/// The hull of points on a sphere of half a metre.
fn random_hull(random: &mut Rand32) -> SharedShape {
    let mut within = || 2.0 * random.rand_float() - 1.0;
    let points: Vec<_> = (0..VERTICES)
        .map(|_| Vector::new(within(), within(), within()).normalize_or(Vector::Y) * 0.5)
        .collect();
    SharedShape::convex_hull(&points).expect("points on a sphere have a solid hull")
}

fn median(times: &mut [f64]) -> f64 {
    let middle = times.len() / 2;
    *times.select_nth_unstable_by(middle, f64::total_cmp).1
}
