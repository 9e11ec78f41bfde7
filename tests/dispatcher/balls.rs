//! Pairs whose bounding spheres are apart: no vertex is read, nothing is kept, and nothing is lost when they
//! come near again.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::shape::SharedShape;
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, cold_manifold};

const PREDICTION: f32 = 0.01;

fn depth(manifold: &Manifold) -> Option<f32> {
    manifold.find_deepest_contact().map(|deepest| deepest.dist)
}

/// Hulls over a plane, from below it to high above, in either order.
#[test]
fn what_is_high_above_the_ground_is_known_by_its_ball() {
    let mut rng = Rng::new(81);
    let ground = SharedShape::halfspace(Vector::Y);
    let dispatcher = IsaGjkDispatcher::default();
    let (mut high, mut low) = (0, 0);
    for vertices in [4, 8, 40, 200] {
        let hull = rng.hull(vertices, 0.5).shape;
        for step in 0..100 {
            let height = 0.03 * step as f32 - 0.5;
            let turn = Rotation::from_scaled_axis(rng.direction().as_vec3());
            let pose = Pose::from_parts(Vector::new(3.0, height, -2.0), turn);
            let polyhedron = hull.as_convex_polyhedron().expect("a plain hull");
            let heights = polyhedron.points().iter().map(|&p| (pose * p).y);
            let lowest = heights.fold(f32::INFINITY, f32::min);
            for (pose, shapes) in [(pose, [&ground, &hull]), (pose.inverse(), [&hull, &ground])] {
                let before = dispatcher.stats();
                let manifold = cold_manifold(&dispatcher, &pose, shapes, PREDICTION);
                let stats = dispatcher.stats().since(&before);
                if stats.answered[Stage::BoundingSpheres as usize] == 1 {
                    assert_eq!(stats.supports, 0);
                    assert!(lowest > PREDICTION, "{lowest} above the ground");
                    high += 1;
                }
                let deepest = depth(&manifold.expect("supported"));
                let deepest = deepest.unwrap_or(f32::INFINITY);
                if lowest < 0.99 * PREDICTION {
                    assert!((deepest - lowest).abs() < 1e-5, "{deepest} for {lowest}");
                    low += 1;
                } else if lowest > 1.01 * PREDICTION {
                    assert_eq!(deepest, f32::INFINITY, "apart by {lowest}");
                }
            }
        }
    }
    assert!(high > 200 && low > 100, "{high} high, {low} low");
}

/// A pair that meets, parts until its balls are apart, and meets again on another side has the contacts
/// of a pair that is new.
#[test]
fn a_pair_that_comes_back_has_the_contacts_of_a_new_one() {
    let mut rng = Rng::new(82);
    let dispatcher = IsaGjkDispatcher::default();
    let mut met = 0;
    for _ in 0..60 {
        let shapes = [24, 120].map(|vertices| rng.hull(vertices, 1.0).shape);
        let shapes = shapes.each_ref();
        let mut memory = Memory::default();
        for _ in 0..4 {
            let direction = rng.direction().as_vec3();
            let turn = Rotation::from_scaled_axis(rng.direction().as_vec3());
            for distance in [3.0, 0.6, 0.5, 3.0] {
                let pose = Pose::from_parts(direction * distance, turn);
                let new = cold_manifold(&dispatcher, &pose, shapes, PREDICTION);
                let kept = memory.update(&dispatcher, &pose, shapes, PREDICTION);
                let [kept, new] = [kept, new.as_ref()].map(|m| depth(m.expect("supported")));
                assert_eq!(kept.is_none(), new.is_none());
                if let (Some(kept), Some(new)) = (kept, new) {
                    assert!((kept - new).abs() < 1e-5);
                    met += 1;
                }
            }
        }
    }
    assert!(met > 200, "{met} contacts");
}
