//! Contact patches of cylinders and cones: how far they reach, and that they lie still.

use glam::{DQuat, DVec3};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Vector};
use parry3d::shape::SharedShape;
use testkit::curved::{Body, Judge};
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, cold_manifold};
use testkit::pose::ExactPose;

const REACH: f32 = 0.02;

fn manifold(shapes: [&SharedShape; 2], pose: &Pose) -> Manifold {
    cold_manifold(&IsaGjkDispatcher::default(), pose, shapes, REACH).expect("supported")
}

/// The contacts in the frame of the first shape.
fn points(manifold: &Manifold) -> Vec<DVec3> {
    let points = manifold.points.iter();
    points.map(|point| point.local_p1.as_dvec3()).collect()
}

/// The least reach of points from a centre along the directions across an axis.
fn least_reach(points: &[DVec3], center: DVec3, axis: DVec3) -> f64 {
    let (u, v) = axis.any_orthonormal_pair();
    let reach = |i: usize| {
        let (sin, cos) = (i as f64 * std::f64::consts::TAU / 64.0).sin_cos();
        let direction = u * cos + v * sin;
        let reaches = points.iter().map(|p| (*p - center).dot(direction));
        reaches.fold(f64::NEG_INFINITY, f64::max)
    };
    (0..64).map(reach).fold(f64::INFINITY, f64::min)
}

fn standing(rng: &mut Rng, at: DVec3) -> ExactPose {
    ExactPose {
        rotation: DQuat::from_rotation_y(rng.range(0.0, 6.0)),
        translation: at,
    }
}

#[test]
fn a_disc_on_a_face_has_a_square() {
    let mut rng = Rng::new(71);
    let table = SharedShape::cuboid(2.0, 0.5, 2.0);
    let cases = [
        (SharedShape::cylinder(0.3, 0.5), 0.3),
        (SharedShape::cone(0.3, 0.5), 0.3),
        (SharedShape::round_cylinder(0.3, 0.5, 0.05), 0.35),
        (SharedShape::cylinder(0.02, 0.5), 0.02),
    ];
    for (body, half) in &cases {
        for _ in 0..20 {
            let at = DVec3::new(
                rng.range(-1.4, 1.4),
                0.5 + half - 1e-3,
                rng.range(-1.4, 1.4),
            );
            let pose = standing(&mut rng, at).to_f32();
            let found = points(&manifold([&table, body], &pose));
            assert_eq!(found.len(), 4);
            let mean = found.iter().sum::<DVec3>() / 4.0;
            let center = at.with_y(0.5);
            assert!(mean.distance(center) < 0.02 * 0.5, "{mean} is not {center}");
            let reach = least_reach(&found, center, DVec3::Y);
            assert!(reach >= 0.70 * 0.5, "{reach}");
        }
    }
}

/// A coin beyond the edge of a table: it is supported by what is over the table.
#[test]
fn a_cut_disc_reaches_the_edge() {
    let table = SharedShape::cuboid(2.0, 0.5, 2.0);
    let coin = SharedShape::cylinder(0.05, 0.5);
    for beyond in [-0.4, -0.2, 0.0, 0.2, 0.4] {
        let pose = Pose::translation(2.0 + beyond, 0.549, 0.3);
        let found = points(&manifold([&table, &coin], &pose));
        assert!(found.len() >= 3, "{beyond}: {found:?}");
        let farthest = found.iter().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
        assert!((farthest - 2.0).abs() < 1e-5, "{beyond}: {farthest}");
        let nearest = found.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
        let (from, width) = (1.5 + f64::from(beyond), 0.5 - f64::from(beyond));
        assert!(nearest - from < 0.4 * width, "{beyond}: {found:?}");
        let chord = found.iter().map(|p| (p.z - 0.3).abs()).fold(0.0, f64::max);
        assert!(
            chord > 0.6 * (0.25 - f64::from(beyond).powi(2)).sqrt().min(0.5),
            "{beyond}: {found:?}"
        );
    }
}

/// Two coins, one shifted on the other: the contacts span what they share.
#[test]
fn shifted_coins_share_a_lens() {
    let coin = SharedShape::cylinder(0.05, 0.5);
    for shift in [0.0_f32, 1e-4, 0.01, 0.1, 0.4, 0.8] {
        let pose = Pose::translation(shift, 0.099, 0.0);
        let found = points(&manifold([&coin, &coin], &pose));
        assert_eq!(found.len(), 4, "{shift}");
        let middle = DVec3::new(0.5 * f64::from(shift), 0.05, 0.0);
        let inner = 0.5 - 0.5 * f64::from(shift);
        let reach = least_reach(&found, middle, DVec3::Y);
        assert!(reach >= 0.69 * inner, "{shift}: {reach} of {inner}");
        for p in found {
            let others = p - DVec3::new(shift.into(), 0.0, 0.0);
            let off = p.x.hypot(p.z).max(others.x.hypot(others.z)) - 0.5;
            assert!(off < 1e-5, "{shift}: {p}");
        }
    }
}

/// Whatever lies has a contact at both ends.
#[test]
fn lines_have_two_ends() {
    let table = SharedShape::cuboid(2.0, 0.5, 2.0);
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut rng = Rng::new(72);
    let log = SharedShape::cylinder(0.6, 0.1);
    let (h, r) = (0.6_f64, 0.2_f64);
    let cone = SharedShape::cone(h as f32, r as f32);
    let tilt = (0.5 * r / h).atan();
    for _ in 0..20 {
        let turn = DQuat::from_rotation_y(rng.range(0.0, 6.0));
        let lying = ExactPose {
            rotation: turn * DQuat::from_rotation_z(quarter),
            translation: DVec3::new(0.2, 0.599, -0.3),
        };
        let found = points(&manifold([&table, &log], &lying.to_f32()));
        assert_eq!(found.len(), 2);
        assert!((found[0].distance(found[1]) - 1.2).abs() < 1e-4);
        let lying = ExactPose {
            rotation: turn * DQuat::from_rotation_z(quarter + tilt),
            // The middle of the axis is half as high above the slant as the rim's centre.
            translation: DVec3::new(0.2, 0.499 + 0.5 * r * tilt.cos(), -0.3),
        };
        let found = points(&manifold([&table, &cone], &lying.to_f32()));
        assert_eq!(found.len(), 2);
        let slant = (2.0 * h).hypot(r);
        assert!((found[0].distance(found[1]) - slant).abs() < 1e-4 * slant);
    }
}

/// A spinning coin leaves its contacts where they are on the table.
/// They lie between both lines, where these are beside each other by a tenth of both radii.
#[test]
fn what_crosses_has_a_place_on_either_side() {
    const RADIUS: f64 = 0.1;
    let depth = 1e-3;
    let (log, capsule) = (
        SharedShape::cylinder(0.5, RADIUS as f32),
        SharedShape::capsule_y(0.5, RADIUS as f32),
    );
    for shapes in [[&log, &log], [&capsule, &capsule], [&log, &capsule]] {
        for angle in [0.3_f64, 0.8, 1.4] {
            let pose = ExactPose {
                rotation: DQuat::from_rotation_x(angle),
                translation: DVec3::X * (2.0 * RADIUS - depth),
            };
            let [first, second] = shapes;
            let orders = [
                (shapes, pose.to_f32()),
                ([second, first], pose.to_f32().inverse()),
            ];
            for (shapes, pose) in orders {
                let mut manifold = manifold(shapes, &pose);
                let points = &mut manifold.points;
                assert_eq!(points.len(), 3, "{angle}");
                points.sort_by(|a, b| a.dist.total_cmp(&b.dist));
                let [deepest, sides @ ..] = &points[..] else {
                    unreachable!("there are three");
                };
                let off = f64::from(deepest.dist) + depth;
                assert!(off.abs() < 1e-6, "{angle}: off by {off}");
                let beside = 0.1 * RADIUS * (0.5 * angle).cos();
                let lower = RADIUS - (RADIUS * RADIUS - beside * beside).sqrt();
                for side in sides {
                    let off = f64::from(side.dist) - (2.0 * lower - depth);
                    assert!(off.abs() < 1e-6, "{angle}: off by {off}");
                }
                let from = deepest.local_p1.reject_from(manifold.local_n1);
                let [a, b] =
                    [0, 1].map(|i| sides[i].local_p1.reject_from(manifold.local_n1) - from);
                let (sum, way) = (f64::from((a + b).length()), f64::from((a - b).length()));
                let expected = 0.2 * RADIUS / (0.5 * angle).tan();
                assert!(sum < 1e-4 * way, "{angle}: {a} {b}");
                assert!((way - expected).abs() < 1e-4 * expected, "{angle}: {way}");
            }
        }
    }
}

#[test]
fn contacts_stay_under_a_spin() {
    let table = SharedShape::cuboid(2.0, 0.5, 2.0);
    let coin = SharedShape::cylinder(0.05, 0.5);
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let mut before: Option<Vec<(Vector, [u32; 2])>> = None;
    for frame in 0..200 {
        let pose = ExactPose {
            rotation: DQuat::from_rotation_y(0.05 * f64::from(frame)),
            translation: DVec3::new(0.1, 0.549, 0.2),
        };
        let found = memory.update(&dispatcher, &pose.to_f32(), [&table, &coin], REACH);
        let found = &found.expect("supported").points;
        let places = found.iter().map(|p| (p.local_p1, [p.fid1.0, p.fid2.0]));
        let mut places: Vec<_> = places.collect();
        places.sort_by_key(|place| place.1);
        if let Some(before) = &before {
            for (old, new) in before.iter().zip(&places) {
                assert_eq!(old.1, new.1, "at frame {frame}");
                assert!(old.0.distance(new.0) < 1e-4, "at frame {frame}");
            }
        }
        before = Some(places);
    }
}

const WOBBLE: f64 = 0.1;

/// A body that leans by a tenth, whose lowest place has gone round by an angle without sliding.
fn wobbling(angle: f64, half: f64, radius: f64) -> ExactPose {
    let lean = DQuat::from_rotation_z(-WOBBLE);
    ExactPose {
        rotation: DQuat::from_rotation_y(-angle) * lean * DQuat::from_rotation_y(angle),
        translation: DVec3::Y * (0.5 + half * WOBBLE.cos() + radius * WOBBLE.sin() - 1e-3),
    }
}

/// What wobbles has a contact where it will be deepest after the next step.
#[test]
fn a_rolling_disc_has_a_contact_ahead() {
    let grounds = [
        Body::cuboid(Vector::new(2.0, 0.5, 2.0), 0.0),
        Body::cylinder(0.5, 1.5, 0.0),
    ];
    let bodies = [
        (Body::cylinder(0.3, 0.5, 0.0), 0.3),
        (Body::cylinder(0.02, 0.5, 0.0), 0.02),
        (Body::cone(0.3, 0.5, 0.0), 0.3),
        (Body::cylinder(0.3, 0.45, 0.05), 0.35),
    ];
    let dispatcher = IsaGjkDispatcher::default();
    for (ground, (body, half)) in grounds
        .iter()
        .flat_map(|g| bodies.iter().map(move |b| (g, b)))
    {
        for (is_reversed, step) in [(false, 0.1), (true, 0.1), (false, -0.1), (false, 0.02)] {
            let what = format!("{} on {}, {is_reversed}, {step}", body.name, ground.name);
            let mut memory = Memory::default();
            for frame in 0..6 {
                let at = |frame: i32| {
                    let pose = wobbling(step * f64::from(frame), *half, 0.5).rounded();
                    if is_reversed {
                        pose.inverse().rounded()
                    } else {
                        pose
                    }
                };
                let pair = if is_reversed {
                    [body, ground]
                } else {
                    [ground, body]
                };
                let shapes = pair.map(|body| &body.shape);
                let found = memory.update(&dispatcher, &at(frame).to_f32(), shapes, REACH);
                let found = found.expect("supported");
                let faults = Judge::new(pair, at(frame)).manifold(Some(found), REACH.into());
                assert!(faults.are_within(1e-5), "{what}, {frame}: {faults:?}");
                let on_body = |point: &parry3d::query::TrackedContact<u32>| {
                    if is_reversed {
                        point.local_p1
                    } else {
                        point.local_p2
                    }
                    .as_dvec3()
                };
                let next = manifold(shapes, &at(frame + 1).to_f32());
                let deepest = next.points.iter().min_by(|a, b| a.dist.total_cmp(&b.dist));
                let next = on_body(deepest.expect("a contact"));
                let places: Vec<_> = found.points.iter().map(on_body).collect();
                let away = places
                    .iter()
                    .map(|p| p.distance(next))
                    .fold(f64::INFINITY, f64::min);
                // Of a rounded one, it is at the border of the flat side.
                let near = 2e-3 + 1.1 * WOBBLE * body.border;
                assert!(frame == 0 || away < near, "{what}, {frame}: {away}");
                let center = DVec3::NEG_Y * *half;
                let reach = least_reach(&places, center, DVec3::Y);
                assert!(frame == 0 || reach > 0.45 * 0.5, "{what}, {frame}: {reach}");
            }
        }
    }
}
