//! Cylinders and cones at rest: lying cones, towers of coins and of barrels.

use rapier3d::prelude::*;

fn ours() -> PhysicsWorld {
    PhysicsWorld {
        narrow_phase: testkit::world::ours(),
        ..PhysicsWorld::default()
    }
}

fn with_ground(mut world: PhysicsWorld) -> PhysicsWorld {
    let ground = ColliderBuilder::cuboid(20.0, 0.5, 20.0).translation(Vector::new(0.0, -0.5, 0.0));
    world.insert_collider(ground, None);
    world
}

fn deepest(world: &PhysicsWorld) -> Real {
    let pairs = world.narrow_phase.contact_pairs();
    let points = pairs
        .flat_map(|pair| pair.manifolds())
        .flat_map(|manifold| &manifold.points);
    -points.map(|point| point.dist).fold(0.0, Real::min)
}

/// Sixteen cones dropped on their sides: how many sleep after `steps`, and the deepest overlap.
fn lying_cones(world: PhysicsWorld, steps: usize) -> (usize, Real) {
    let mut world = with_ground(world);
    let (half_height, radius): (Real, Real) = (0.25, 0.15);
    let tilt = (0.5 * radius / half_height).atan();
    let bodies: Vec<_> = (0..16)
        .map(|i| {
            let place = Vector::new((i % 4) as Real, 0.2, (i / 4) as Real);
            let lying = Rotation::from_rotation_z(std::f32::consts::FRAC_PI_2 + tilt);
            let pose = Pose::from_parts(place, Rotation::from_rotation_y(0.7 * i as Real) * lying);
            let body = RigidBodyBuilder::dynamic().pose(pose);
            world
                .insert(body, ColliderBuilder::cone(half_height, radius))
                .0
        })
        .collect();
    for _ in 0..steps {
        world.step();
    }
    let asleep = bodies
        .iter()
        .filter(|&&body| world.bodies[body].is_sleeping());
    (asleep.count(), deepest(&world))
}

#[test]
fn cones_on_their_sides_come_to_rest() {
    let (asleep, overlap) = lying_cones(ours(), 100);
    let (by_default, default_overlap) = lying_cones(PhysicsWorld::default(), 100);
    println!("{asleep} {overlap}, default {by_default} {default_overlap}");
    assert_eq!(asleep, 16);
    assert!(overlap <= 1e-3, "they overlap by {overlap}");
    assert!(by_default < 16);
}

/// What became of towers.
#[derive(Debug)]
struct Towers {
    /// The largest angle of an axis to the vertical, in degrees.
    tilt: Real,
    /// How far one moved sideways.
    moved: Real,
    overlap: Real,
}

/// Four towers of so many cylinders.
fn towers(world: PhysicsWorld, height: usize, (half_height, radius): (Real, Real)) -> Towers {
    let mut world = with_ground(world);
    let mut bodies = Vec::new();
    for tower in 0..4 {
        for i in 0..height {
            let y = half_height * (2 * i + 1) as Real;
            let place = Vector::new(2.0 * tower as Real, y, 0.0);
            let turn = Rotation::from_rotation_y(0.3 * (i * (tower + 1)) as Real);
            let body = RigidBodyBuilder::dynamic().pose(Pose::from_parts(place, turn));
            let (body, _) = world.insert(body, ColliderBuilder::cylinder(half_height, radius));
            bodies.push((body, place));
        }
    }
    for _ in 0..600 {
        world.step();
    }
    let mut found = Towers {
        tilt: 0.0,
        moved: 0.0,
        overlap: deepest(&world),
    };
    for (body, place) in bodies {
        let pose = world.bodies[body].position();
        let up = (pose.rotation * Vector::Y).y.clamp(-1.0, 1.0);
        let way = pose.translation - place;
        found.tilt = found.tilt.max(up.acos().to_degrees());
        found.moved = found.moved.max(way.x.hypot(way.z));
    }
    found
}

#[test]
fn towers_stand() {
    // Coins, barrels, tall barrels.
    let cases = [
        (16, (0.05, 0.5), [0.25, 3e-3, 11e-3]),
        (8, (0.5, 0.4), [0.1, 6e-3, 11e-3]),
        (8, (0.8, 0.4), [0.15, 12e-3, 11e-3]),
    ];
    for (height, size, [tilt, moved, overlap]) in cases {
        let found = towers(ours(), height, size);
        let default = towers(PhysicsWorld::default(), height, size);
        println!("{found:?}, default {default:?}");
        let is_within = found.tilt <= tilt && found.moved <= moved && found.overlap <= overlap;
        assert!(is_within, "{size:?}: {found:?}");
        assert!(found.moved < 0.1 * default.moved, "{size:?}: {found:?}");
    }
}
