//! A pair that is apart keeps its axis where it stays: with the larger shape.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::shape::{Shape, SharedShape};
use testkit::generate::Rng;
use testkit::memory::{Manifold, UpdateManifolds};

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
