//! The nearest points of cylinders and cones to points outside, against the oracle.

use glam::DVec3;
use isa_gjk::internals::curved::SurfacePieces;
use isa_gjk::internals::primitive::{Cone, Cylinder};
use testkit::curved::Body;
use testkit::generate::Rng;

/// Of the sizes of both.
const TOLERANCE: f64 = 1e-12;
/// The step of a finite difference, and what it leaves of a slope.
const STEP: f64 = 1e-6;
const SLOPE: f64 = 1e-4;

/// Of a point that moves by `v`: the foot is as far as the oracle says, follows smoothly, and exists only outside.
/// Returns whether it does.
fn check(solid: &impl SurfacePieces, body: &Body, [p, v]: [DVec3; 2]) -> bool {
    let outside = body.outside(p);
    let Some(foot) = solid.foot(p, v) else {
        assert!(outside <= TOLERANCE, "{} has no foot below {p}", body.name);
        return false;
    };
    let off = p.distance(foot.at) - outside;
    assert!(off.abs() < TOLERANCE, "{}: {off} at {p}", body.name);
    let beside = [-STEP, STEP].map(|step| solid.foot(p + v * step, v));
    if let [Some(before), Some(after)] = beside {
        // Where the foot passes from one piece to another, it follows at either rate.
        let smooth = [foot, before, after].map(|foot| foot.following);
        let least = smooth.into_iter().fold(f64::INFINITY, f64::min);
        let most = smooth.into_iter().fold(0.0, f64::max);
        let rate = v.dot(after.at - before.at) / (2.0 * STEP);
        let is_between = least - SLOPE < rate && rate < most + SLOPE;
        assert!(is_between, "{}: {rate}, {smooth:?} at {p}", body.name);
    }
    true
}

#[test]
fn feet_are_nearest_and_follow() {
    let mut rng = Rng::new(771);
    let mut found = 0;
    for (half_height, radius) in [(0.5, 0.4), (0.05, 0.6), (1.5, 0.1)] {
        let bodies = [
            Body::cylinder(half_height, radius, 0.0),
            Body::cone(half_height, radius, 0.0),
        ];
        let [h, r] = [half_height, radius].map(f64::from);
        let (cylinder, cone) = (Cylinder::new(h, r), Cone::new(h, r));
        for _ in 0..2_000 {
            let moving = [rng.direction() * rng.range(0.05, 2.0), rng.direction()];
            found += usize::from(check(&cylinder, &bodies[0], moving));
            found += usize::from(check(&cone, &bodies[1], moving));
        }
    }
    assert!(found > 6_000, "{found}");
}
