//! Answers of hulls of any size: scaled by a power of two they are the same, scaled.

use glam::DVec3;
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{ClosestPoints, QueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::generate::Rng;
use testkit::memory::cold_manifold;

/// The powers of two that the documentation promises, in metres: from 1e-21 to 4e18.
const EXPONENTS: [i32; 9] = [-70, -60, -40, -20, 0, 20, 40, 55, 62];

/// Kinds of the second shape.
#[derive(Clone, Copy)]
enum Kind {
    Plain,
    Prepared,
    Cuboid,
    Capsule,
    Cylinder,
}

const KINDS: [Kind; 5] = [
    Kind::Plain,
    Kind::Prepared,
    Kind::Cuboid,
    Kind::Capsule,
    Kind::Cylinder,
];

/// A shape with these corners, or one that needs fewer numbers, larger by this scale.
fn shape(kind: Kind, points: &[DVec3], scale: f64) -> SharedShape {
    let points: Vec<Vector> = points.iter().map(|p| (*p * scale).as_vec3()).collect();
    let (p, r) = (points[0], (0.5 * scale) as Real);
    match kind {
        Kind::Plain => SharedShape::convex_hull(&points).expect("points on a ball"),
        Kind::Prepared => SharedShape::new(HullShape::from_points(&points).expect("a solid")),
        Kind::Cuboid => SharedShape::cuboid(r, 0.5 * r, r),
        Kind::Capsule => SharedShape::capsule(p, points[1], r),
        Kind::Cylinder => SharedShape::cylinder(r, 0.5 * r),
    }
}

/// All answers about a pair, in units of its size: distances, and how far apart the closest points are.
fn answers(points: [&[DVec3]; 2], kind: Kind, place: DVec3, exponent: i32) -> [f64; 4] {
    let scale = 2.0_f64.powi(exponent);
    let shapes = [
        shape(Kind::Plain, points[0], scale),
        shape(kind, points[1], scale),
    ];
    let [a, b] = [&*shapes[0], &*shapes[1]];
    let us = IsaGjkDispatcher::default();
    let pose = Pose::from_translation((place * scale).as_vec3());
    let reach = (4.0 * scale) as Real;
    let distance = us.distance(&pose, a, b).expect("supported").distance;
    let contact = us.contact(&pose, a, b, reach).expect("supported");
    let closest = us.closest_points(&pose, a, b, reach).expect("supported");
    let between = match closest {
        ClosestPoints::WithinMargin(p, q) => (pose.transform_point(q) - p).as_dvec3().length(),
        ClosestPoints::Intersecting => 0.0,
        ClosestPoints::Disjoint => f64::INFINITY,
    };
    let manifold = cold_manifold(&us, &pose, [&shapes[0], &shapes[1]], reach);
    let deepest = manifold
        .expect("supported")
        .find_deepest_contact()
        .expect("near")
        .dist;
    let contact = contact.expect("within reach").dist;
    [distance.into(), contact.into(), between, deepest.into()].map(|length: f64| length / scale)
}

#[test]
fn answers_do_not_depend_on_the_size() {
    let mut rng = Rng::new(21);
    for round in 0..60 {
        let kind = KINDS[round % KINDS.len()];
        let [a, b] = [(); 2].map(|()| -> Vec<DVec3> {
            let count = rng.count(8, 60);
            (0..count)
                .map(|_| rng.direction().as_vec3().as_dvec3())
                .collect()
        });
        let place = (rng.direction() * rng.range(0.5, 3.0)).as_vec3().as_dvec3();
        // parry's searches, which answer for cylinders, stop earlier.
        let accuracy = if matches!(kind, Kind::Cylinder) {
            1e-3
        } else {
            1e-5
        };
        let expected = answers([&a, &b], kind, place, 0);
        for exponent in EXPONENTS {
            let found = answers([&a, &b], kind, place, exponent);
            let off = [0, 1, 2, 3].map(|i| (found[i] - expected[i]).abs());
            let is_same = off.iter().all(|off| *off <= accuracy);
            assert!(
                is_same,
                "{round}, 2^{exponent}: {found:?}, not {expected:?}"
            );
        }
    }
}
