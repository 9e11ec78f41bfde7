//! Manifolds of two capsules against distances found by searching along one of the cores.

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::shape::Capsule;
use testkit::memory::{Manifold, UpdateManifolds};
use testkit::oracle::distance_to_segment;

const PREDICTION: f32 = 0.02;
/// What f32 leaves of points and distances a metre in size.
const ROUNDING: f64 = 1e-6;

fn manifold(capsules: [&Capsule; 2], pose: &Pose) -> Manifold {
    let mut manifolds: Vec<Manifold> = Vec::new();
    let [first, second] = capsules;
    IsaGjkDispatcher::default()
        .update_manifolds(pose, [first, second], PREDICTION, &mut manifolds, &mut None)
        .expect("capsules are supported");
    manifolds.remove(0)
}

fn core(capsule: &Capsule, pose: &Pose) -> [DVec3; 2] {
    let q = pose.rotation.as_dquat().normalize();
    [capsule.segment.a, capsule.segment.b].map(|p| q * p.as_dvec3() + pose.translation.as_dvec3())
}

/// Golden-section search: the distance to a segment is convex along another one.
fn core_distance(first: [DVec3; 2], second: [DVec3; 2]) -> f64 {
    let at = |share: f64| distance_to_segment(first[0].lerp(first[1], share), second);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..200 {
        let (a, b) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
        if at(a) <= at(b) { high = b } else { low = a }
    }
    at(0.5 * (low + high)).min(at(0.0)).min(at(1.0))
}

fn capsule(rng: &mut oorandom::Rand32) -> Capsule {
    let mut axis = || Vector::from([(); 3].map(|()| rng.rand_float() - 0.5));
    let (a, b) = (axis(), axis());
    let b = if rng.rand_range(0..8) == 0 { a } else { b };
    Capsule::new(a, b, 0.05 + 0.3 * rng.rand_float())
}

#[test]
fn contacts_lie_on_both_surfaces_and_the_deepest_is_the_distance() {
    let mut rng = oorandom::Rand32::new(4);
    let mut touching = 0;
    for round in 0..20_000 {
        let capsules = [capsule(&mut rng), capsule(&mut rng)];
        let turn = if round % 3 == 0 { 1e-3 } else { 3.0 };
        let mut vector =
            |size: f32| Vector::from([(); 3].map(|()| size * (rng.rand_float() - 0.5)));
        let pose = Pose::from_parts(vector(1.4), Rotation::from_scaled_axis(vector(turn)));
        let [first, second] = [&capsules[0], &capsules[1]];
        let cores = [core(first, &Pose::IDENTITY), core(second, &pose)];
        let radii = f64::from(first.radius + second.radius);
        let distance = core_distance(cores[0], cores[1]) - radii;
        let manifold = manifold([first, second], &pose);
        if (distance - f64::from(PREDICTION)).abs() > ROUNDING {
            assert_eq!(
                manifold.points.is_empty(),
                distance > PREDICTION.into(),
                "{round}"
            );
        }
        let Some(deepest) = manifold.points.iter().map(|p| p.dist).reduce(f32::min) else {
            continue;
        };
        touching += 1;
        let off = f64::from(deepest) - distance;
        assert!(off.abs() < 1e-5 * radii + ROUNDING, "{round}: off by {off}");
        let normal = manifold.local_n1.as_dvec3();
        let q = pose.rotation.as_dquat();
        assert!((q * manifold.local_n2.as_dvec3() + normal).length() < ROUNDING);
        for point in &manifold.points {
            let p1 = point.local_p1.as_dvec3();
            let p2 = q * point.local_p2.as_dvec3() + pose.translation.as_dvec3();
            let beside = p2 - p1 - normal * f64::from(point.dist);
            assert!(beside.length() < 3.0 * ROUNDING, "{round}: beside {beside}");
            let heights = [
                distance_to_segment(p1, cores[0]),
                distance_to_segment(p2, cores[1]),
            ];
            for (height, radius) in heights.into_iter().zip([first.radius, second.radius]) {
                assert!(
                    (height - f64::from(radius)).abs() < 3.0 * ROUNDING,
                    "{round}"
                );
            }
        }
    }
    assert!(touching > 5_000, "only {touching} touched");
}

#[test]
fn both_orders_agree() {
    let mut rng = oorandom::Rand32::new(9);
    for round in 0..5_000 {
        let [first, second] = [capsule(&mut rng), capsule(&mut rng)];
        let mut vector =
            |size: f32| Vector::from([(); 3].map(|()| size * (rng.rand_float() - 0.5)));
        let pose = Pose::from_parts(vector(1.0), Rotation::from_scaled_axis(vector(3.0)));
        let one = manifold([&first, &second], &pose);
        let other = manifold([&second, &first], &pose.inverse());
        assert_eq!(one.points.len(), other.points.len(), "{round}");
        let least = |m: &Manifold| m.points.iter().map(|p| p.dist).fold(f32::MAX, f32::min);
        assert!((least(&one) - least(&other)).abs() < 3e-6, "{round}");
    }
}

/// Parallel, at any overlap, shifted along each other: the contacts span the part they share.
#[test]
fn side_by_side_they_touch_at_both_ends_of_the_common_part() {
    let log = Capsule::new_y(0.5, 0.1);
    for gap in [0.01_f32, 0.0, -1e-7, -0.01, -0.1] {
        for shift in [0.0_f32, 0.3, -0.7] {
            for yaw in [0.0_f32, 1e-5, 1e-3] {
                let turn = Rotation::from_rotation_x(yaw);
                let pose = Pose::from_parts(Vector::new(0.2 + gap, shift, 0.0), turn);
                let manifold = manifold([&log, &log], &pose);
                let places: Vec<f32> = manifold.points.iter().map(|p| p.local_p1.y).collect();
                let low = places.iter().copied().fold(f32::MAX, f32::min);
                let high = places.iter().copied().fold(f32::MIN, f32::max);
                let common = 1.0 - shift.abs();
                assert!(
                    high - low > 0.99 * common,
                    "{gap} {shift} {yaw}: {places:?}"
                );
                for point in &manifold.points {
                    assert!((point.dist - gap).abs() < 3e-6, "{gap} {shift} {yaw}");
                }
            }
        }
    }
}

#[test]
fn crossing_cores_and_balls_in_one_place_have_a_way_out() {
    let log = Capsule::new_y(0.5, 0.1);
    let ball = Capsule::new(Vector::ZERO, Vector::ZERO, 0.2);
    let across = Pose::from_parts(Vector::ZERO, Rotation::from_rotation_x(1.0));
    let along = Pose::from_parts(Vector::new(0.0, 0.2, 0.0), Rotation::IDENTITY);
    let cases = [
        (&log, &log, across, -0.2),
        (&log, &log, along, -0.2),
        (&log, &log, Pose::IDENTITY, -0.2),
        (&ball, &ball, Pose::IDENTITY, -0.4),
        (&log, &ball, along, -0.3),
    ];
    for (i, (first, second, pose, distance)) in cases.into_iter().enumerate() {
        let manifold = manifold([first, second], &pose);
        assert!((manifold.local_n1.length() - 1.0).abs() < 1e-6, "{i}");
        let deepest = manifold
            .points
            .iter()
            .map(|p| p.dist)
            .fold(f32::MAX, f32::min);
        assert!((deepest - distance).abs() < 1e-6, "{i}: {deepest}");
    }
}

#[test]
fn contacts_keep_their_data() {
    let log = Capsule::new_y(0.5, 0.1);
    let dispatcher = IsaGjkDispatcher::default();
    let mut manifolds: Vec<Manifold> = Vec::new();
    for step in 0..10_u32 {
        let turn = Rotation::from_rotation_x(1e-4 * step as f32);
        let pose = Pose::from_parts(Vector::new(0.199, 0.01 * step as f32, 0.0), turn);
        dispatcher
            .update_manifolds(&pose, [&log, &log], PREDICTION, &mut manifolds, &mut None)
            .expect("capsules are supported");
        let ends = manifolds[0]
            .points
            .iter_mut()
            .filter(|p| p.local_p1.y.abs() > 0.3);
        let mut count = 0;
        for point in ends {
            assert_eq!(point.data, step, "contacts of an end stay its own");
            point.data += 1;
            count += 1;
        }
        assert_eq!(count, 2);
    }
}
