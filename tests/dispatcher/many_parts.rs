//! What an update costs grows with the parts that are near, not with those that there are, and no
//! faster than their number.
//!
//! Times are compared within one process, the best of several each, with room to spare.

use std::time::{Duration, Instant};

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::*;
use testkit::generate::{Rng, hull_of};
use testkit::memory::Memory;

/// The shortest of some runs, which nothing else on the machine has disturbed.
fn best(mut run: impl FnMut()) -> Duration {
    let timed = (0..15).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed()
    });
    timed.min().expect("some runs")
}

/// Balls in a row, or on a square grid, that touch their neighbours.
fn balls(count: usize, columns: usize) -> SharedShape {
    let ball = SharedShape::ball(0.5);
    let place = |i: usize| Pose::translation((i % columns) as Real, 0.0, (i / columns) as Real);
    SharedShape::compound((0..count).map(|i| (place(i), ball.clone())).collect())
}

/// A cuboid beyond the end of a row of balls, out of reach of all of them.
#[test]
fn parts_far_away_cost_nothing() {
    let dispatcher = IsaGjkDispatcher::default();
    let cuboid = SharedShape::cuboid(0.5, 0.5, 0.5);
    let update = |parts: &SharedShape| {
        let pose = Pose::translation(-2.0, 0.0, 0.0);
        let mut memory = Memory::default();
        best(|| {
            for _ in 0..100 {
                memory.update(&dispatcher, &pose, [parts, &cuboid], 0.02);
            }
        })
    };
    let [few, many] = [100, 10_000].map(|count| update(&balls(count, count)));
    assert!(
        many < 10 * few,
        "{few:?} for 100 parts, {many:?} for 10,000"
    );
}

/// A plate on a grid of balls that moves to other ones: in a half of the updates none of the pairs
/// are those of the update before.
#[test]
fn many_parts_that_meet_others_are_found_in_linear_time() {
    let dispatcher = IsaGjkDispatcher::default();
    let update = |side: usize| {
        let parts = balls(2 * side * side, 2 * side);
        let half = side as Real / 2.0 - 0.1;
        let corner = |i: usize| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            Vector::new(sign(0) * half, sign(1) * 0.1, sign(2) * half)
        };
        let corners: Vec<Vector> = (0..8).map(corner).collect();
        let plate = hull_of(&corners).expect("a box").shape;
        let mut memory = Memory::default();
        let middle = side as Real / 2.0 - 0.5;
        best(|| {
            for x in [middle, middle + side as Real] {
                let pose = Pose::translation(x, 0.59, middle);
                memory.update(&dispatcher, &pose, [&parts, &plate], 0.02);
                assert_eq!(memory.manifolds.len(), side * side);
            }
        })
    };
    let [few, many] = [12, 48].map(update);
    // Sixteen times as many: a quadratic search takes 256 times as long, and a busy machine has taken
    // 80 times as long for a linear one.
    assert!(
        many < 128 * few,
        "{few:?} for 144 parts, {many:?} for 2,304"
    );
}

/// However the pairs of parts come and go, each is answered as if it were new.
#[test]
fn the_manifold_of_each_pair_is_its_own() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(117);
    let parts = balls(400, 20);
    let hull = rng.hull(40, 3.0).shape;
    let mut memory = Memory::default();
    let mut met = 0;
    for _ in 0..60 {
        let [x, z] = [(); 2].map(|()| rng.range(0.0, 19.0) as Real);
        let pose = Pose::translation(x, 1.0, z);
        let mut cold = Memory::default();
        for memory in [&mut memory, &mut cold] {
            memory.update(&dispatcher, &pose, [&parts, &hull], 0.02);
        }
        let pairs = [&memory, &cold].map(|memory| {
            let ids = memory.manifolds.iter().map(|m| (m.subshape1, m.subshape2));
            ids.collect::<Vec<_>>()
        });
        assert_eq!(pairs[0], pairs[1]);
        for (warm, cold) in memory.manifolds.iter().zip(&cold.manifolds) {
            assert_eq!(warm.subshape_pos1(), cold.subshape_pos1());
            let [warm, cold] = [warm, cold].map(|m| m.find_deepest_contact().map(|p| p.dist));
            match (warm, cold) {
                (Some(warm), Some(cold)) => assert!((warm - cold).abs() < 1e-5),
                _ => assert_eq!(warm, cold),
            }
            met += usize::from(cold.is_some());
        }
    }
    assert!(met > 300, "only {met} contacts");
}
