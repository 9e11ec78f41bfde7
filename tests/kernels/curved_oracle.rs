//! The oracle of curved bodies is held against closed forms, and against that of polyhedra.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use parry3d::math::{Real, Vector};
use testkit::curved::{Body, Difference, Judge, Meeting, SignedDistance};
use testkit::generate::Rng;
use testkit::oracle;
use testkit::pose::ExactPose;

/// Of the sizes of both.
const TOLERANCE: f64 = 1.0e-9;

fn pose(rotation: DQuat, translation: DVec3) -> ExactPose {
    ExactPose {
        rotation,
        translation,
    }
}

fn signed_distance(bodies: [&Body; 2], pose: ExactPose) -> SignedDistance {
    Difference::new(bodies, pose).signed_distance()
}

fn assert_found(bodies: [&Body; 2], pose: ExactPose, exact: f64) {
    let found = signed_distance(bodies, pose);
    let slack = TOLERANCE * (bodies[0].diameter() + bodies[1].diameter() + exact.abs());
    let names = bodies.map(|body| &body.name);
    assert!(
        found.lower <= exact + slack && exact <= found.upper + slack,
        "{names:?} in {pose:?}: {found:?} for {exact}"
    );
    // Rings of equal depths are left half open.
    assert!(
        found.upper - found.lower < 1.0e-6,
        "{names:?} in {pose:?}: {found:?}"
    );
}

fn size(rng: &mut Rng) -> (Real, Real) {
    let length = |rng: &mut Rng| 10_f64.powf(rng.range(-1.5, 0.3)) as Real;
    (length(rng), length(rng))
}

#[test]
fn balls_are_as_far_as_their_centres_tell() {
    let mut rng = Rng::new(1);
    for i in 0..400 {
        let (h, r) = size(&mut rng);
        let radius = rng.range(0.05, 1.0) as Real;
        let body = if i % 2 == 0 {
            Body::cylinder(h, r, 0.0)
        } else {
            Body::cone(h, r, 0.0)
        };
        let centre = rng.direction() * rng.range(0.0, 1.5);
        let exact = body.outside(centre) - f64::from(radius);
        let pose = pose(rng.rotation(), centre);
        let ball = Body::ball(radius);
        assert_found([&body, &ball], pose, exact);
        assert_found([&ball, &body], pose.inverse(), exact);
    }
}

#[test]
fn parallel_cylinders_are_apart_across_or_along() {
    let mut rng = Rng::new(2);
    for i in 0..200 {
        let [(h1, r1), (h2, r2)] = [size(&mut rng), size(&mut rng)];
        let across = if i % 4 == 0 { 0.0 } else { rng.range(0.0, 1.5) };
        let along = if i % 8 == 0 {
            0.0
        } else {
            rng.range(-1.5, 1.5)
        };
        let turn = rng.range(0.0, TAU);
        let place = DVec3::new(across * turn.cos(), along, across * turn.sin());
        let [p, q] = [
            across - f64::from(r1) - f64::from(r2),
            along.abs() - f64::from(h1) - f64::from(h2),
        ];
        let exact = if p > 0.0 && q > 0.0 {
            p.hypot(q)
        } else {
            p.max(q)
        };
        let pose = pose(DQuat::from_rotation_y(rng.range(0.0, TAU)), place);
        let [a, b] = [Body::cylinder(h1, r1, 0.0), Body::cylinder(h2, r2, 0.0)];
        assert_found([&a, &b], pose, exact);
    }
}

#[test]
fn crossing_cylinders_are_apart_across_both_axes() {
    let mut rng = Rng::new(3);
    for _ in 0..200 {
        let [r1, r2] = [0.0; 2].map(|_| rng.range(0.1, 0.4) as Real);
        // So long that no cap is near.
        let [a, b] = [r1, r2].map(|r| Body::cylinder(8.0, r, 0.0));
        let rotation = DQuat::from_axis_angle(DVec3::X, rng.range(0.8, 2.3));
        let distance = rng.range(0.0, 1.5);
        let axis_2 = rotation * DVec3::Y;
        let place =
            DVec3::X * distance + DVec3::Y * rng.range(-1.0, 1.0) + axis_2 * rng.range(-1.0, 1.0);
        assert_found(
            [&a, &b],
            pose(rotation, place),
            distance - f64::from(r1) - f64::from(r2),
        );
    }
}

#[test]
fn a_lying_cone_reaches_down_along_its_slant() {
    let mut rng = Rng::new(4);
    for _ in 0..200 {
        let (h, r) = size(&mut rng);
        let cone = Body::cone(h, r, 0.0);
        let box_ = Body::cuboid(Vector::new(20.0, 1.0, 20.0), 0.0);
        let tilt = f64::from(r).atan2(2.0 * f64::from(h));
        // Its slant down: the axis beneath the horizontal by that angle.
        let lying = DQuat::from_rotation_z(-0.5 * std::f64::consts::PI - tilt);
        let down = DQuat::inverse(lying) * -DVec3::Y;
        let reach = f64::from(h) * tilt.sin();
        assert!((cone.extreme(down).dot(down) - reach).abs() < 1.0e-6);
        let height = rng.range(0.0, 1.5) * f64::from(h.min(r));
        let place = DVec3::new(0.0, 1.0 + height, 0.0);
        assert_found([&box_, &cone], pose(lying, place), height - reach);
        let ground = Body::half_space(Vector::Y);
        let place = DVec3::Y * height;
        assert_found([&ground, &cone], pose(lying, place), height - reach);
    }
}

#[test]
fn polyhedra_are_as_their_own_oracle_says() {
    let mut rng = Rng::new(5);
    for _ in 0..100 {
        let [a, b] = [0; 2].map(|_| {
            let corners = rng.count(4, 20);
            rng.hull(corners, 1.0)
        });
        let bodies = [&a, &b].map(|hull| {
            let points: Vec<Vector> = hull.solid.points.iter().map(|p| p.as_vec3()).collect();
            Body::hull(&points, 0.0).expect("a solid")
        });
        let pose = rng.pose(1.2);
        let exact = oracle::signed_distance(&a.solid, &b.solid, &pose);
        assert_found([&bodies[0], &bodies[1]], pose, exact);
    }
}

/// One body of each kind, rounded or not.
fn bodies(rng: &mut Rng) -> Vec<Body> {
    let (h, r) = size(rng);
    let border = if rng.count(0, 1) == 0 { 0.0 } else { 0.07 };
    let [a, b, c] = [0; 3].map(|_| rng.direction().as_vec3() * 0.6);
    let points: Vec<Vector> = (0..20).map(|_| rng.direction().as_vec3() * 0.5).collect();
    vec![
        Body::ball(r),
        Body::capsule([a, b], r),
        Body::cylinder(h, r, border),
        Body::cone(h, r, border),
        Body::cuboid(Vector::new(0.3, h, r), border),
        Body::triangle([a, b, c], border),
        Body::hull(&points, border).expect("a solid"),
    ]
}

#[test]
fn brackets_are_narrow_and_the_same_in_either_order() {
    let mut rng = Rng::new(6);
    let (mut pairs, mut wide) = (0, 0);
    for _ in 0..2 {
        let all = bodies(&mut rng);
        for (i, a) in all.iter().enumerate() {
            for b in &all[i..] {
                for meeting in Meeting::ALL {
                    for gap in [0.05, 1.0e-6, -0.02, -0.2] {
                        let size = a.diameter().min(b.diameter());
                        let Some(pose) = meeting.pose(&mut rng, [a, b], gap * size) else {
                            continue;
                        };
                        let found = signed_distance([a, b], pose);
                        let other = signed_distance([b, a], pose.inverse());
                        let slack = 1.0e-9 * size;
                        assert!(
                            found.lower <= other.upper + slack
                                && other.lower <= found.upper + slack
                        );
                        let reached = found.lower - gap * size;
                        let is_reached =
                            reached.abs() < 1.0e-6 * (size + a.diameter() + b.diameter());
                        assert!(
                            meeting == Meeting::Concentric || is_reached,
                            "{meeting:?} {found:?}"
                        );
                        let width = (found.upper - found.lower) / size;
                        assert!(
                            width < 1.0e-5,
                            "{} {} {meeting:?} {gap}: {width:e}",
                            a.name,
                            b.name
                        );
                        pairs += 1;
                        wide += usize::from(width > 1.0e-8);
                    }
                }
            }
        }
    }
    assert!(wide * 50 < pairs, "{wide} of {pairs} are wide");
}

#[test]
fn the_judge_finds_faults() {
    let (cylinder, ball) = (Body::cylinder(0.5, 0.4, 0.0), Body::ball(0.25));
    let pose = pose(DQuat::IDENTITY, DVec3::new(0.1, 0.7, 0.0));
    let judge = Judge::new([&cylinder, &ball], pose);
    assert!(judge.distance_error(-0.05) < 1.0e-9);
    assert!(judge.distance_error(-0.04) > 0.01);
    assert!(judge.regret(DVec3::Y) < 1.0e-9);
    assert!(judge.regret(DVec3::X) > 0.1);
    let points = [DVec3::new(0.1, 0.5, 0.0), DVec3::new(0.0, -0.25, 0.0)];
    assert!(judge.gap_error(points, DVec3::Y, -0.05) < 1.0e-9);
    assert!(judge.gap_error(points, DVec3::Y, 0.05) > 0.1);
    let beside = [points[0], points[1] + DVec3::X * 0.05];
    assert!(judge.gap_error(beside, DVec3::Y, -0.05) > 0.01);
    assert!(judge.manifold::<(), ()>(None, 0.02).missing);
    assert!(!judge.manifold::<(), ()>(None, -0.06).missing);
}
