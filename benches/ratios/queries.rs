//! Scene queries, which have no memory.

use std::hint::black_box;

use isa_gjk::IsaGjkDispatcher;
use oorandom::Rand32;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher, ShapeCastOptions,
};
use parry3d::shape::SharedShape;
use testkit::pair::hull;

use crate::{in_turn, vector};

/// Random poses of a pair: apart, touching and overlapping.
const POSES: usize = 64;

type Ask = fn(&dyn QueryDispatcher, &Pose, [&SharedShape; 2]);

const QUERIES: [(&str, Ask); 6] = [
    ("intersection_test", |d, pose, [a, b]| {
        black_box(d.intersection_test(pose, &**a, &**b)).ok();
    }),
    ("distance", |d, pose, [a, b]| {
        black_box(d.distance(pose, &**a, &**b)).ok();
    }),
    ("contact", |d, pose, [a, b]| {
        black_box(d.contact(pose, &**a, &**b, 0.1)).ok();
    }),
    ("closest_points", |d, pose, [a, b]| {
        black_box(d.closest_points(pose, &**a, &**b, 0.5)).ok();
    }),
    ("cast_shapes", |d, pose, [a, b]| {
        let from = Pose::from_parts(pose.translation * 3.0, pose.rotation);
        let options = ShapeCastOptions::default();
        black_box(d.cast_shapes(&from, -pose.translation, &**a, &**b, options)).ok();
    }),
    ("cast_shapes_nonlinear", |d, pose, [a, b]| {
        let still = NonlinearRigidMotion::identity();
        let from = Pose::from_parts(pose.translation * 3.0, pose.rotation);
        let velocity = -pose.translation * 3.0;
        let moving = NonlinearRigidMotion::new(from, Vector::ZERO, velocity, Vector::X);
        let hit = d.cast_shapes_nonlinear(&still, &**a, &moving, &**b, 0.0, 1.0, true);
        black_box(hit).ok();
    }),
];

pub fn scene() {
    let random = &mut Rand32::new(7);
    let poses: [Pose; POSES] = [(); POSES].map(|()| {
        let place = vector(random) * 2.5;
        Pose::new(place, vector(random) * 3.0)
    });
    for vertices in [8, 24, 60, 300] {
        let hull = |seed| hull(vertices, seed);
        let first = hull(1);
        let part = |x: Real, seed| (Pose::translation(x, 0.0, 0.0), hull(seed));
        let others = [
            ("hull", hull(2)),
            (
                "compound",
                SharedShape::compound(vec![part(-0.7, 2), part(0.7, 3)]),
            ),
            ("cuboid", SharedShape::cuboid(0.5, 0.6, 0.7)),
            ("ball", SharedShape::ball(0.5)),
            ("half-space", SharedShape::halfspace(Vector::Y)),
            ("cylinder", SharedShape::cylinder(0.5, 0.4)),
        ];
        let names = others.each_ref().map(|other| other.0).join(" | ");
        println!(
            "\n### Scene queries of a hull of {vertices} vertices: ns, default → ours, ratio\n"
        );
        println!("| query | {names} |\n|---|---|---|---|---|---|---|");
        let ours = IsaGjkDispatcher::default();
        for (query, ask) in QUERIES {
            let row = others.each_ref().map(|(_, other)| {
                let pair = [&first, other];
                let all = |d: &dyn QueryDispatcher| poses.iter().for_each(|p| ask(d, p, pair));
                in_turn(POSES, || all(&DefaultQueryDispatcher), || all(&ours))
            });
            println!("| `{query}` | {} |", row.join(" | "));
        }
    }
}
