//! What is wrong with the manifolds of many pairs of bodies: cold, in the other order, and warm.

use isa_gjk::IsaGjkDispatcher;
use parry3d::shape::SharedShape;
use testkit::curved::{Body, Faults, Judge, Meeting, tilted};
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, cold_manifold};
use testkit::pose::ExactPose;

/// How far apart pairs are, as shares of the smaller diameter.
pub const GAPS: [f64; 7] = [0.05, 0.005, 1e-6, -1e-6, -0.01, -0.05, -0.2];

/// Of the pairs judged so far.
pub struct Tally {
    /// What an answer must keep.
    promise: fn(&Faults) -> bool,
    pairs: usize,
    bad: usize,
    worst: Faults,
}

impl Tally {
    pub fn new(promise: fn(&Faults) -> bool) -> Self {
        Self {
            promise,
            pairs: 0,
            bad: 0,
            worst: Faults::default(),
        }
    }

    /// Judges two bodies that meet in each of these ways, apart by each of these shares of the smaller diameter.
    pub fn add(&mut self, rng: &mut Rng, bodies: [&Body; 2], meetings: &[Meeting], gaps: &[f64]) {
        let [first, second] = bodies;
        let size = first.diameter().min(second.diameter());
        for &meeting in meetings {
            for gap in gaps {
                let Some(pose) = meeting.pose(rng, bodies, gap * size) else {
                    continue;
                };
                let found = faults(bodies, pose, rng, 0.06 * size);
                self.pairs += 1;
                for (way, faults) in ["cold", "back", "warm"].into_iter().zip(found) {
                    self.worst = self.worst.or(faults);
                    if !(self.promise)(&faults) {
                        self.bad += 1;
                        if self.bad < 60 {
                            let names = (&first.name, &second.name);
                            println!("{names:?} {meeting:?} {gap} {way}: {faults:?}");
                        }
                    }
                }
            }
        }
    }

    /// All pairs keep the promise.
    pub fn check(&self) {
        let Self {
            pairs, bad, worst, ..
        } = self;
        println!("{pairs} pairs, {bad} bad, {worst:?}");
        assert_eq!(*bad, 0);
    }
}

fn flipped(manifold: &Manifold) -> Manifold {
    let mut flipped = manifold.clone();
    (flipped.local_n1, flipped.local_n2) = (manifold.local_n2, manifold.local_n1);
    for point in &mut flipped.points {
        (point.local_p1, point.local_p2) = (point.local_p2, point.local_p1);
    }
    flipped
}

/// What is wrong with a pair's manifolds: cold, in the other order, and warm from a pose beside it.
fn faults(bodies: [&Body; 2], pose: ExactPose, rng: &mut Rng, prediction: f64) -> [Faults; 3] {
    let dispatcher = IsaGjkDispatcher::default();
    let judge = Judge::new(bodies, pose);
    let [a, b]: [&SharedShape; 2] = bodies.map(|body| &body.shape);
    let reach = prediction as f32;
    let cold = cold_manifold(&dispatcher, &pose.to_f32(), [a, b], reach);
    let back = cold_manifold(&dispatcher, &pose.inverse().to_f32(), [b, a], reach);
    let mut memory = Memory::default();
    let beside = tilted(pose, rng, 0.01);
    let aside = ExactPose {
        translation: pose.translation + rng.direction() * (0.003 * judge.size),
        ..beside
    };
    memory.update(&dispatcher, &aside.to_f32(), [a, b], reach);
    let warm = memory.update(&dispatcher, &pose.to_f32(), [a, b], reach);
    // Contacts that stay are off their common line by the drift that they may have.
    let mut with_past = judge.manifold(warm, prediction);
    with_past.gap = 0.0;
    [
        judge.manifold(cold.as_ref(), prediction),
        judge.manifold(back.as_ref().map(flipped).as_ref(), prediction),
        with_past,
    ]
}
