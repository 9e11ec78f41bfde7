//! Boxes as hulls that overlap deeply: their separating axes prove the depth, and no polytope is needed.

use glam::{DQuat, DVec3};
use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Real, Vector};
use testkit::cases::Hull;
use testkit::generate::{Rng, hull_of};
use testkit::memory::{Manifold, UpdateManifolds};
use testkit::oracle::signed_distance;
use testkit::pose::ExactPose;

const FRAMES: usize = 12;

/// A box about a place, turned if `is_turned`; the corners are rounded to f32.
fn turned_box(rng: &mut Rng, half: DVec3, is_turned: bool) -> Hull {
    let place = rng.direction() * rng.range(0.0, 0.2);
    loop {
        let turn = if is_turned {
            rng.rotation()
        } else {
            DQuat::IDENTITY
        };
        let corner = |i: usize| {
            let signs = [1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 });
            (place + turn * (half * DVec3::from(signs))).as_vec3()
        };
        let corners: Vec<Vector> = (0..8).map(corner).collect();
        if let Some(hull) = hull_of(&corners) {
            return hull;
        }
    }
}

fn size(rng: &mut Rng) -> DVec3 {
    let [x, y, z] = [(); 3].map(|()| rng.range(0.3, 0.9));
    let thin = [1.0, 1.0, 0.05, 0.01][rng.count(0, 3)];
    DVec3::new(x, y, z * thin)
}

/// A pair that overlaps by up to the size of the smaller box while it turns and moves.
fn overlapping(rng: &mut Rng) -> Vec<ExactPose> {
    let (from, way) = (rng.direction() * rng.range(0.0, 0.9), rng.direction());
    let (turn, spin) = (rng.rotation(), rng.direction());
    // Boxes that lie square on each other have parallel edges.
    let turn = if rng.count(0, 4) == 0 {
        DQuat::IDENTITY
    } else {
        turn
    };
    (0..FRAMES)
        .map(|frame| {
            let share = frame as f64;
            ExactPose {
                rotation: DQuat::from_axis_angle(spin, 0.01 * share) * turn,
                translation: from + way * (0.004 * share),
            }
            .rounded()
        })
        .collect()
}

#[test]
fn deep_boxes_are_as_deep_as_the_oracle_says() {
    let mut rng = Rng::new(17);
    let dispatcher = IsaGjkDispatcher::default();
    let mut overlaps = 0;
    for round in 0..300 {
        let [a, b] = [0, 1].map(|i| {
            let half = size(&mut rng);
            turned_box(&mut rng, half, (round >> i) % 2 == 0)
        });
        let mut manifolds: Vec<Manifold> = Vec::new();
        for pose in overlapping(&mut rng) {
            let exact = signed_distance(&a.solid, &b.solid, &pose);
            dispatcher
                .update_manifolds(
                    &pose.to_f32(),
                    [&*a.shape, &*b.shape],
                    0.02,
                    &mut manifolds,
                    &mut None,
                )
                .expect("supported");
            let depths = manifolds[0].points.iter().map(|point| point.dist);
            let Some(found) = depths.reduce(Real::min) else {
                assert!(exact > 0.019, "{exact} is not found");
                continue;
            };
            // The promised accuracy.
            let error = (f64::from(found) - exact).abs();
            assert!(error < 2e-5, "{found} instead of {exact} in round {round}");
            overlaps += usize::from(exact < -0.1);
        }
    }
    assert!(overlaps > 1000, "only {overlaps} deep overlaps");
}

/// Before, 9 of 10 were left to cached polytopes, and the others to searches.
#[test]
fn deep_boxes_need_no_polytope() {
    let mut rng = Rng::new(23);
    let dispatcher = IsaGjkDispatcher::default();
    for round in 0..100 {
        let shapes = [0, 1].map(|_| {
            let half = DVec3::new(rng.range(0.4, 0.9), rng.range(0.4, 0.9), 0.6);
            turned_box(&mut rng, half, round % 2 == 0).shape
        });
        let mut manifolds: Vec<Manifold> = Vec::new();
        for pose in overlapping(&mut rng) {
            dispatcher
                .update_manifolds(
                    &pose.to_f32(),
                    [&*shapes[0], &*shapes[1]],
                    0.02,
                    &mut manifolds,
                    &mut None,
                )
                .expect("supported");
        }
    }
    let answered = dispatcher.stats().answered;
    let [cached, searched] =
        [Stage::CachedPolytope, Stage::WarmEpa].map(|stage| answered[stage as usize]);
    let all: u64 = answered.iter().sum();
    assert!(cached * 100 < all, "{cached} of {all} need a polytope");
    assert!(searched * 10 < all, "{searched} of {all} need a search");
}
