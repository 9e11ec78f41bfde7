//! Old bugs of parry between convex shapes, with our dispatcher and hulls.
//!
//! Each test opens with the story of an issue at <https://github.com/dimforge/parry>.

use std::f32::consts::{FRAC_PI_4, FRAC_PI_6, SQRT_2, TAU};

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    ClosestPoints, Contact, ContactManifold, QueryDispatcher, ShapeCastHit, ShapeCastOptions,
    ShapeCastStatus,
};
use parry3d::shape::{Shape, SharedShape};
use testkit::memory::{Manifold, UpdateManifolds};

fn us() -> IsaGjkDispatcher {
    IsaGjkDispatcher::default()
}

fn hull(points: &[[Real; 3]]) -> SharedShape {
    let points: Vec<Vector> = points.iter().map(|p| Vector::from_array(*p)).collect();
    SharedShape::convex_hull(&points).expect("a solid")
}

fn block(x: Real, y: Real, z: Real) -> SharedShape {
    let side = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i| [x * side(i, 0), y * side(i, 1), z * side(i, 2)];
    hull(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner))
}

/// An upright prism over a regular polygon of 64 sides.
fn drum(half_height: Real, radius: Real) -> SharedShape {
    let corner = |i: u32| {
        let (sin, cos) = (TAU * (i / 2) as Real / 64.0).sin_cos();
        let up = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        [radius * cos, half_height * up, radius * sin]
    };
    hull(&(0..128).map(corner).collect::<Vec<_>>())
}

fn contact(pos12: Pose, g1: &dyn Shape, g2: &dyn Shape) -> Option<Contact> {
    us().contact(&pos12, g1, g2, 0.0).expect("supported")
}

fn distance(pos12: Pose, g1: &dyn Shape, g2: &dyn Shape) -> Real {
    us().distance(&pos12, g1, g2).expect("supported").distance
}

fn meet(pos12: Pose, g1: &dyn Shape, g2: &dyn Shape) -> bool {
    let test = us().intersection_test(&pos12, g1, g2);
    test.expect("supported").intersecting
}

fn cast(
    pos12: Pose,
    velocity: Vector,
    shapes: [&dyn Shape; 2],
    options: ShapeCastOptions,
) -> Option<ShapeCastHit> {
    let hit = us().cast_shapes(&pos12, velocity, shapes[0], shapes[1], options);
    hit.expect("supported")
}

fn assert_close(a: Vector, b: Vector) {
    assert!(a.distance(b) < 1.0e-4, "{a} is not {b}");
}

/// Issue 157: of two view frustums of a game, one 300 times as large as the other, a single
/// corner of one is in the other; GJK saw it, but EPA gave up, and there was no contact.
#[test]
fn issue_157_a_corner_in_a_frustum() {
    let small = hull(&[
        [-0.7938391, 5.1101756, 0.1773476],
        [-5.293839, 0.6101756, -4.3226523],
        [-5.293839, 0.6101756, 5.6773477],
        [-0.7938391, 5.1101756, 1.1773477],
        [-0.7938391, 6.1101756, 0.1773476],
        [-5.293839, 10.610176, -4.3226523],
        [-5.293839, 10.610176, 5.6773477],
        [-0.7938391, 6.1101756, 1.1773477],
    ]);
    let large = hull(&[
        [8.114634, 4.6308937, 0.76987207],
        [-18.83664, -53.96347, -649.29565],
        [-608.7832, -53.96347, -208.59384],
        [6.93474, 4.6308937, 1.6512758],
        [8.253552, 5.426136, 0.9558364],
        [50.62288, 343.65768, -556.3136],
        [-539.3237, 343.65768, -115.611725],
        [7.073659, 5.426136, 1.8372401],
    ]);
    for [a, b] in [[&small, &large], [&large, &small]] {
        let found = contact(Pose::IDENTITY, &**a, &**b).expect("a contact");
        // Brute force over face normals and edge pairs says the same.
        assert!((found.dist + 2.873462).abs() < 1.0e-3, "{found:?}");
        assert!(meet(Pose::IDENTITY, &**a, &**b));
    }
}

/// Issue 157 too: frustums a hundred kilometres deep.
#[test]
fn issue_157_frustums_a_hundred_kilometres_deep() {
    let a = hull(&[
        [0.45838028, 5.7372417, 0.61019015],
        [1000.35846, -994.1628, 1000.51013],
        [1000.35834, -994.1628, -999.48987],
        [0.45838028, 5.7372417, 0.41019014],
        [0.45838028, 5.9372416, 0.61019015],
        [1000.35846, 1005.8372, 1000.51013],
        [1000.35834, 1005.8372, -999.48987],
        [0.45838028, 5.9372416, 0.41019014],
    ]);
    let b = hull(&[
        [-0.4522132, 8.780189, 15.508082],
        [72537.12, -72390.1, -81439.88],
        [-74725.21, -72390.1, -79438.195],
        [-0.45368585, 8.780189, 15.508101],
        [-0.45221695, 8.780969, 15.507806],
        [72161.625, 5710.25, -109064.305],
        [-75100.7, 5710.25, -107062.62],
        [-0.4536896, 8.780969, 15.507825],
    ]);
    assert!(meet(Pose::IDENTITY, &*a, &*b));
    assert!(meet(Pose::IDENTITY, &*b, &*a));
}

/// Issue 315: two boxes that exactly touch had an arbitrary contact, because the very first
/// support point was the origin.
#[test]
fn issue_315_boxes_that_exactly_touch() {
    let cube = block(0.5, 0.5, 0.5);
    for side in [1.0, -1.0] {
        let pos12 = Pose::translation(side, 0.0, 0.0);
        let touch = contact(pos12, &*cube, &*cube).expect("a contact");
        assert!(touch.dist.abs() < 1.0e-6, "{touch:?}");
        assert_close(touch.normal1, Vector::X * side);
        assert_close(touch.normal2, -Vector::X * side);
        for point in [touch.point1, -touch.point2] {
            assert!((point.x - 0.5 * side).abs() < 1.0e-6, "{touch:?}");
            assert!(point.y.abs().max(point.z.abs()) < 0.500_001, "{touch:?}");
        }
    }
    let overlap = contact(Pose::translation(0.7, 0.0, 0.0), &*cube, &*cube).expect("a contact");
    assert!((overlap.dist + 0.3).abs() < 1.0e-6, "{overlap:?}");
}

/// Issues 431 and 436: the distance of two boxes depended on which came first, where a corner
/// of the larger one is beside the face of the smaller.
#[test]
fn issue_431_distances_from_both_sides() {
    let cube = block(1.0, 1.0, 1.0);
    let plate = block(1.0, 2.0, 2.0);
    let turned = |x, y, z, turn| Pose::new(Vector::new(x, y, z), turn);
    let (sin, cos) = FRAC_PI_6.sin_cos();
    let edges = (4.0 - cos - sin).hypot(4.0 - cos + sin);
    let cases = [
        (&plate, Pose::translation(-5.573167, 0.0, 0.0), 3.573167),
        (&plate, Pose::translation(2.0, 0.0, 0.0), 0.0),
        (&plate, Pose::translation(1.5, 0.0, 0.0), 0.0),
        (
            &cube,
            turned(4.0, 4.0, 0.0, Vector::Z * FRAC_PI_4),
            3.0 * SQRT_2 - 1.0,
        ),
        (&cube, turned(5.0, 0.0, 5.0, Vector::Y * FRAC_PI_6), edges),
        (&cube, Pose::translation(5.0, 4.0, 3.0), Real::sqrt(14.0)),
    ];
    for (other, pos12, expected) in cases {
        let there = distance(pos12, &*cube, &**other);
        let back = distance(pos12.inverse(), &**other, &*cube);
        for found in [there, back] {
            assert!(
                (found - expected).abs() < 2.0e-6,
                "{found} is not {expected}"
            );
        }
    }
}

/// Issue 396: drums on one axis, the small one within the large one, did not intersect: support
/// points along the axis made the simplex stall.
#[test]
fn issue_396_drums_on_one_axis() {
    let (large, small) = (drum(50.0, 100.0), drum(1.5, 1.0));
    let inside = [
        [0.0, 0.0, 0.0],
        [0.01, 0.0, 0.0],
        [0.0, 0.01, 0.0],
        [3.0, 5.0, -2.0],
    ];
    for place in inside {
        let pos12 = Pose::from_translation(Vector::from_array(place));
        assert!(meet(pos12, &*large, &*small), "{place:?}");
    }
    for angle in [0.01, 0.5, TAU / 4.0] {
        assert!(
            meet(Pose::rotation(Vector::Z * angle), &*large, &*small),
            "{angle}"
        );
    }
    for place in [
        [0.0, 51.6, 0.0],
        [0.0, 200.0, 0.0],
        [101.1, 0.0, 0.0],
        [500.0, 0.0, 0.0],
    ] {
        let pos12 = Pose::from_translation(Vector::from_array(place));
        assert!(!meet(pos12, &*large, &*small), "{place:?}");
    }
}

/// Issue 387: the box by which parts are chosen was mirrored, so that parts far from a
/// compound's origin were missed one way round.
#[test]
fn issue_387_parts_far_from_the_origin() {
    let part = block(1.0, 1.0, 1.0);
    let compound = SharedShape::compound(vec![
        (Pose::translation(5.0, 0.0, 0.0), part.clone()),
        (Pose::translation(-5.0, -2.0, 0.0), part.clone()),
    ]);
    let above = Pose::translation(5.0, 2.5, 0.0);
    let ask = |pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape| {
        let contact = us().contact(pos12, g1, g2, 1.5).expect("supported");
        contact.expect("within the prediction distance")
    };
    let there = ask(&above, &*compound, &*part);
    let back = ask(&above.inverse(), &*part, &*compound);
    for (dist, normal) in [(there.dist, there.normal1), (back.dist, back.normal2)] {
        assert!((dist - 0.5).abs() < 1.0e-6, "{there:?} {back:?}");
        assert_close(normal, Vector::Y);
    }
    assert!((there.point1.y - 1.0).abs() < 1.0e-6, "{there:?}");
}

/// Issue 79: shapes farther apart than the maximum distance made the search through a mesh panic.
#[test]
fn issue_79_a_mesh_out_of_reach() {
    let corners = [[1.0, -1.0, 0.0], [-1.0, -1.0, 0.0], [0.0, -1.0, 1.0]];
    let corners = corners.map(Vector::from_array);
    let mesh = SharedShape::trimesh(corners.into(), vec![[0, 1, 2]]).expect("a mesh");
    let drum = drum(0.5, 1.0);
    let ask = |reach: Real| us().closest_points(&Pose::IDENTITY, &*drum, &*mesh, reach);
    assert!(matches!(ask(0.49), Ok(ClosestPoints::Disjoint)));
    let Ok(ClosestPoints::WithinMargin(p1, p2)) = ask(0.6) else {
        panic!("{:?}", ask(0.6));
    };
    assert!((p1.distance(p2) - 0.5).abs() < 1.0e-6, "{p1} {p2}");
}

/// Issue 106: a cast that begins in exact touch was called penetrating.
#[test]
fn issue_106_casts_that_begin_in_touch() {
    let cube = block(1.0, 1.0, 1.0);
    for geometry in [true, false] {
        let options = ShapeCastOptions {
            compute_impact_geometry_on_penetration: geometry,
            ..ShapeCastOptions::default()
        };
        let status = |height| {
            let pos12 = Pose::translation(0.0, height, 0.0);
            let hit = cast(pos12, -Vector::Y, [&*cube, &*cube], options);
            hit.expect("a hit").status
        };
        assert_eq!(status(2.0), ShapeCastStatus::Converged);
        let within = ShapeCastStatus::PenetratingOrWithinTargetDist;
        assert_eq!(status(1.875), within);
    }
}

/// Issue 193: casts from a slight overlap reported normals far from the face's.
#[test]
fn issue_193_normals_of_casts_from_a_slight_overlap() {
    let (ground, cube) = (block(20.0, 1.0, 20.0), block(0.5, 0.5, 0.5));
    for depth in [0.01, 0.02, 0.2, 0.200001] {
        let pos12 = Pose::translation(0.0, 1.5 - depth, 0.0);
        let velocity = Vector::new(0.1, 1.0, 0.0);
        let options = ShapeCastOptions::default();
        let hit = cast(pos12, velocity, [&*ground, &*cube], options).expect("a hit");
        assert_close(hit.normal1, Vector::Y);
        assert_close(hit.normal2, -Vector::Y);
    }
}

/// Issue 429: the time of impact was short by an amount that grew with the ground.
#[test]
fn issue_429_times_of_impact_on_large_grounds() {
    let probe = block(0.3, 0.5166, 0.3);
    for half_width in [5.0, 50.0, 500.0] {
        let ground = block(half_width, 0.5, half_width);
        for i in 0..200 {
            let height = 1.177 + i as Real * 5.0e-5;
            let pos12 = Pose::translation(1.4, height + 0.5, -2.0);
            let options = ShapeCastOptions::with_max_time_of_impact(2.0);
            let hit = cast(pos12, -Vector::Y, [&*ground, &*probe], options).expect("a hit");
            let late = hit.time_of_impact - (height - 0.5166);
            assert!(late.abs() < 2.0e-6, "{late} late on {half_width}");
            assert!((hit.witness1.y - 0.5).abs() < 1.0e-6, "{hit:?}");
            assert_close(hit.normal1, Vector::Y);
        }
    }
}

/// Issues 26 and 141: a target distance ends a cast earlier, and what stands still or leaves
/// hits nothing.
#[test]
fn issues_26_and_141_targets_and_still_objects() {
    let cube = block(0.5, 0.5, 0.5);
    let time = |speed: Real, target_distance: Real| {
        let options = ShapeCastOptions {
            target_distance,
            ..ShapeCastOptions::default()
        };
        let pos12 = Pose::translation(0.0, 3.0, 0.0);
        let hit = cast(pos12, Vector::Y * speed, [&*cube, &*cube], options);
        hit.map(|hit| hit.time_of_impact)
    };
    assert_eq!(time(0.0, 0.0), None);
    assert_eq!(time(1.0, 0.0), None);
    assert!((time(-1.0, 0.0).expect("a hit") - 2.0).abs() < 1.0e-6);
    assert!((time(-1.0, 0.5).expect("a hit") - 1.5).abs() < 1.0e-6);
}

fn manifold(pos12: &Pose, shapes: [&dyn Shape; 2], prediction: Real) -> Manifold {
    let mut manifold = ContactManifold::new();
    let [g1, g2] = shapes;
    us().update_manifold(pos12, [g1, g2], [None, None], prediction, &mut manifold)
        .expect("supported");
    manifold
}

/// Issue 166 (and rapier's 810): of a face with many corners only some counted, so that a small
/// cube near a disc's rim stood on one point and fell through.
#[test]
fn issue_166_cubes_near_the_rim_of_a_disc() {
    let (disc, cube) = (drum(0.05, 10.0), block(0.05, 0.05, 0.05));
    for (x, z) in [
        (0.0, 0.0),
        (3.0, -2.0),
        (5.54, 4.51),
        (-5.65, 5.65),
        (7.0, 7.0),
        (9.9, 0.0),
    ] {
        for gap in [-0.001, 0.0001] {
            let pos12 = Pose::translation(x, 0.1 + gap, z);
            let manifold = manifold(&pos12, [&*disc, &*cube], 0.01);
            assert!(
                manifold.points.len() >= 3,
                "{} points",
                manifold.points.len()
            );
            assert_close(manifold.local_n1, Vector::Y);
        }
    }
}

/// Issues 246 and 253: a triangle whose corner touches another one's edge made EPA crash. Ours
/// is a thin wedge with that corner.
#[test]
fn issue_246_a_corner_on_a_long_triangle() {
    let corners = [
        Vector::new(-13.174434, 1.0, 8.736801),
        Vector::new(3.5251038, 1.0, 12.1),
        Vector::new(3.2048466, 1.0, 12.218325),
    ];
    let triangle = SharedShape::triangle(corners[0], corners[1], corners[2]);
    let wedge = hull(&[
        [-1.63, 0.0, 11.19],
        [-2.349647, 0.0, 11.037681],
        [-2.349647, 1.0, 11.037681],
        [-2.0, 0.0, 11.5],
    ]);
    let found = manifold(&Pose::IDENTITY, [&*triangle, &*wedge], 0.01);
    let deepest = found.find_deepest_contact().expect("a contact");
    assert!(deepest.dist.abs() < 1.0e-3, "{found:?}");
    assert!((deepest.local_p2.x + 2.349647).abs() < 1.0e-3, "{found:?}");
    assert!((deepest.local_p1.y - 1.0).abs() < 1.0e-3, "{found:?}");
}
