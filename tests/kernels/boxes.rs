//! Hulls that are boxes are recognised, and two of them overlap by the least depth along their separating axes.

use glam::{DQuat, DVec3, Vec3};
use isa_gjk::Hull;
use isa_gjk::internals::epa::{EpaScratch, penetration};
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::query::{Answer, PairMemory, Query};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Cso, Polytope};
use parry3d::math::Pose;
use testkit::generate::Rng;

/// The corners of a turned box. One of them is moved.
fn corners(half: DVec3, turn: DQuat, moved: DVec3) -> Vec<Vec3> {
    (0..8)
        .map(|i| {
            let signs = [1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 });
            let moved = if i == 5 { moved } else { DVec3::ZERO };
            (turn * (half * DVec3::from(signs) + moved)).as_vec3()
        })
        .collect()
}

fn hull(half: DVec3, turn: DQuat, moved: DVec3) -> Hull {
    Hull::from_points(&corners(half, turn, moved)).expect("a solid")
}

#[test]
fn only_boxes_are_boxes() {
    let mut rng = Rng::new(3);
    for _ in 0..200 {
        let half = DVec3::new(
            rng.range(0.2, 1.0),
            rng.range(0.2, 1.0),
            rng.range(0.2, 1.0),
        );
        let turn = rng.rotation();
        assert!(hull(half, turn, DVec3::ZERO).oriented_box().is_some());
        let moved = rng.direction() * 1e-5;
        assert!(hull(half, turn, moved).oriented_box().is_none(), "{moved}");
        let eight: Vec<Vec3> = (0..8).map(|_| rng.direction().as_vec3()).collect();
        let eight = Hull::from_points(&eight).expect("points on a ball");
        assert!(eight.oriented_box().is_none());
    }
}

/// Boxes at any place, turned in any way or square to each other.
#[test]
fn boxes_overlap_by_their_depth_and_not_by_more() {
    let mut rng = Rng::new(11);
    let mut tried = 0;
    for round in 0..3000 {
        let thin = [1.0, 1e-2][round % 2];
        let hulls = [(); 2].map(|()| {
            let half = DVec3::new(rng.range(0.3, 1.0), rng.range(0.3, 1.0), thin);
            let turn = [DQuat::IDENTITY, rng.rotation()][rng.count(0, 1)];
            hull(half, turn, DVec3::ZERO)
        });
        let turn = [DQuat::IDENTITY, rng.rotation()][rng.count(0, 1)];
        let place = rng.direction() * rng.range(0.0, 1.5);
        let pose = Pose::from_parts(place.as_vec3(), turn.as_quat());
        let pose = RelativePose::new(&pose).expect("a finite pose");
        let cso = Cso {
            shape_1: &hulls[0],
            shape_2: &hulls[1],
            pose: &pose,
        };
        let found = penetration(&cso, &[], &mut EpaScratch::default(), &mut Cost::default());
        let Some(depth) = found.map(|found| found.depth).filter(|depth| *depth > 1e-3) else {
            continue;
        };
        let [first, second] = [0, 1].map(|i| hulls[i].oriented_box().expect("a box"));
        let overlap_by = |least| first.overlap_by(second, &pose, least, cso.size());
        let slack = 2e-6 * cso.size();
        assert!(overlap_by(depth - slack), "not by {depth} in round {round}");
        assert!(!overlap_by(depth + slack), "by more than {depth}");
        tried += 1;
    }
    assert!(tried > 1000, "only {tried} overlaps");
}

/// A facet that is no longer the nearest leads to the one along the axis of least overlap, and no polytope grows.
#[test]
fn the_depth_of_boxes_needs_no_search() {
    let mut rng = Rng::new(17);
    let (mut tried, mut searched) = (0, 0);
    for _ in 0..2000 {
        let hulls = [(); 2].map(|()| {
            let half = [(); 3].map(|()| rng.range(0.3, 1.0));
            hull(DVec3::from(half), rng.rotation(), DVec3::ZERO)
        });
        let place = (rng.direction() * rng.range(0.2, 0.8)).as_vec3();
        let mut memory = PairMemory::None;
        // The second one turns, so that another facet is nearest.
        for turn in [DQuat::IDENTITY, DQuat::from_rotation_y(0.4), rng.rotation()] {
            let pose = Pose::from_parts(place, turn.as_quat());
            let pose = RelativePose::new(&pose).expect("a finite pose");
            let cso = Cso {
                shape_1: &hulls[0],
                shape_2: &hulls[1],
                pose: &pose,
            };
            let (mut scratch, mut cost) = (EpaScratch::default(), Cost::default());
            let found = penetration(&cso, &[], &mut scratch, &mut Cost::default());
            let depth = found.expect("boxes have volume").depth;
            let answer = Query::new(&cso, 0.02, &mut scratch, &mut cost).run(&memory);
            let (answer, _) = answer.expect("boxes have volume");
            memory = answer.memory();
            if depth < 0.1 {
                continue;
            }
            let Answer::Near(near) = answer else {
                panic!("{depth} deep, but apart");
            };
            let error = (near.signed_distance + depth).abs();
            assert!(error < 2e-6 * cso.size(), "{error} off at {depth}");
            tried += 1;
            searched += usize::from(cost.iterations > 0);
        }
    }
    println!("{searched} of {tried} searched");
    assert!(tried > 3000, "only {tried} overlaps");
    assert!(searched < tried / 100, "{searched} of {tried} searched");
}
