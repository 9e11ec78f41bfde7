//! Small bodies on one hull of 500 m to 20 km: how many rest at the right height with rapier's default, and
//! how many with `isa-gjk`.

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::*;

const SIDES: usize = 48;
const THICKNESS: Real = 100.0;

fn main() {
    println!("width of the ground   default: right, asleep   isa-gjk: right, asleep   (of 6)");
    for width in [500.0, 2_000.0, 10_000.0, 20_000.0] {
        let default = rest_on(width, NarrowPhase::new());
        let ours = NarrowPhase::with_query_dispatcher(IsaGjkDispatcher::default());
        let ours = rest_on(width, ours);
        println!(
            "{width:>17} m   {:>14}, {:>6}   {:>14}, {:>6}",
            default[0], default[1], ours[0], ours[1]
        );
    }
}

/// How many bodies end at the right height, and how many asleep.
fn rest_on(width: Real, narrow_phase: NarrowPhase) -> [usize; 2] {
    let mut world = PhysicsWorld {
        narrow_phase,
        ..PhysicsWorld::default()
    };
    let disc = prism(0.5 * width, 0.5 * THICKNESS);
    let beneath = Vector::new(0.0, -0.5 * THICKNESS, 0.0);
    world.insert_collider(ColliderBuilder::new(disc).translation(beneath), None);

    // Each is half a metre high.
    let bodies = [
        SharedShape::cuboid(0.25, 0.25, 0.25),
        prism(0.3, 0.25),
        SharedShape::cylinder(0.25, 0.3),
        SharedShape::round_cylinder(0.2, 0.25, 0.05),
        SharedShape::cone(0.25, 0.3),
        SharedShape::capsule_x(0.3, 0.25),
    ];
    let bodies: Vec<_> = (0..)
        .zip(bodies)
        .map(|(i, shape)| {
            let place = Vector::new(0.1 * width + 2.0 * i as Real, 0.27, -0.05 * width);
            let body = RigidBodyBuilder::dynamic().translation(place);
            world.insert(body, ColliderBuilder::new(shape)).0
        })
        .collect();
    for _ in 0..300 {
        world.step();
    }
    let at_rest = bodies.iter().map(|body| &world.bodies[*body]);
    // A millimetre that rapier allows, and the spacing of f32 this far from the origin.
    let allowed = 2e-3 + width * f32::EPSILON;
    let is_right = |body: &&RigidBody| (body.translation().y - 0.25).abs() < allowed;
    [
        at_rest.clone().filter(is_right).count(),
        at_rest.filter(|body| body.is_sleeping()).count(),
    ]
}

/// Upright, as a hull.
fn prism(radius: Real, half_height: Real) -> SharedShape {
    let corners: Vec<_> = (0..2 * SIDES)
        .map(|i| {
            let angle = std::f32::consts::TAU * (i / 2) as Real / SIDES as Real;
            let y = if i % 2 == 0 {
                half_height
            } else {
                -half_height
            };
            Vector::new(radius * angle.cos(), y, radius * angle.sin())
        })
        .collect();
    SharedShape::convex_hull(&corners).expect("a solid")
}
