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
use parry3d::shape::SharedShape;
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

/// One of the highest points along a direction, or a mixture of those that are nearly as high.
fn summit(points: &[DVec3], dir: DVec3, rng: &mut Rng) -> DVec3 {
    let heights = points.iter().map(|p| p.dot(dir));
    let most = heights.fold(f64::NEG_INFINITY, f64::max);
    let size = points.iter().map(|p| p.length()).fold(0.0, f64::max);
    let high = points.iter().filter(|p| p.dot(dir) >= most - 1e-6 * size);
    let weighted: Vec<(DVec3, f64)> = high.map(|p| (*p, rng.range(0.0, 1.0))).collect();
    let sum: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    weighted.iter().map(|(p, weight)| *p * (weight / sum)).sum()
}

/// A thin triangle, or a side of it, of any size and anywhere in its frame; its corners, and the shape.
fn thin(rng: &mut Rng) -> (Vec<DVec3>, SharedShape) {
    let size = 10_f64.powf(rng.range(-4.0, 4.0));
    let breadth = 10_f64.powf(rng.range(-6.0, 0.0));
    let far = 10_f64.powf(rng.range(0.0, 3.0)) * rng.count(0, 1) as f64;
    let (along, offset) = (rng.direction(), rng.direction() * far);
    let corner = |rng: &mut Rng| {
        let p = along * rng.range(-1.0, 1.0) + rng.direction() * breadth;
        ((p + offset) * size).as_vec3()
    };
    let [a, b, c] = [(); 3].map(|()| corner(rng));
    let (corners, shape) = match rng.count(0, 2) {
        0 => (vec![a, b], SharedShape::segment(a, b)),
        _ => (vec![a, b, c], SharedShape::triangle(a, b, c)),
    };
    (corners.iter().map(|p| p.as_dvec3()).collect(), shape)
}

/// The nearest point of a nearly flat simplex may be mere rounding. GJK used to give its direction as the
/// normal all the same: of 2.4 million answers 1,602 were off by more than a millionth of the size, some
/// by all of it.
#[test]
fn no_normal_is_guessed_where_slivers_touch() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(11);
    for round in 0..2000 {
        let hull = rng.any_hull(1.0).solid;
        let points: Vec<Vec3> = hull.points.iter().map(|p| p.as_vec3()).collect();
        let Ok(shape) = HullShape::from_points(&points) else {
            continue;
        };
        for _ in 0..4 {
            let (corners, other) = thin(&mut rng);
            let along = rng.direction();
            let place = summit(&hull.points, along, &mut rng) - summit(&corners, -along, &mut rng);
            let pose = Pose::from_translation(place.as_vec3());
            let place = pose.translation.as_dvec3();
            let size = hull.diameter()
                + corners
                    .iter()
                    .map(|p| p.distance(corners[0]))
                    .fold(0.0, f64::max);
            let separation = |normal: DVec3| {
                let nearest = corners.iter().map(|p| normal.dot(*p + place));
                nearest.fold(f64::INFINITY, f64::min) - hull.support(normal)
            };
            for prediction in [Real::MAX, (1e-3 * size) as Real] {
                let contact = dispatcher
                    .contact(&pose, &shape, &*other, prediction)
                    .expect("supported")
                    .expect("within reach");
                let normal = contact.normal1.as_dvec3().normalize();
                let regret = (f64::from(contact.dist) - separation(normal)) / size;
                assert!(
                    regret <= 1e-6,
                    "{round}: regret {regret:e}, {contact:?} at {place}"
                );
            }
        }
    }
}
