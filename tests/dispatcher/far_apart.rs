//! Shapes that point at each other with what reaches farthest meet as early as their reach allows.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::shape::{ShapeType, SharedShape};
use testkit::memory::cold_manifold;

const PREDICTION: Real = 0.02;

/// A shape, and its farthest point from its origin.
fn shapes() -> Vec<(SharedShape, Vector)> {
    let (half_height, radius, border) = (0.4, 0.3, 0.05);
    let half_extents = Vector::new(0.5, 0.2, 0.3);
    let [x, y, z] = half_extents.to_array();
    let rim = Vector::new(radius, -half_height, 0.0);
    let rounded = |corner: Vector| corner + corner.normalize() * border;
    let end = Vector::new(0.1, 0.6, -0.2);
    let capsule_end = end + end.normalize() * radius;
    vec![
        (SharedShape::ball(radius), Vector::X * radius),
        (SharedShape::capsule(Vector::ZERO, end, radius), capsule_end),
        (SharedShape::cuboid(x, y, z), half_extents),
        (
            SharedShape::round_cuboid(x, y, z, border),
            rounded(half_extents),
        ),
        (SharedShape::cylinder(half_height, radius), rim),
        (SharedShape::cone(half_height, radius), rim),
        (
            SharedShape::round_cylinder(half_height, radius, border),
            rounded(rim),
        ),
        (
            SharedShape::round_cone(half_height, radius, border),
            rounded(rim),
        ),
    ]
}

fn is_ours(shapes: [&SharedShape; 2]) -> bool {
    use ShapeType::{Capsule, Cone, Cylinder, RoundCone, RoundCylinder};
    let kinds = shapes.map(|shape| shape.shape_type());
    let is_curved = |kind| matches!(kind, Cylinder | Cone | RoundCylinder | RoundCone);
    kinds == [Capsule; 2] || kinds.into_iter().any(is_curved)
}

#[test]
fn what_reaches_farthest_is_met_in_time() {
    let mut far = 0;
    for (first, on_1) in &shapes() {
        for (second, on_2) in &shapes() {
            if !is_ours([first, second]) {
                continue;
            }
            let turn = Rotation::from_rotation_arc(on_2.normalize(), -on_1.normalize());
            for (gap, meets) in [(0.98 * PREDICTION, true), (1.1 * PREDICTION, false)] {
                let way = on_1.length() + on_2.length() + gap;
                let pose = Pose::from_parts(on_1.normalize() * way, turn);
                let us = IsaGjkDispatcher::default();
                let shapes = [first, second];
                let manifold = cold_manifold(&us, &pose, shapes, PREDICTION).expect("supported");
                let kinds = shapes.map(|shape| shape.shape_type());
                let deepest = manifold.find_deepest_contact();
                assert_eq!(deepest.is_some(), meets, "{kinds:?} at {gap}");
                if let Some(contact) = deepest {
                    let error = (contact.dist - gap).abs();
                    assert!(error < 1e-5, "{kinds:?}: {} of {gap}", contact.dist);
                }
                far += us.stats().answered[Stage::BoundingSpheres as usize];
            }
        }
    }
    assert!(far > 20, "the reach proved only {far} pairs apart");
}
