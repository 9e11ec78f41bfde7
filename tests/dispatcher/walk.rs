//! A contact that rolls over many small facets is followed by walking, without a new search.
//!
//! Two edges that were in contact may span no facet at all at the next poses. A walk that took them for
//! one came back to them again and again until its steps were used up, and then GJK began from there.
//! And where facets are hardly larger than the depth, one alone rarely proves it.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::query::QueryDispatcher;
use testkit::generate::{Rng, hull_of};
use testkit::memory::{Manifold, UpdateManifolds};

const FRAMES: usize = 200;

/// How many updates of a ball of points that rolls around another were answered by GJK, and by EPA.
fn searches(rng: &mut Rng) -> [u64; 2] {
    let [a, b] = [(); 2].map(|()| {
        loop {
            let points: Vec<Vector> = (0..1000).map(|_| rng.direction().as_vec3()).collect();
            if let Some(hull) = hull_of(&points) {
                break hull.shape;
            }
        }
    });
    let (axis, start) = (rng.direction().as_vec3(), rng.direction().as_vec3());
    let (spin, tilt) = (rng.direction().as_vec3(), rng.direction().as_vec3());
    let pose = |frame: usize| {
        // As far as contacts move before rapier updates them again.
        let angle = 0.05 * frame as Real;
        let around = Rotation::from_axis_angle(axis, angle) * start;
        let turn = Rotation::from_axis_angle(spin, 1.3 * angle) * Rotation::from_scaled_axis(tilt);
        Pose::from_parts(1.99 * around, turn)
    };
    let dispatcher = IsaGjkDispatcher::default();
    let mut manifolds: Vec<Manifold> = Vec::new();
    let mut touching = 0;
    for frame in 0..FRAMES {
        let pose = pose(frame);
        dispatcher
            .update_manifolds(&pose, [&*a, &*b], 0.02, &mut manifolds, &mut None)
            .expect("supported");
        let depths = manifolds[0].points.iter().map(|point| point.dist);
        let Some(warm) = depths.reduce(Real::min) else {
            continue;
        };
        touching += 1;
        let cold = dispatcher
            .contact(&pose, &*a, &*b, 0.02)
            .expect("supported");
        let cold = cold.expect("it is there").dist;
        // Either may be off by 1e-6 of the radius.
        assert!((warm - cold).abs() < 3e-6, "{warm} warm, {cold} cold");
    }
    assert!(touching > FRAMES * 9 / 10, "only {touching} contacts");
    let warm = dispatcher.stats().answered;
    [Stage::WarmGjk, Stage::WarmEpa].map(|stage| warm[stage as usize])
}

/// There were 31 and 649 in these 2,000 updates.
#[test]
fn a_contact_that_rolls_over_small_facets_is_walked_after() {
    let mut rng = Rng::new(9);
    let [mut gjk, mut epa] = [0; 2];
    for _ in 0..10 {
        let [of_gjk, of_epa] = searches(&mut rng);
        gjk += of_gjk;
        epa += of_epa;
    }
    assert!(gjk <= 5, "GJK answered {gjk}");
    assert!(epa <= 100, "EPA answered {epa}");
}
