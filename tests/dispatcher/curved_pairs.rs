//! Cylinders and cones with each other and with everything else, against the oracle: signed distances, normals,
//! and the gap at each contact, without a past and with one, in either order.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::Vector;
use testkit::curved::{Body, Judge, Meeting};
use testkit::generate::Rng;
use testkit::memory::Memory;
use testkit::pair::{FRAMES, PREDICTION, trajectory};
use testkit::pose::ExactPose;

use crate::rounded_pairs::{capsule, triangle};
use crate::tally::{GAPS, Tally};

/// The promise, as a share of the smaller diameter.
const PROMISE: f64 = 1e-5;

fn curved(rng: &mut Rng, border: f32) -> Vec<Body> {
    let sizes = [(0.5, 0.4), (0.05, 0.6), (1.5, 0.1)];
    let (h, r) = sizes[rng.count(0, 2)];
    vec![Body::cylinder(h, r, border), Body::cone(h, r, border)]
}

fn partners(rng: &mut Rng, border: f32) -> Vec<Body> {
    let triangle = triangle(rng, border);
    let capsule = capsule(rng);
    let points: Vec<Vector> = (0..20).map(|_| rng.direction().as_vec3() * 0.7).collect();
    let mut bodies = curved(rng, border);
    bodies.extend([
        Body::cuboid(Vector::new(0.4, 0.3, 0.8), border),
        triangle,
        capsule,
        Body::hull(&points, border).expect("a solid"),
        Body::ball(0.25),
        Body::half_space(Vector::Y),
    ]);
    bodies
}

fn check(border: f32, seed: u128) {
    let mut rng = Rng::new(seed);
    let mut tally = Tally::new(|faults| faults.are_within(PROMISE));
    for _ in 0..2 {
        for first in curved(&mut rng, border) {
            for second in partners(&mut rng, border) {
                tally.add(&mut rng, [&second, &first], &Meeting::ALL, &GAPS);
            }
        }
    }
    tally.check();
}

#[test]
fn sharp_pairs_are_right() {
    check(0.0, 331);
}

#[test]
fn rounded_pairs_are_right() {
    check(0.07, 332);
}

/// Cores that overlapped in the last frame may be far apart within their borders in the next.
#[test]
fn cores_that_jump_apart_are_right() {
    let mut rng = Rng::new(333);
    let dispatcher = IsaGjkDispatcher::default();
    let mut jumps = 0;
    for _ in 0..12 {
        for first in curved(&mut rng, 0.0) {
            for second in partners(&mut rng, 2.0) {
                let bodies = [&second, &first];
                let size = first.diameter().min(second.diameter());
                let shapes = bodies.map(|body| &body.shape);
                for meeting in [Meeting::Random, Meeting::Parallel, Meeting::Flat] {
                    let deep = Meeting::Concentric.pose(&mut rng, bodies, 0.0);
                    let touching = meeting.pose(&mut rng, bodies, -1e-3 * size);
                    let (Some(deep), Some(touching)) = (deep, touching) else {
                        continue;
                    };
                    let mut memory = Memory::default();
                    memory.update(&dispatcher, &deep.to_f32(), shapes, 0.0);
                    let found = memory.update(&dispatcher, &touching.to_f32(), shapes, 0.0);
                    let faults = Judge::new(bodies, touching).manifold(found, 0.0);
                    assert!(faults.are_within(PROMISE), "{}: {faults:?}", second.name);
                    jumps += 1;
                }
            }
        }
    }
    assert!(jumps > 200, "only {jumps} jumps");
}

/// Checks every tenth answer along a trajectory, beside the contacts that stay. Returns the dispatcher.
fn follow(bodies: [&Body; 2], gap: f32) -> IsaGjkDispatcher {
    let shapes = bodies.map(|body| body.shape.clone());
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    for (frame, pose) in trajectory(&shapes, gap, 1.0).iter().enumerate() {
        let [a, b] = &shapes;
        let manifold = memory.update(&dispatcher, pose, [a, b], PREDICTION);
        if frame % 10 == 0 {
            let exact = ExactPose {
                rotation: pose.rotation.as_dquat().normalize(),
                translation: pose.translation.as_dvec3(),
            };
            let judge = Judge::new(bodies, exact);
            let mut faults = judge.manifold(manifold, PREDICTION.into());
            faults.gap = 0.0;
            assert!(faults.are_within(PROMISE), "{gap}, {frame}: {faults:?}");
        }
    }
    dispatcher
}

/// A closed form finds the place of the segment. General methods took twice as long as the default.
#[test]
fn capsules_need_no_search() {
    let capsule = Body::capsule([-0.2, 0.2].map(|y| Vector::Y * y), 0.3);
    for curved in [Body::cylinder(0.5, 0.4, 0.0), Body::cone(0.5, 0.4, 0.05)] {
        for gap in [0.005, -0.001, -0.05] {
            let stats = follow([&capsule, &curved], gap).stats();
            assert_eq!(stats.iterations, 0, "{} at {gap}", curved.name);
            let updates = FRAMES as u64;
            assert!(stats.supports < 2 * updates, "{} at {gap}", curved.name);
        }
    }
}

/// Where a rim crosses an edge, no patch proves the depth. EPA took four times as long as the whole update.
#[test]
fn a_rim_across_an_edge_proves_its_depth_without_a_search() {
    let bodies = [
        Body::cuboid(Vector::new(0.4, 0.5, 0.6), 0.0),
        Body::cylinder(0.5, 0.4, 0.0),
    ];
    for gap in [-0.001, -0.02, -0.05] {
        let stats = follow([&bodies[0], &bodies[1]], gap).stats();
        let searches = stats.answered[Stage::WarmEpa as usize];
        assert!(searches < 10, "{searches} searches at {gap}");
    }
}
