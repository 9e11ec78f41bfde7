//! Boxes pressed into compounds whose parts touch or overlap a little, over the seams. The whole has a flat
//! upper side, and its borders are far away: the only way out is up, by the depth of the lowest corner.

use glam::{DQuat, DVec3};
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::shape::{Compound, CompoundFlags, SharedShape};
use testkit::budget;
use testkit::generate::Rng;
use testkit::memory::{Manifold, UpdateManifolds};

/// Half of the side of the whole.
const HALF: f64 = 2.0;

fn box_between(low: DVec3, high: DVec3) -> SharedShape {
    let corners: Vec<Vector> = corners(low, high).map(|p| p.as_vec3()).collect();
    SharedShape::convex_hull(&corners).expect("a box")
}

fn corners(low: DVec3, high: DVec3) -> impl Iterator<Item = DVec3> {
    (0..8u32).map(move |i| {
        let mask = DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into());
        low + (high - low) * mask
    })
}

/// Rows of boxes side by side, each cut in two somewhere. Cuts need not meet, and boxes reach into the
/// next by up to 2 cm. Prepared hulls are among them.
fn ground(rng: &mut Rng) -> SharedShape {
    let mut parts = Vec::new();
    let mut cuts = vec![-HALF];
    while cuts[cuts.len() - 1] < HALF - 0.4 {
        cuts.push(cuts[cuts.len() - 1] + rng.range(0.05, 0.3));
    }
    cuts.push(HALF);
    for cut in cuts.windows(2) {
        let middle = rng.range(-0.3, 0.3);
        for along_z in [[-HALF, middle], [middle, HALF]] {
            let mut overlap = || rng.range(0.0, 0.01);
            let low = DVec3::new(cut[0] - overlap(), -1.0 - overlap(), along_z[0] - overlap());
            let high = DVec3::new(cut[1] + overlap(), 0.0, along_z[1] + overlap());
            let part = box_between(low, high);
            let is_prepared = rng.count(0, 1) == 0;
            let polyhedron = part.as_convex_polyhedron().expect("a hull").clone();
            let part = if is_prepared {
                SharedShape::new(HullShape::try_from(polyhedron).expect("a solid"))
            } else {
                part
            };
            parts.push((Pose::IDENTITY, part));
        }
    }
    let flags = CompoundFlags::FIX_INTERNAL_EDGES;
    SharedShape::new(Compound::with_flags(parts, flags, None))
}

#[test]
fn what_is_pressed_in_over_a_seam_is_pushed_out_of_the_whole() {
    let mut rng = Rng::new(41 + u128::from(budget::seed()));
    for round in budget::turns(300) {
        let ground = ground(&mut rng);
        let half = DVec3::new(
            rng.range(0.02, 0.4),
            rng.range(0.02, 0.2),
            rng.range(0.02, 0.4),
        );
        let depth = rng.range(1e-3, 0.05);
        let yaw = DQuat::from_rotation_y(rng.range(-3.0, 3.0));
        let tilt = DQuat::from_axis_angle(rng.direction(), rng.range(0.0, 0.1));
        let turn = yaw
            * if rng.count(0, 1) == 0 {
                tilt
            } else {
                DQuat::IDENTITY
            };
        let lowest = corners(-half, half).map(|p| (turn * p).y);
        let height = -depth - lowest.fold(f64::INFINITY, f64::min);
        let place = DVec3::new(rng.range(-0.5, 0.5), height, rng.range(-0.5, 0.5));
        let pose = Pose::from_parts(place.as_vec3(), Rotation::from(turn.as_quat()));
        let pressed = box_between(-half, half);

        let mut manifolds: Vec<Manifold> = Vec::new();
        IsaGjkDispatcher::default()
            .update_manifolds(
                &pose,
                [&*ground, &*pressed],
                0.002,
                &mut manifolds,
                &mut None,
            )
            .expect("supported");
        let what = format!("{round}: {half} at {pose:?}");
        let mut deepest: f64 = 0.0;
        for manifold in manifolds.iter().filter(|m| !m.points.is_empty()) {
            let normal = manifold.local_n1;
            assert!(normal.y > 0.99, "{what}: {normal}");
            let depths = manifold.points.iter().map(|point| f64::from(-point.dist));
            deepest = depths.fold(deepest, f64::max);
        }
        assert!((deepest - depth).abs() < 1e-4, "{what}: {deepest}, {depth}");
    }
}
