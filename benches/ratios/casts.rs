//! Casts of shapes that turn.

use std::hint::black_box;

use isa_gjk::IsaGjkDispatcher;
use oorandom::Rand32;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::pair::hull;

use crate::{in_turn, vector};

const CASTS: usize = 200;
/// Metres from one shape to the other at the start.
const START: Real = 2.5;
/// The greatest angle by which the second shape turns along each axis, in radians.
const SPIN: Real = 8.0;

/// From random places towards a shape, with a random spin.
pub fn nonlinear() {
    let random = &mut Rand32::new(7);
    let still = NonlinearRigidMotion::identity();
    let motions: Vec<_> = (0..CASTS)
        .map(|_| {
            let from = START * vector(random).normalize();
            let start = Pose::new(from, 3.0 * vector(random));
            let towards = 0.2 * vector(random) - from;
            NonlinearRigidMotion::new(start, Vector::ZERO, towards, SPIN * vector(random))
        })
        .collect();
    let cylinder = SharedShape::cylinder(0.5, 0.4);
    let cuboid = SharedShape::cuboid(0.5, 0.6, 0.7);
    let cone = SharedShape::cone(0.5, 0.4);
    let pairs = [
        ("hulls of 8", hull(8, 1), hull(8, 2)),
        ("hulls of 24", hull(24, 1), hull(24, 2)),
        ("hulls of 60", hull(60, 1), hull(60, 2)),
        ("hulls of 300", hull(300, 1), hull(300, 2)),
        ("hull of 24, cuboid", hull(24, 1), cuboid.clone()),
        ("hull of 24, ball", hull(24, 1), SharedShape::ball(0.5)),
        ("hull of 24, cylinder", hull(24, 1), cylinder.clone()),
        ("cylinder, cuboid", cylinder, cuboid.clone()),
        (
            "capsule, cuboid",
            SharedShape::capsule_y(0.5, 0.3),
            cuboid.clone(),
        ),
        ("cones", cone.clone(), cone),
        ("cuboids", cuboid.clone(), cuboid),
    ];
    println!("\n### Nonlinear casts: ns, default → ours, ratio\n\n| pair | |\n|---|---|");
    let ours = IsaGjkDispatcher::default();
    for (name, a, b) in pairs {
        let all = |dispatcher: &dyn QueryDispatcher| {
            for motion in &motions {
                let hit =
                    dispatcher.cast_shapes_nonlinear(&still, &*a, motion, &*b, 0.0, 1.0, true);
                black_box(hit).ok();
            }
        };
        let ratio = in_turn(CASTS, || all(&DefaultQueryDispatcher), || all(&ours));
        println!("| {name} | {ratio} |");
    }
}
