//! Laws that hold for any two hulls at any pose, through the query and through the dispatcher.

use glam::{DVec3, Vec3};
use isa_gjk::internals::epa::EpaScratch;
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::query::{Answer, PairMemory, Proximity, Query};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Cso, Polytope, Support};
use isa_gjk::{Hull, HullShape, IsaGjkDispatcher};
use parry3d::math::Pose;
use parry3d::query::{Contact, QueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::divided::divided_block;
use testkit::generate::Rng;

/// Relative to the pair's size: a depth is certified to 1e-6 of the smaller radius, and both
/// answers that are compared may be off by that.
const TOLERANCE: f64 = 3.0e-6;

/// What the same query rounded to f32 may add.
const SINGLE: f64 = 3.0e-6;

/// Pairs for each law.
const CASES: u32 = 2000;

/// Two hulls and where the second is.
#[derive(Clone, Debug)]
struct Pair {
    hulls: [Vec<Vec3>; 2],
    pose: Pose,
}

fn point(rng: &mut Rng) -> Vec3 {
    DVec3::from_array([(); 3].map(|()| rng.range(-1.0, 1.0))).as_vec3()
}

fn pose(rng: &mut Rng, reach: f32) -> Pose {
    Pose::from_parts(point(rng) * reach, rng.rotation().as_quat())
}

/// Points of which some, on purpose, are coplanar or on a line.
fn cloud(rng: &mut Rng) -> Vec<Vec3> {
    let kind = rng.count(0, 7);
    loop {
        let points = match kind {
            0..=2 => (0..rng.count(4, 39)).map(|_| point(rng)).collect(),
            3..=5 => {
                let points = (0..rng.count(8, 39)).map(|_| point(rng));
                points.map(|p| (p * 4.0).round() * 0.25).collect()
            }
            _ => thin_or_divided(rng),
        };
        let is_thick_enough = |hull: &Hull| kind > 5 || thickness(hull) > 0.02;
        if Hull::from_points(&points).is_ok_and(|hull| is_thick_enough(&hull)) {
            return points;
        }
    }
}

/// Blades, needles and plates, and blocks with inner vertices that were turned before they were rounded.
fn thin_or_divided(rng: &mut Rng) -> Vec<Vec3> {
    let points = if rng.count(0, 1) == 0 {
        rng.any_hull(2.0).solid.points
    } else {
        let half = DVec3::new(1.0, 0.6, [0.5, 0.1, 0.01][rng.count(0, 2)]);
        divided_block(rng.count(1, 4) as u32, half).0
    };
    let turn = rng.rotation();
    points.iter().map(|p| (turn * *p).as_vec3()).collect()
}

/// Looks at many pairs. A law that needs more random numbers gets their source.
fn for_pairs(law: impl Fn(Pair, &mut Rng)) {
    for case in 0..CASES {
        let mut rng = Rng::new(1988 + u128::from(case));
        let pair = Pair {
            hulls: [cloud(&mut rng), cloud(&mut rng)],
            pose: pose(&mut rng, 1.5),
        };
        law(pair, &mut rng);
    }
}

/// How deep the centre is inside.
fn thickness(hull: &Hull) -> f64 {
    hull.face_ids()
        .map(|f| hull.face_offset(f) - hull.face_normal(f).dot(hull.center()))
        .fold(f64::INFINITY, f64::min)
}

fn build(points: &[Vec3]) -> Hull {
    Hull::from_points(points).expect("filtered")
}

fn shape(points: &[Vec3]) -> SharedShape {
    SharedShape::new(HullShape::from_points(points).expect("filtered"))
}

fn near(hulls: [&Hull; 2], pose: &Pose, memory: &PairMemory) -> Proximity {
    let pose = RelativePose::new(pose).expect("a finite pose");
    let query = Query {
        cso: &Cso {
            shape_1: hulls[0],
            shape_2: hulls[1],
            pose: &pose,
        },
        max_distance: f64::INFINITY,
        polytope_cache: None,
        scratch: &mut EpaScratch::default(),
        cost: &mut Cost::default(),
    }
    .run(memory);
    match query {
        Some((Answer::Near(proximity), _)) => proximity,
        other => panic!("nothing is beyond infinity: {other:?}"),
    }
}

fn size(hulls: [&Hull; 2]) -> f64 {
    hulls[0].radius() + hulls[1].radius()
}

/// How far the shapes are apart along a unit direction.
fn separation(hulls: [&Hull; 2], pose: &RelativePose, n: DVec3) -> f64 {
    let highest = |hull: &Hull, d: DVec3| {
        let heights = hull.points().iter().map(|p| d.dot(p.as_dvec3()));
        heights.fold(f64::NEG_INFINITY, f64::max)
    };
    let lowest_of_2 =
        n.dot(pose.point_to_1(DVec3::ZERO)) - highest(hulls[1], -pose.direction_to_2(n));
    lowest_of_2 - highest(hulls[0], n)
}

/// How far a point is beyond the face it violates most.
fn outside(hull: &Hull, point: DVec3) -> f64 {
    hull.face_ids()
        .map(|f| hull.face_normal(f).dot(point) - hull.face_offset(f))
        .fold(f64::NEG_INFINITY, f64::max)
}

fn contact(shapes: [&SharedShape; 2], pose: &Pose) -> Contact {
    IsaGjkDispatcher::default()
        .contact(pose, &**shapes[0], &**shapes[1], 100.0)
        .expect("hulls are supported")
        .expect("nothing is beyond a hundred")
}

#[test]
fn no_direction_separates_more_than_the_answer() {
    for_pairs(|pair, rng| {
        let hulls = pair.hulls.each_ref().map(|h| build(h));
        let hulls = hulls.each_ref();
        let pose = RelativePose::new(&pair.pose).expect("finite");
        let found = near(hulls, &pair.pose, &PairMemory::None);
        let shown = separation(hulls, &pose, found.normal);
        assert!(
            (shown - found.signed_distance).abs() <= TOLERANCE * size(hulls),
            "{shown} {found:?}"
        );
        let normals = hulls[0]
            .face_ids()
            .map(|f| hulls[0].face_normal(f).normalize());
        let near_it = (0..50).map(|_| (found.normal + rng.direction() * 0.1).normalize());
        for n in normals.chain(near_it) {
            let other = separation(hulls, &pose, n);
            assert!(
                other <= found.signed_distance + TOLERANCE * size(hulls),
                "{n}: {other} {found:?}"
            );
        }
    });
}

#[test]
fn witness_points_are_in_their_shapes_and_apart_by_the_distance() {
    for_pairs(|pair, _| {
        let hulls = pair.hulls.each_ref().map(|h| build(h));
        let hulls = hulls.each_ref();
        let pose = RelativePose::new(&pair.pose).expect("finite");
        let found = near(hulls, &pair.pose, &PairMemory::None);
        let slack = TOLERANCE * size(hulls);
        assert!((found.normal.length() - 1.0).abs() < 1.0e-9);
        assert!(outside(hulls[0], found.on_1) <= slack, "{found:?}");
        assert!(
            outside(hulls[1], pose.point_to_2(found.on_2)) <= slack,
            "{found:?}"
        );
        let gap = found.normal.dot(found.on_2 - found.on_1);
        assert!(
            (gap - found.signed_distance).abs() <= slack,
            "{gap} {found:?}"
        );
    });
}

#[test]
fn swapping_the_shapes_changes_nothing() {
    for_pairs(|pair, _| {
        let hulls = pair.hulls.each_ref().map(|h| build(h));
        let [a, b] = hulls.each_ref();
        let there = near([a, b], &pair.pose, &PairMemory::None).signed_distance;
        // The inverse pose is rounded to f32.
        let back = near([b, a], &pair.pose.inverse(), &PairMemory::None).signed_distance;
        assert!(
            (there - back).abs() <= (TOLERANCE + SINGLE) * size([a, b]),
            "{there} {back}"
        );
        let shapes = pair.hulls.each_ref().map(|h| shape(h));
        let there = contact([&shapes[0], &shapes[1]], &pair.pose).dist;
        let back = contact([&shapes[1], &shapes[0]], &pair.pose.inverse()).dist;
        assert!(
            f64::from((there - back).abs()) <= (TOLERANCE + SINGLE) * size([a, b]),
            "{there} {back}"
        );
    });
}

#[test]
fn a_common_motion_changes_nothing() {
    for_pairs(|pair, rng| {
        let motion = pose(rng, 2.0);
        let shapes = pair.hulls.each_ref().map(|h| shape(h));
        let hulls = pair.hulls.each_ref().map(|h| build(h));
        let moved = motion.inv_mul(&(motion * pair.pose));
        let [before, after] =
            [pair.pose, moved].map(|p| contact([&shapes[0], &shapes[1]], &p).dist);
        let error = f64::from((before - after).abs());
        assert!(
            error <= (TOLERANCE + SINGLE) * size(hulls.each_ref()),
            "{before} {after}"
        );
    });
}

#[test]
fn scaling_by_a_power_of_two_scales_the_answer_exactly() {
    for_pairs(|pair, rng| {
        let exponent = rng.count(0, 39) as i32 - 20;
        let scale = 2.0_f32.powi(exponent);
        let scaled = pair.hulls.each_ref().map(|h| {
            let hull = build(h);
            let points: Vec<Vec3> = h.iter().map(|p| *p * scale).collect();
            [build(&points), hull]
        });
        let [[a, small_a], [b, small_b]] = &scaled;
        let pose = Pose::from_parts(pair.pose.translation * scale, pair.pose.rotation);
        let one = near([small_a, small_b], &pair.pose, &PairMemory::None);
        let many = near([a, b], &pose, &PairMemory::None);
        let factor = f64::from(scale);
        let error = (many.signed_distance - one.signed_distance * factor).abs();
        assert!(
            error <= 1.0e-12 * factor * size([small_a, small_b]),
            "{one:?} {many:?}"
        );
        assert!(
            many.normal.distance(one.normal) <= 1.0e-9,
            "{one:?} {many:?}"
        );
    });
}

#[test]
fn memory_changes_nothing() {
    for_pairs(|pair, rng| {
        let (before, nudge) = (pose(rng, 1.5), pose(rng, 0.01));
        let hulls = pair.hulls.each_ref().map(|h| build(h));
        let hulls = hulls.each_ref();
        let cold = near(hulls, &pair.pose, &PairMemory::None).signed_distance;
        // A memory of this very pose, of one near it, and of an unrelated one.
        let close = Pose::from_parts(
            pair.pose.translation + nudge.translation,
            pair.pose.rotation,
        );
        for old in [pair.pose, close, before] {
            let was = near(hulls, &old, &PairMemory::None);
            for memory in [
                PairMemory::Contact(was.normal, was.features),
                PairMemory::Axis(was.normal, Default::default()),
            ] {
                let warm = near(hulls, &pair.pose, &memory).signed_distance;
                assert!(
                    (warm - cold).abs() <= TOLERANCE * size(hulls),
                    "{cold} {warm} {memory:?}"
                );
            }
        }
    });
}

#[test]
fn the_dispatcher_says_what_the_query_says() {
    for_pairs(|pair, _| {
        let hulls = pair.hulls.each_ref().map(|h| build(h));
        let shapes = pair.hulls.each_ref().map(|h| shape(h));
        let found = near(hulls.each_ref(), &pair.pose, &PairMemory::None);
        let contact = contact([&shapes[0], &shapes[1]], &pair.pose);
        let limit = (TOLERANCE + SINGLE) * size(hulls.each_ref());
        assert!(
            (f64::from(contact.dist) - found.signed_distance).abs() <= limit,
            "{contact:?} {found:?}"
        );
        let on_2 = pair.pose * contact.point2;
        let gap = f64::from((on_2 - contact.point1).dot(contact.normal1));
        assert!(
            (gap - f64::from(contact.dist)).abs() <= limit,
            "{contact:?}"
        );
    });
}
