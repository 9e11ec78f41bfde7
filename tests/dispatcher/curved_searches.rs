//! Pairs of cylinders and cones in motion whose pieces of surface prove the depth, so that nothing is searched.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Rotation, Vector};
use testkit::curved::{Body, Judge};
use testkit::generate::Rng;
use testkit::memory::Memory;
use testkit::pair::PREDICTION;
use testkit::pose::ExactPose;

/// The promise, as a share of the smaller diameter.
const PROMISE: f64 = 1e-5;
const UPDATES: usize = 40;

/// Updates a pair at these poses, checks the answers, and counts the searches after the first one.
fn searches(bodies: [&Body; 2], mut pose: impl FnMut(usize) -> Pose) -> u64 {
    let [a, b] = bodies.map(|body| body.shape.clone());
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    for update in 0..UPDATES {
        let pose = pose(update);
        let manifold = memory.update(&dispatcher, &pose, [&a, &b], PREDICTION);
        let exact = ExactPose {
            rotation: pose.rotation.as_dquat().normalize(),
            translation: pose.translation.as_dvec3(),
        };
        let mut faults = Judge::new(bodies, exact).manifold(manifold, PREDICTION.into());
        // Contacts that stay may be beside each other.
        faults.gap = 0.0;
        assert!(faults.are_within(PROMISE), "{update}: {faults:?}");
    }
    let answered = dispatcher.stats().answered;
    answered[Stage::WarmEpa as usize] + answered[Stage::WarmGjk as usize]
}

/// Poses that tremble by hundredths around one at which a body touches `place` with its point `at`, and reaches `depth`
/// far beneath it, against the normal `out`.
fn around(
    (place, out, depth): (Vector, Vector, f32),
    (at, turn): (Vector, Rotation),
) -> impl FnMut(usize) -> Pose {
    let mut rng = Rng::new(3);
    let still = place - out * depth - turn * at;
    move |_| {
        let mut noise = || (rng.direction() * 5e-3).as_vec3();
        let tremble = Rotation::from_scaled_axis(noise());
        Pose::from_parts(still + noise(), tremble * turn)
    }
}

/// The discs in both rims bend enough (T18). EPA took ten times as long as the whole update.
#[test]
fn rims_that_cross_need_no_search() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let out = Vector::new(half, half, 0.0);
    // Its cap faces down towards the other, as its side does, so that the rims cross at a right angle.
    let turn = Rotation::from_rotation_arc(Vector::Y, (Vector::Z - out) * half);
    let lowest = turn.inverse() * (-(out + Vector::Z) * half * 0.4);
    let bodies = [Body::cylinder(0.5, 0.4, 0.0), Body::cylinder(0.5, 0.4, 0.0)];
    for depth in [0.02, 0.05] {
        let place = (Vector::new(0.4, 0.5, 0.0), out, depth);
        let found = searches(
            [&bodies[0], &bodies[1]],
            around(place, (lowest + Vector::Y * 0.5, turn)),
        );
        assert_eq!(found, 0, "{depth} deep");
    }
}

/// The line is deeper in the other body than any ball that touches it from within the log.
#[test]
fn a_thin_log_deep_under_a_rim_needs_no_search() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let out = Vector::new(half, half, 0.0);
    let along = (Vector::new(half, -half, 0.0) + Vector::Z) * half;
    let turn = Rotation::from_rotation_arc(Vector::Y, along);
    let lowest = turn.inverse() * (-out * 0.1);
    let bodies = [Body::cylinder(0.5, 1.0, 0.0), Body::cylinder(1.0, 0.1, 0.0)];
    let place = (Vector::new(1.0, 0.5, 0.0), out, 0.15);
    let found = searches([&bodies[0], &bodies[1]], around(place, (lowest, turn)));
    assert_eq!(found, 0);
}

/// The normal turns by more than it mostly does from frame to frame. Its ruled sides are tried before a search.
#[test]
fn logs_that_tumble_need_few_searches() {
    let bodies = [Body::cylinder(0.5, 0.2, 0.0), Body::cylinder(0.5, 0.2, 0.0)];
    let across = Rotation::from_rotation_x(1.2);
    let found = searches([&bodies[0], &bodies[1]], |update| {
        let angle = 0.15 * update as f32;
        let around = Rotation::from_rotation_y(angle);
        Pose::from_parts(around * Vector::X * 0.37, around * across)
    });
    assert!(found <= 2, "{found} searches");
}
