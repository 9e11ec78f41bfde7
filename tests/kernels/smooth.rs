//! Balls, capsules, cylinders and cones: supports against points of the shapes, distances against
//! formulas, depths against dense sampling of the separation over all directions.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DQuat, DVec2, DVec3, Vec3};
use isa_gjk::Hull;
use isa_gjk::internals::epa::{self, EpaScratch, Penetration};
use isa_gjk::internals::gjk::{self, Closest, Outcome};
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::primitive::{Ball, Cone, CuboidPolytope, Cylinder, Segment};
use isa_gjk::internals::ray_cast::{RayCast, ray_cast};
use isa_gjk::internals::simplex::Voronoi;
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Cso, Support, VertexId};
use parry3d::math::Pose;
use testkit::generate::Rng;
use testkit::oracle::distance_to_segment;

fn pose(translation: DVec3, rotation: DQuat) -> RelativePose {
    let pose = Pose::from_parts(translation.as_vec3(), rotation.as_quat());
    RelativePose::new(&pose).expect("a finite pose")
}

fn support(shape: &impl Support, dir: DVec3) -> DVec3 {
    shape
        .support(dir, shape.start_vertex(dir), &mut Cost::default())
        .0
}

/// No `point` of the shape lies beyond its supports, and these are of the shape.
fn check_support<S: Support>(
    shape: &S,
    mut point: impl FnMut(&mut Rng) -> DVec3,
    holds: impl Fn(DVec3) -> bool,
) {
    let mut rng = Rng::new(5);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    for i in 0..2000 {
        let dir = if i < 6 {
            axes[i % 3] * if i < 3 { 1.0 } else { -1.0 }
        } else {
            rng.direction() * 10_f64.powf(rng.range(-200.0, 200.0))
        };
        let s = support(shape, dir);
        assert!(holds(s), "{s} for {dir}");
        let tolerance = 1.0e-15 * shape.radius() * dir.length();
        for _ in 0..50 {
            let p = point(&mut rng);
            assert!(holds(p), "the test's own point {p}");
            assert!(dir.dot(p) <= dir.dot(s) + tolerance, "{p} beyond {s}");
            assert!(p.distance(shape.center()) <= shape.radius() * (1.0 + 1.0e-15));
        }
    }
}

#[test]
fn supports_are_extreme_points() {
    let on_disc = |rng: &mut Rng, r: f64| {
        DVec2::from_angle(rng.range(0.0, TAU)) * r * rng.range(0.0, 1.0).sqrt()
    };
    let off_axis = |p: DVec3| p.x.hypot(p.z);
    check_support(
        &Cylinder::new(0.7, 0.4),
        |rng| {
            let (d, y) = (on_disc(rng, 0.4), rng.range(-0.7, 0.7));
            DVec3::new(d.x, y, d.y)
        },
        |p| p.y.abs() <= 0.7 && off_axis(p) <= 0.4 * (1.0 + 1.0e-15),
    );
    for (half_height, radius) in [(0.7, 0.4), (0.1, 0.9), (2.0, 0.01)] {
        check_support(
            &Cone::new(half_height, radius),
            |rng| {
                let up = rng.range(0.0, 1.0);
                let d = on_disc(rng, radius * (1.0 - up));
                DVec3::new(d.x, (2.0 * up - 1.0) * half_height, d.y)
            },
            |p| {
                let up = 0.5 * (p.y / half_height + 1.0);
                (0.0..=1.0).contains(&up) && off_axis(p) <= radius * (1.0 - up + 1.0e-15)
            },
        );
    }
    let ends = [DVec3::new(0.1, 0.2, 0.3), DVec3::new(-0.4, 0.5, 0.9)];
    check_support(
        &Segment::new(ends, 0.25),
        |rng| ends[0].lerp(ends[1], rng.range(0.0, 1.0)),
        |p| (p.distance(ends[0]) + p.distance(ends[1]) - ends[0].distance(ends[1])) < 1.0e-15,
    );
}

#[test]
fn a_segment_keeps_the_end_it_has_when_both_tie() {
    let segment = Segment::new([DVec3::NEG_X, DVec3::X], 0.1);
    for start in [0, 1].map(VertexId::new) {
        let (_, id) = segment.support(DVec3::Y, start, &mut Cost::default());
        assert_eq!(id, start);
    }
}

/// The distance of disjoint cores; its certificate is checked on the way.
fn closest<A: Support, B: Support>(a: &A, b: &B, pose: &RelativePose) -> Closest {
    let cso = Cso {
        shape_1: a,
        shape_2: b,
        pose,
    };
    let mut cost = Cost::default();
    let start = cso.support(DVec3::X, cso.start_vertices(DVec3::X), &mut cost);
    match gjk::distance::<Voronoi, _, _>(&cso, &[start], f64::INFINITY, &mut cost) {
        Outcome::Disjoint(near) => {
            let gap = near.distance - near.lower_bound;
            assert!(gap <= 1.0e-8 * cso.size(), "uncertain by {gap:e}");
            assert!(cost.iterations < 100, "{} iterations", cost.iterations);
            near
        }
        other => panic!("{other:?}: the cores are disjoint"),
    }
}

fn assert_near(found: f64, expected: f64, what: impl std::fmt::Debug) {
    let error = (found - expected).abs();
    assert!(error < 1.0e-6, "{found} instead of {expected}: {what:?}");
}

/// A random place whose coordinates are f32's, as poses are.
fn place(rng: &mut Rng, reach: f64) -> DVec3 {
    (rng.direction() * rng.range(0.0, reach))
        .as_vec3()
        .as_dvec3()
}

#[test]
fn balls_are_apart_by_their_centres_less_their_radii() {
    let mut rng = Rng::new(1);
    let (a, b) = (Ball::new(0.5), Ball::new(0.25));
    for _ in 0..500 {
        let at = place(&mut rng, 3.0);
        let near = closest(&a, &b, &pose(at, rng.rotation()));
        // Also where the balls overlap: the borders know the depth.
        assert_near(
            near.distance - a.border_radius() - b.border_radius(),
            at.length() - 0.75,
            at,
        );
        assert!(near.normal.distance(at.normalize()) < 1.0e-12);
    }
}

#[test]
fn a_ball_is_as_far_from_a_box_as_its_centre() {
    let mut rng = Rng::new(2);
    let extents = DVec3::new(0.5, 1.0, 0.25);
    let (cuboid, ball) = (CuboidPolytope::new(extents), Ball::new(0.3));
    let mut checked = 0;
    for _ in 0..2000 {
        let at = place(&mut rng, 2.0);
        let expected = (at.abs() - extents).max(DVec3::ZERO).length();
        if expected > 1.0e-6 {
            checked += 1;
            let near = closest(&cuboid, &ball, &pose(at, rng.rotation()));
            assert_near(near.distance, expected, at);
        }
    }
    assert!(checked > 1000);
}

/// The distance of two segments: at an end, or where their lines are nearest.
fn between_segments(p: [DVec3; 2], q: [DVec3; 2]) -> f64 {
    let ends = p.map(|end| distance_to_segment(end, q)).into_iter();
    let mut least = ends
        .chain(q.map(|end| distance_to_segment(end, p)))
        .fold(f64::INFINITY, f64::min);
    let (u, v, offset) = (p[1] - p[0], q[1] - q[0], q[0] - p[0]);
    let n = u.cross(v);
    let [s, t] = [v, u].map(|w| offset.cross(w).dot(n) / n.length_squared());
    if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
        least = least.min(offset.dot(n).abs() / n.length());
    }
    least
}

#[test]
fn capsules_are_as_far_apart_as_their_segments() {
    let mut rng = Rng::new(3);
    for _ in 0..3000 {
        let [p, q] = [(); 2].map(|()| [place(&mut rng, 1.0), place(&mut rng, 1.0)]);
        let turn = rng.rotation();
        let pose = pose(place(&mut rng, 2.0), turn);
        let expected = between_segments(p, q.map(|end| pose.point_to_1(end)));
        if expected > 1.0e-6 {
            let near = closest(&Segment::new(p, 0.1), &Segment::new(q, 0.2), &pose);
            assert_near(near.distance, expected, (p, q));
        }
    }
}

#[test]
fn a_point_sees_cylinder_and_cone_in_profile() {
    let mut rng = Rng::new(4);
    let (half_height, radius) = (0.6, 0.35);
    let (cylinder, cone) = (
        Cylinder::new(half_height, radius),
        Cone::new(half_height, radius),
    );
    let flank = [
        DVec3::new(radius, -half_height, 0.0),
        DVec3::new(0.0, half_height, 0.0),
    ];
    let base = [flank[0], DVec3::new(0.0, -half_height, 0.0)];
    for _ in 0..3000 {
        let at = place(&mut rng, 2.0);
        let profile = DVec3::new(at.x.hypot(at.z), at.y, 0.0);
        let pose = pose(at, DQuat::IDENTITY);
        let beyond = (profile - DVec3::new(radius, half_height, 0.0)).max(DVec3::ZERO);
        let beyond = DVec3::new(beyond.x, (at.y.abs() - half_height).max(0.0), 0.0);
        if beyond.length() > 1.0e-6 {
            assert_near(
                closest(&cylinder, &Ball::new(0.1), &pose).distance,
                beyond.length(),
                at,
            );
        }
        let outward = DVec2::new(2.0 * half_height, radius);
        let above_flank = outward.dot((profile - flank[1]).truncate());
        if above_flank > 1.0e-6 || at.y < -half_height - 1.0e-6 {
            let expected =
                distance_to_segment(profile, flank).min(distance_to_segment(profile, base));
            assert_near(
                closest(&cone, &Ball::new(0.1), &pose).distance,
                expected,
                at,
            );
        }
    }
}

#[test]
fn cylinders_meet_boxes_and_each_other_where_geometry_says() {
    let cylinder = Cylinder::new(0.5, 0.25);
    let cuboid = CuboidPolytope::new(DVec3::splat(0.5));
    let lying = DQuat::from_rotation_x(FRAC_PI_2);
    for gap in [1.0e-3, 0.125, 2.0] {
        let cases = [
            // Cap above face, side beside face, side beside edge.
            (DVec3::Y * (1.0 + gap), DQuat::IDENTITY, gap),
            (DVec3::X * (0.75 + gap), DQuat::IDENTITY, gap),
            (DVec3::new(0.75 + gap, 0.3, 0.2), DQuat::IDENTITY, gap),
            (
                DVec3::new(0.5 + gap, 0.0, 0.5 + gap),
                DQuat::IDENTITY,
                gap * 2.0_f64.sqrt() - 0.25,
            ),
            (DVec3::Y * (0.75 + gap), lying, gap),
        ];
        for (at, turn, expected) in cases {
            if expected > 1.0e-6 {
                let near = closest(&cuboid, &cylinder, &pose(at, turn));
                assert_near(near.distance, expected, (at, turn));
            }
        }
        let parallel = closest(
            &cylinder,
            &cylinder,
            &pose(DVec3::X * (0.5 + gap), DQuat::IDENTITY),
        );
        assert_near(parallel.distance, gap, "parallel");
        let crossed = closest(&cylinder, &cylinder, &pose(DVec3::X * (0.5 + gap), lying));
        assert_near(crossed.distance, gap, "crossed");
    }
}

/// The largest separation `s(n)` over the sphere: a dense spiral, then ever smaller steps from
/// each of the best directions. Negative where the shapes overlap: minus their depth.
fn sampled_separation<A: Support, B: Support>(cso: &Cso<'_, A, B>) -> f64 {
    const SAMPLES: usize = 20_000;
    const REFINED: usize = 20;
    let golden = TAU * 0.5 * (5.0_f64.sqrt() - 1.0);
    let separation = |n: DVec3| {
        -n.dot(
            cso.support(n, cso.start_vertices(n), &mut Cost::default())
                .w,
        )
    };
    let mut samples: Vec<(f64, DVec3)> = (0..SAMPLES)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / SAMPLES as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let n = DVec3::new(r * cos, r * sin, z);
            (separation(n), n)
        })
        .collect();
    samples.sort_by(|a, b| b.0.total_cmp(&a.0));
    // Random steps: on the ridges of `s`, which is not smooth, fixed ones would get stuck.
    let mut rng = Rng::new(6);
    let mut refine = |&(mut best, mut n): &(f64, DVec3)| {
        let mut step = 0.02;
        while step > 1.0e-9 {
            let better = (0..32)
                .map(|_| (n + rng.direction() * step).normalize())
                .map(|n| (separation(n), n))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            match better {
                Some(better) if better.0 > best => (best, n) = better,
                _ => step *= 0.85,
            }
        }
        best
    };
    samples[..REFINED]
        .iter()
        .map(&mut refine)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// The worst of many depths.
#[derive(Debug, Default)]
struct Worst {
    error: f64,
    gap: f64,
    iterations: u32,
    fallbacks: u32,
}

fn depth<A: Support, B: Support>(cso: &Cso<'_, A, B>, cost: &mut Cost) -> Option<Penetration> {
    let start = cso.support(DVec3::X, cso.start_vertices(DVec3::X), cost);
    let Outcome::Overlapping(simplex) =
        gjk::distance::<Voronoi, _, _>(cso, &[start], f64::INFINITY, cost)
    else {
        return None;
    };
    let seeds: Vec<_> = simplex.vertices().copied().collect();
    let depth = epa::penetration(cso, &seeds, &mut EpaScratch::default(), cost);
    Some(depth.expect("the difference has volume"))
}

fn check_depths<A: Support, B: Support>(name: &str, a: &A, b: &B, seed: u128) {
    let mut rng = Rng::new(seed);
    let mut worst = Worst::default();
    let mut checked = 0;
    let reach = a.radius() + b.radius();
    for i in 0..18 {
        // Some poses are as symmetric as poses can be.
        let turn = [DQuat::IDENTITY, DQuat::from_rotation_x(FRAC_PI_2)]
            .get(i % 6)
            .copied()
            .unwrap_or_else(|| rng.rotation());
        let pose = pose(place(&mut rng, if i < 3 { 0.0 } else { reach }), turn);
        let cso = Cso {
            shape_1: a,
            shape_2: b,
            pose: &pose,
        };
        let mut cost = Cost::default();
        let Some(found) = depth(&cso, &mut cost) else {
            continue;
        };
        checked += 1;
        let size = cso.size();
        let sampled = -sampled_separation(&cso);
        let shown = found.normal.dot(support(a, found.normal))
            - found
                .normal
                .dot(pose.point_to_1(support(b, -pose.direction_to_2(found.normal))));
        assert!((shown - found.depth).abs() <= 1.0e-12 * size, "{found:?}");
        assert!(found.lower_bound <= sampled + 1.0e-9 * size, "{found:?}");
        worst.error = worst.error.max((found.depth - sampled).abs() / size);
        worst.gap = worst.gap.max((found.depth - found.lower_bound) / size);
        worst.iterations = worst.iterations.max(cost.iterations);
        worst.fallbacks = worst.fallbacks.max(cost.fallbacks);
        // Across the normal they may be apart: a facet is larger than the triangle found of it.
        let overlap = found.normal.dot(found.on_1 - found.on_2);
        assert!((overlap - found.depth).abs() <= 2.0e-6 * size, "{found:?}");
    }
    println!("{name:<18} {checked} overlaps, worst {worst:?}");
    assert!(checked >= 6, "{name}: only {checked} overlaps");
    assert!(worst.error <= 1.0e-5, "{name}: {worst:?}");
    // Most where a circle of directions is least, as the documentation says.
    assert!(worst.iterations <= 7500, "{name}: {worst:?}");
}

#[test]
fn depths_of_smooth_shapes_are_least() {
    let corner = |i: u32| Vec3::from_array([0, 1, 2].map(|k| (i >> k & 1) as f32 - 0.5));
    let cube = Hull::from_points(&(0..8).map(corner).collect::<Vec<_>>()).expect("a cube");
    let (cylinder, cone) = (Cylinder::new(0.5, 0.3), Cone::new(0.6, 0.4));
    let (flat, needle) = (Cylinder::new(0.02, 0.8), Cone::new(1.0, 0.05));
    let segment = Segment::new([DVec3::NEG_Y * 0.5, DVec3::Y * 0.5], 0.1);
    let ball = Ball::new(0.2);
    check_depths("cylinder-cylinder", &cylinder, &cylinder, 1);
    check_depths("cone-cone", &cone, &cone, 2);
    check_depths("cylinder-cone", &cylinder, &cone, 3);
    check_depths("hull-cylinder", &cube, &cylinder, 4);
    check_depths("cone-hull", &cone, &cube, 5);
    check_depths("coin-needle", &flat, &needle, 6);
    check_depths("coin-coin", &flat, &flat, 7);
    check_depths("cylinder-ball", &cylinder, &ball, 8);
    check_depths("ball-cone", &ball, &cone, 9);
    check_depths("hull-ball", &cube, &ball, 10);
    check_depths("hull-capsule", &cube, &segment, 11);
    check_depths("capsule-cylinder", &segment, &cylinder, 12);
    check_depths(
        "cuboid-cone",
        &CuboidPolytope::new(DVec3::new(0.3, 0.5, 0.1)),
        &cone,
        13,
    );
}

/// When the border of `b` touches `a`, if it does.
fn impact(
    a: &impl Support,
    b: &impl Support,
    from: DVec3,
    velocity: DVec3,
    border_radius: f64,
) -> RayCast {
    let pose = pose(from, DQuat::IDENTITY);
    let cso = Cso {
        shape_1: a,
        shape_2: b,
        pose: &pose,
    };
    let mut cost = Cost::default();
    let answer = ray_cast::<Voronoi, _, _>(&cso, velocity, f64::INFINITY, border_radius, &mut cost);
    assert_eq!(cost.fallbacks, 0, "{} iterations", cost.iterations);
    answer
}

#[test]
fn a_ball_is_cast_as_its_centre() {
    let (a, b) = (Ball::new(1.0), Ball::new(0.5));
    for aside in [0.0, 0.5, 1.0, 1.4, 1.499, 1.501, 2.0_f64] {
        let aside = f64::from(aside as f32);
        let answer = impact(&a, &b, DVec3::new(4.0, aside, 0.0), DVec3::NEG_X, 1.5);
        match answer {
            RayCast::Hit(hit) => {
                let expected = 4.0 - (1.5 * 1.5 - aside * aside).sqrt();
                // Touching to 1e-8 is that to its square root in time where it grazes.
                assert_near(hit.time, expected, aside);
                let normal = DVec3::new(4.0 - hit.time, aside, 0.0).normalize();
                assert!(hit.normal.distance(normal) < 1.0e-6, "{hit:?}");
            }
            RayCast::Miss => assert!(aside > 1.5),
            RayCast::Overlap => panic!("they start apart"),
        }
        assert_eq!(matches!(answer, RayCast::Hit(_)), aside < 1.5, "{aside}");
    }
}

#[test]
fn cylinders_and_cones_are_cast() {
    let (cylinder, cone) = (Cylinder::new(0.5, 0.25), Cone::new(0.5, 0.25));
    let cases = [
        // Side against side, past the middle by half a radius each.
        (
            impact(
                &cylinder,
                &cylinder,
                DVec3::new(3.0, 0.25, 0.25),
                DVec3::NEG_X,
                0.0,
            ),
            3.0 - (0.25_f64 - 0.0625).sqrt(),
        ),
        (
            impact(&cylinder, &cone, DVec3::Y * 3.0, DVec3::NEG_Y, 0.0),
            2.0,
        ),
        (
            impact(&cone, &cylinder, DVec3::Y * 3.0, DVec3::NEG_Y, 0.0),
            2.0,
        ),
        (
            impact(&cone, &Ball::new(0.5), DVec3::Y * 3.0, DVec3::NEG_Y, 0.5),
            2.0,
        ),
    ];
    for (answer, expected) in cases {
        let RayCast::Hit(hit) = answer else {
            panic!("{answer:?} instead of a hit after {expected}")
        };
        assert_near(hit.time, expected, hit);
    }
}
