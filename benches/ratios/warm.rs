//! Updates of manifolds that are kept from update to update, as rapier keeps them.

use std::hint::black_box;

use isa_gjk::{IsaGjkDispatcher, PreparedShapes};
use parry3d::math::{Pose, Vector};
use parry3d::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::pair::{
    FRAMES, GAPS, Manifolds, REST, SHAKEN, VERTICES, hull, trajectory, trembling, update,
};
use testkit::scenes::hulls;

use crate::in_turn;

/// One pair that moves by 2 mm and turns by 0.5° from update to update.
pub fn manifolds() {
    let plain = |shape: &SharedShape| shape.clone();
    let prepared = |shape: &SharedShape| PreparedShapes::default().prepare(shape);
    for (what, given) in [("plain hulls", plain as Given), ("`HullShape`s", prepared)] {
        println!("### Warm manifold updates, to ours {what}: ns, default → ours, ratio\n");
        println!("| vertices | separated | touching | shallow | deep |\n|---|---|---|---|---|");
        for vertices in VERTICES {
            let shapes = [hull(vertices, 1), hull(vertices, 2)];
            let our_shapes = shapes.each_ref().map(given);
            let row = GAPS.map(|(_, gap)| {
                let poses = trajectory(&shapes, gap, 1.0);
                let ours = IsaGjkDispatcher::default();
                in_turn(
                    FRAMES,
                    || update_along(&DefaultQueryDispatcher, &shapes, &poses),
                    || update_along(&ours, &our_shapes, &poses),
                )
            });
            println!("| {vertices} | {} |", row.join(" | "));
        }
        println!();
    }
}

/// The shape that our dispatcher is given for a plain hull.
type Given = fn(&SharedShape) -> SharedShape;

fn update_along(
    dispatcher: &impl PersistentQueryDispatcher,
    shapes: &[SharedShape; 2],
    poses: &[Pose],
) {
    let mut manifolds = Manifolds::default();
    for pose in poses {
        update(dispatcher, shapes, pose, &mut manifolds);
        black_box(&manifolds);
    }
}

/// The gaps of curved pairs, in metres.
const CURVED_GAPS: [(&str, f32); 4] = [
    ("apart by 30 cm", 0.3),
    ("near", 0.005),
    ("1 mm deep", -0.001),
    ("50 mm deep", -0.05),
];

/// Cylinders, cones, capsules and rounded cuboids, a metre high, in the same motion; and standing on the other shape, 1 mm deep, at rest or shaken.
pub fn curved() {
    let names = CURVED_GAPS.map(|(name, _)| name).join(" | ");
    println!("### Cylinders, cones and rounded shapes: ns, default → ours, ratio\n");
    println!("| pair | {names} | at rest | shaken |\n|---|---|---|---|---|---|---|");
    for (name, shapes) in curved_pairs() {
        let moving = CURVED_GAPS.map(|(_, gap)| trajectory(&shapes, gap, 1.0));
        let standing = [REST, SHAKEN].map(|tremble| trembling(0.999, tremble));
        let row = moving.iter().chain(&standing).map(|poses| {
            let ours = IsaGjkDispatcher::default();
            in_turn(
                FRAMES,
                || update_along(&DefaultQueryDispatcher, &shapes, poses),
                || update_along(&ours, &shapes, poses),
            )
        });
        println!("| {name} | {} |", row.collect::<Vec<_>>().join(" | "));
    }
    println!();
}

/// The second shape of each has a flat end, and the first one is a metre high, too.
fn curved_pairs() -> [(&'static str, [SharedShape; 2]); 14] {
    let cylinder = || SharedShape::cylinder(0.5, 0.4);
    let cone = || SharedShape::cone(0.5, 0.4);
    let cuboid = || SharedShape::cuboid(0.4, 0.5, 0.6);
    let round_cuboid = || SharedShape::round_cuboid(0.3, 0.4, 0.5, 0.1);
    let prism = || hulls::prism(24, 0.5, 0.5).expect("a prism");
    let corners = [[-2.0, 0.5, -2.0], [2.0, 0.5, -2.0], [0.0, 0.5, 2.0]];
    let [a, b, c] = corners.map(Vector::from);
    let triangle = || SharedShape::triangle(a, b, c);
    let capsule = || SharedShape::capsule_y(0.2, 0.3);
    [
        ("cuboid, cylinder", [cuboid(), cylinder()]),
        ("cylinder, cylinder", [cylinder(), cylinder()]),
        ("prism of 24 sides, cylinder", [prism(), cylinder()]),
        ("cuboid, cone", [cuboid(), cone()]),
        ("cylinder, cone", [cylinder(), cone()]),
        ("prism of 24 sides, cone", [prism(), cone()]),
        ("triangle, cylinder", [triangle(), cylinder()]),
        ("round cuboid, cylinder", [round_cuboid(), cylinder()]),
        ("capsule, cylinder", [capsule(), cylinder()]),
        ("capsule, cone", [capsule(), cone()]),
        ("cuboid, capsule", [cuboid(), capsule()]),
        ("triangle, capsule", [triangle(), capsule()]),
        ("cuboid, round cuboid", [cuboid(), round_cuboid()]),
        ("two round cuboids", [round_cuboid(), round_cuboid()]),
    ]
}
