//! rapier's default dispatcher and ours, in turn: whatever else the machine does meanwhile, it does to both.
//! `cargo bench --bench ratios` prints medians over the turns, as tables.

use std::hint::black_box;
use std::time::Instant;

use isa_gjk::IsaGjkDispatcher;
use isa_gjk::PreparedShapes;
use oorandom::Rand32;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    DefaultQueryDispatcher, NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher,
    ShapeCastOptions,
};
use parry3d::shape::SharedShape;
use testkit::pair::{FRAMES, GAPS, Manifolds, VERTICES, hull, trajectory, update};

const TURNS: usize = 101;

/// Random poses of a pair: apart, touching and overlapping.
const POSES: usize = 64;

fn main() {
    warm_manifolds();
    scene_queries();
}

/// One pair that moves by 2 mm and turns by 0.5° from update to update.
fn warm_manifolds() {
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

fn scene_queries() {
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

fn vector(random: &mut Rand32) -> Vector {
    let mut coordinate = || 2.0 * random.rand_float() - 1.0;
    Vector::new(coordinate(), coordinate(), coordinate())
}

/// Nanoseconds of each call and the ratio, medians, when both make so many calls in turn.
fn in_turn(calls: usize, default: impl Fn(), ours: impl Fn()) -> String {
    let time = |work: &dyn Fn()| {
        let start = Instant::now();
        work();
        start.elapsed().as_nanos() as f64 / calls as f64
    };
    let turns: Vec<[f64; 2]> = (0..TURNS).map(|_| [time(&default), time(&ours)]).collect();
    let median = |of: fn(&[f64; 2]) -> f64| {
        let mut values: Vec<f64> = turns.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[TURNS / 2]
    };
    let [default, ours, ratio] = [median(|t| t[0]), median(|t| t[1]), median(|t| t[0] / t[1])];
    format!("{default:.0} → {ours:.0}, {ratio:.1}")
}
