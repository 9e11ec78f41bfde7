//! The normal of shapes that all but touch.
//!
//! A distance `d` is the length of a difference of coordinates, each rounded by a share of 1e-16 of
//! the shapes' size: its direction is off by an angle of 1e-16 · size / d, and the separation along
//! it by that angle times the size. Below 1e-10 of the size, where that would be a millionth, GJK
//! hands over to the penetration search, which works on planes. So no distance has a worse regret
//! than a few millionths of the size.

use glam::{DVec3, Vec3};
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::math::{Pose, Real};
use parry3d::query::QueryDispatcher;
use testkit::generate::Rng;

const REGRET: f64 = 1.0e-5;

/// Between 1e-2 and 1e-13, all that f32 holds next to zero.
const DISTANCES: [f64; 12] = [
    1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 3e-9, 1e-9, 3e-10, 1e-10, 1e-11, 1e-12, 1e-13,
];

/// Beneath the plane `x + y + z = 0`, with a triangle of it as a face.
const BENEATH: [Vec3; 4] = [
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(0.0, 1.0, -1.0),
    Vec3::new(-1.0, 0.0, 1.0),
    Vec3::new(-1.0, -0.5, -0.75),
];

/// Beneath the same plane, with an edge of it through the origin.
const RIDGE: [Vec3; 4] = [
    Vec3::new(1.0, -1.0, 0.0),
    Vec3::new(-1.0, 1.0, 0.0),
    Vec3::new(-0.25, 0.0, -1.0),
    Vec3::new(-1.0, -0.5, 0.25),
];

/// With a corner at the origin, above the plane.
const TIP: [Vec3; 4] = [
    Vec3::ZERO,
    Vec3::new(1.0, 0.5, -0.5),
    Vec3::new(-0.25, 1.0, 0.25),
    Vec3::new(0.0, -0.25, 1.0),
];

/// With another edge through the origin, above the plane.
const KEEL: [Vec3; 4] = [
    Vec3::new(0.5, 0.5, -1.0),
    Vec3::new(-0.5, -0.5, 1.0),
    Vec3::new(1.0, 0.0, 0.5),
    Vec3::new(0.25, 1.0, 0.25),
];

/// The least `dir · p` over the points.
fn lowest(points: &[Vec3], dir: DVec3) -> f64 {
    let heights = points.iter().map(|p| dir.dot(p.as_dvec3()));
    heights.fold(f64::INFINITY, f64::min)
}

#[test]
fn normals_stay_good_down_to_touching() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(10);
    let up = DVec3::ONE.normalize();
    for (kind, below, above) in [("tip", BENEATH, TIP), ("keel", RIDGE, KEEL)] {
        let shapes = [below, above].map(|p| HullShape::from_points(&p).expect("a solid"));
        for distance in DISTANCES {
            for _ in 0..50 {
                // Sideways by about as much, so that no coordinate is a special one.
                let aside = rng.direction().cross(up) * distance;
                let shift = (up * distance + aside).as_vec3();
                let exact = up.dot(shift.as_dvec3());
                let pose = Pose::from_translation(shift);
                let contact = dispatcher
                    .contact(&pose, &shapes[0], &shapes[1], Real::MAX)
                    .expect("supported")
                    .expect("within reach");
                let normal = contact.normal1.as_dvec3().normalize();
                let shown =
                    normal.dot(shift.as_dvec3()) + lowest(&above, normal) + lowest(&below, -normal);
                let regret = exact - shown;
                assert!(
                    regret <= REGRET,
                    "{kind} at {distance:e}: regret {regret:e}"
                );
                let error = (f64::from(contact.dist) - exact).abs();
                assert!(error <= 1.0e-6, "{kind}: {} for {exact:e}", contact.dist);
            }
        }
    }
}
