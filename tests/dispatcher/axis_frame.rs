//! A pair that is apart keeps its axis where it stays: with the larger shape.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::shape::{Shape, ShapeType, SharedShape};
use testkit::generate::Rng;
use testkit::memory::{Manifold, UpdateManifolds};
use testkit::scenes::hulls;

const FRAMES: u64 = 60;

/// Steps a hull that tumbles beside a wall, and counts the answers that came from the axis.
fn answers_by_axis(shapes: [&dyn Shape; 2], pose: impl Fn(Real) -> Pose) -> u64 {
    let dispatcher = IsaGjkDispatcher::default();
    let mut manifolds: Vec<Manifold> = Vec::new();
    for frame in 0..FRAMES {
        let [a, b] = shapes;
        dispatcher
            .update_manifolds(
                &pose(frame as Real),
                [a, b],
                0.01,
                &mut manifolds,
                &mut None,
            )
            .expect("supported");
        assert!(
            manifolds[0].points.is_empty(),
            "the hull is beside the wall"
        );
    }
    let stats = dispatcher.stats();
    assert_eq!(
        stats.answered[Stage::BoundingSpheres as usize],
        0,
        "the wall is long"
    );
    stats.answered[Stage::Axis as usize]
}

/// In the hull's own frame the axis would turn away by a quarter of a radian in each frame, along which a
/// long wall reaches far.
#[test]
fn a_hull_that_tumbles_along_a_wall_is_apart_by_its_axis() {
    let mut rng = Rng::new(5);
    let hull = rng.hull(40, 0.5).shape;
    let wall = SharedShape::cuboid(20.0, 20.0, 0.5);
    let of_hull = |frame: Real| {
        let along = Vector::new(0.05 * frame - 1.5, 2.0, 1.2);
        Pose::from_parts(
            along,
            Rotation::from_scaled_axis(Vector::new(0.2, 0.15, 0.0) * frame),
        )
    };
    // The first frame knows no axis.
    assert!(answers_by_axis([&*wall, &*hull], of_hull) >= FRAMES - 1);
    assert!(answers_by_axis([&*hull, &*wall], |frame| of_hull(frame).inverse()) >= FRAMES - 1);
}

/// As in parry, what an empty manifold says is in the frame of the first shape, however that tumbles.
#[test]
fn the_axis_leads_from_the_first_shape_to_the_second_in_the_frame_of_the_first() {
    let mut rng = Rng::new(6);
    let small = [rng.hull(40, 0.5).shape, SharedShape::cylinder(0.2, 0.5)];
    let half = Vector::new(20.0, 20.0, 0.5);
    let walls = [
        SharedShape::cuboid(half.x, half.y, half.z),
        hulls::cuboid(half).expect("a solid"),
        SharedShape::halfspace(Vector::Z),
    ];
    let is_answered = |a: &SharedShape, b: &SharedShape| {
        let is_hull = |shape: &SharedShape| shape.shape_type() == ShapeType::ConvexPolyhedron;
        is_hull(a) || is_hull(b) || b.shape_type() != ShapeType::HalfSpace
    };
    for (wall, hull) in walls
        .iter()
        .flat_map(|wall| small.each_ref().map(|hull| (wall, hull)))
    {
        for wall_first in [true, false]
            .into_iter()
            .filter(|_| is_answered(hull, wall))
        {
            let (dispatcher, mut manifolds) = (IsaGjkDispatcher::default(), Vec::<Manifold>::new());
            for frame in 0..FRAMES {
                let turn = Vector::new(0.2, 0.15, 0.0) * frame as Real;
                // Now and then it is so near that the bounding spheres do not tell.
                let height = 1.25 + 0.1 * (0.3 * frame as Real).sin();
                let of_hull = Pose::from_parts(
                    Vector::new(0.3, 2.0, height),
                    Rotation::from_scaled_axis(turn),
                );
                let (pos12, shapes, rotation) = if wall_first {
                    (of_hull, [wall, hull], Rotation::IDENTITY)
                } else {
                    (of_hull.inverse(), [hull, wall], of_hull.rotation)
                };
                dispatcher
                    .update_manifolds(
                        &pos12,
                        shapes.map(|s| &**s),
                        0.01,
                        &mut manifolds,
                        &mut None,
                    )
                    .expect("supported");
                let n1 = rotation * manifolds[0].local_n1;
                let away = if wall_first { n1.z } else { -n1.z };
                let what = (wall.shape_type(), hull.shape_type(), wall_first, frame);
                assert!(manifolds[0].points.is_empty(), "{what:?}");
                assert!(n1 == Vector::ZERO || away > 0.5, "{what:?}: {n1}");
                assert!(
                    n1 == Vector::ZERO || (n1.length() - 1.0).abs() < 1e-5,
                    "{n1}"
                );
            }
        }
    }
}
