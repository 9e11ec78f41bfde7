//! Small bodies on one hull of 500 m to 20 km. With rapier's default, 22 of the 48 hulls stay awake, all of
//! them on the disc, and stand up to 24 mm too low.

use rapier3d::prelude::*;
use testkit::scenes::hulls;
use testkit::world::ours;

/// Steps until everything must sleep.
const STEPS: usize = 240;
/// Metres between places in f32, relative to the distance from the origin.
const SPACING: Real = f32::EPSILON;

fn cuboid(half: Vector) -> SharedShape {
    hulls::cuboid(half).expect("a solid")
}

fn prism(sides: u32, radius: Real, half_height: Real) -> SharedShape {
    hulls::prism(sides, radius, half_height).expect("a solid")
}

/// A box, or a disc of many sides, whose top is half of this thickness above its origin.
const THICKNESS: Real = 100.0;
fn grounds(half_width: Real) -> [SharedShape; 2] {
    let half_height = 0.5 * THICKNESS;
    [
        cuboid(Vector::new(half_width, half_height, half_width)),
        prism(48, half_width, half_height),
    ]
}

/// A body, with what is over its origin where it stands or lies, and how it is turned.
struct Body {
    name: &'static str,
    shape: SharedShape,
    height: Real,
    rotation: Vector,
}

const UPRIGHT: Vector = Vector::ZERO;
const ON_ITS_SIDE: Vector = Vector::new(std::f32::consts::FRAC_PI_2, 0.0, 0.0);

impl Body {
    fn new(name: &'static str, shape: SharedShape, height: Real, rotation: Vector) -> Self {
        Self {
            name,
            shape,
            height,
            rotation,
        }
    }
}

struct Landed {
    height: Real,
    tilt: Real,
    slid: Real,
    asleep: bool,
}

/// Drops a body from 2 cm above the ground, at this share of the way to the ground's side.
fn land(ground: &SharedShape, half_width: Real, share: Real, body: &Body) -> Landed {
    let mut world = PhysicsWorld {
        narrow_phase: ours(),
        ..PhysicsWorld::default()
    };
    let place = Vector::new(0.0, -0.5 * THICKNESS, 0.0);
    world.insert_collider(
        ColliderBuilder::new(ground.clone()).translation(place),
        None,
    );
    let drop = body.height + 0.02;
    let start = Vector::new(share * half_width, drop, -0.5 * share * half_width);
    let dynamic = RigidBodyBuilder::dynamic()
        .translation(start)
        .rotation(body.rotation);
    let (handle, _) = world.insert(dynamic, ColliderBuilder::new(body.shape.clone()));
    let axis = |world: &PhysicsWorld| world.bodies[handle].rotation() * Vector::Y;
    let axis_at_start = axis(&world);
    for _ in 0..STEPS {
        world.step();
    }
    let tilt = axis(&world).angle_between(axis_at_start);
    let body = &world.bodies[handle];
    let end = body.translation();
    Landed {
        height: end.y,
        tilt,
        slid: (end - start).with_y(0.0).length(),
        asleep: body.is_sleeping(),
    }
}

fn assert_all_land(bodies: &[Body]) {
    for half_width in [250.0, 1_000.0, 5_000.0, 10_000.0] {
        for (ground, shape) in grounds(half_width).iter().enumerate() {
            for share in [0.0, 0.1, 0.45] {
                for body in bodies {
                    let landed = land(shape, half_width, share, body);
                    let name = body.name;
                    let what = format!("{name} at {share} of ground {ground} of {half_width} m");
                    // Rapier keeps contacts a millimetre deep, and places have their spacing.
                    let allowed = 2e-3 + 2.0 * SPACING * half_width;
                    assert!(
                        (landed.height - body.height).abs() < allowed,
                        "{what}: at {} m",
                        landed.height
                    );
                    assert!(landed.tilt < 0.01, "{what}: tilted by {}", landed.tilt);
                    assert!(landed.slid < 0.02, "{what}: slid {} m", landed.slid);
                    assert!(landed.asleep, "{what}: awake");
                }
            }
        }
    }
}

#[test]
fn hulls_land_and_sleep_on_grounds_of_kilometres() {
    assert_all_land(&[
        Body::new("cube", cuboid(Vector::splat(0.25)), 0.25, UPRIGHT),
        Body::new("prism", prism(12, 0.3, 0.25), 0.25, UPRIGHT),
    ]);
}

#[test]
fn curved_bodies_land_and_sleep_on_grounds_of_kilometres() {
    let cylinder = SharedShape::cylinder(0.25, 0.3);
    let round = SharedShape::round_cylinder(0.2, 0.25, 0.05);
    let cone = SharedShape::cone(0.25, 0.3);
    let capsule = SharedShape::capsule_y(0.3, 0.25);
    assert_all_land(&[
        Body::new("cylinder", cylinder.clone(), 0.25, UPRIGHT),
        Body::new("cylinder on its side", cylinder, 0.3, ON_ITS_SIDE),
        Body::new("round cylinder", round, 0.25, UPRIGHT),
        Body::new("cone", cone, 0.25, UPRIGHT),
        Body::new("capsule on its side", capsule, 0.25, ON_ITS_SIDE),
    ]);
}
