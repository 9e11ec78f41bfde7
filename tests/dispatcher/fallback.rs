//! Pairs that are left to the fallback dispatcher, and their counts.

use std::sync::atomic::Ordering;

use isa_gjk::{IsaGjkDispatcher, Left};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::QueryDispatcher;
use parry3d::shape::{ConvexPolyhedron, Cuboid, SharedShape};
use testkit::generate::Rng;
use testkit::memory::{UpdateManifolds, cold_manifold};
use testkit::silent::Silent;

fn hull() -> SharedShape {
    Rng::new(7).hull(12, 1.0).shape
}

/// A plate too thin to be a solid in f32.
fn flat() -> SharedShape {
    let (corners, faces) = Cuboid::new(Vector::new(1.0, 1.0, 1e-7)).to_trimesh();
    let flat = ConvexPolyhedron::from_convex_mesh(corners, &faces);
    SharedShape::new(flat.expect("a closed surface"))
}

/// A surface over these corners, which no builder has checked.
fn unchecked(corners: &[Vector], faces: &[[u32; 3]]) -> SharedShape {
    let hull = ConvexPolyhedron::from_convex_mesh(corners.to_vec(), faces);
    SharedShape::new(hull.expect("a closed surface"))
}

fn three_points() -> SharedShape {
    let corners = [Vector::ZERO, Vector::X, Vector::Z];
    unchecked(&corners, &[[0, 1, 2], [0, 2, 1]])
}

fn not_a_number() -> SharedShape {
    let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::splat(Real::NAN)];
    unchecked(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
}

#[test]
fn only_what_is_not_ours_reaches_the_fallback() {
    let silent = Silent::default();
    let dispatcher = IsaGjkDispatcher::with_fallback(silent.clone());
    let near = Pose::translation(0.4, 0.3, 0.2);
    let (hull, ball) = (hull(), SharedShape::ball(0.5));
    let compound = SharedShape::compound(vec![(Pose::IDENTITY, ball.clone())]);

    assert!(cold_manifold(&dispatcher, &near, [&hull, &ball], 0.1).is_some());
    assert!(dispatcher.distance(&near, &*hull, &*hull).is_ok());
    assert_eq!(silent.0.load(Ordering::Relaxed), 0, "these are ours");

    assert!(dispatcher.distance(&near, &*ball, &*ball).is_err());
    assert_eq!(silent.0.load(Ordering::Relaxed), 1);
    let (mut manifolds, workspace) = (Vec::new(), &mut None);
    let shapes = [&*compound, &*ball];
    let asked = dispatcher.update_manifolds(&near, shapes, 0.1, &mut manifolds, workspace);
    assert!(asked.is_ok(), "taking compounds apart is ours");
    assert_eq!(
        silent.0.load(Ordering::Relaxed),
        2,
        "their parts may not be"
    );
}

#[test]
fn pairs_are_counted_by_what_leaves_them() {
    let (hull, ball) = (hull(), SharedShape::ball(0.5));
    let near = Pose::translation(0.4, 0.3, 0.2);
    let nowhere = Pose::translation(Real::NAN, 0.0, 0.0);
    let degenerate = SharedShape::ball(-1.0);
    let capsule = SharedShape::capsule_y(0.5, 0.3);
    let cases = [
        (near, [&hull, &ball], None),
        (near, [&ball, &ball], Some(Left::NoHull)),
        (near, [&capsule, &capsule], None),
        (near, [&hull, &flat()], Some(Left::HullNotPrepared)),
        (near, [&flat(), &ball], Some(Left::HullNotPrepared)),
        (near, [&three_points(), &ball], Some(Left::HullNotPrepared)),
        (near, [&not_a_number(), &hull], Some(Left::HullNotPrepared)),
        (near, [&hull, &degenerate], Some(Left::OtherShape)),
        (near, [&SharedShape::cone(0.5, 0.5), &hull], None),
        (nowhere, [&hull, &hull], Some(Left::NotFinite)),
    ];
    for (pose, shapes, expected) in cases {
        let dispatcher = IsaGjkDispatcher::default();
        let _ = cold_manifold(&dispatcher, &pose, shapes, 0.1);
        let left = dispatcher.stats().left_to_fallback;
        let expected = Left::ALL.map(|why| u64::from(Some(why) == expected));
        let types = shapes.map(|shape| shape.shape_type());
        assert_eq!(left, expected, "{types:?} at {pose:?}");
    }
}
