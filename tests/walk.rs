//! A contact that rolls over many small facets is followed by walking, not searched for anew.
//!
//! Two edges that were in contact may span no facet at all at the next poses. A walk that took them for
//! one came back to them again and again until its steps were used up, and then GJK began from there.

mod common;

use common::generate::{Dice, hull_of};
use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher};

const FRAMES: usize = 200;

/// How many updates GJK answered, of a ball of points that rolls around another.
fn answers_by_gjk(dice: &mut Dice) -> u64 {
    let [a, b] = [(); 2].map(|()| {
        loop {
            let points: Vec<Vector> = (0..1000).map(|_| dice.direction().as_vec3()).collect();
            if let Some(hull) = hull_of(&points) {
                break hull.shape;
            }
        }
    });
    let (axis, start) = (dice.direction().as_vec3(), dice.direction().as_vec3());
    let (spin, tilt) = (dice.direction().as_vec3(), dice.direction().as_vec3());
    let pose = |frame: usize| {
        // As far as contacts move before rapier asks about them again.
        let angle = 0.05 * frame as Real;
        let around = Rotation::from_axis_angle(axis, angle) * start;
        let turn = Rotation::from_axis_angle(spin, 1.3 * angle) * Rotation::from_scaled_axis(tilt);
        Pose::from_parts(1.99 * around, turn)
    };
    let dispatcher = IsaGjkDispatcher::default();
    let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
    let mut touching = 0;
    for frame in 0..FRAMES {
        dispatcher
            .contact_manifolds(&pose(frame), &*a, &*b, 0.02, &mut manifolds, &mut None)
            .expect("supported");
        touching += usize::from(!manifolds[0].points.is_empty());
    }
    assert!(touching > FRAMES * 9 / 10, "only {touching} contacts");
    let answered = dispatcher.stats().answered;
    [Stage::WarmGjk, Stage::ColdGjk]
        .map(|stage| answered[stage as usize])
        .iter()
        .sum()
}

/// There were 31.
#[test]
fn a_contact_that_rolls_over_small_facets_is_walked_after() {
    let mut dice = Dice::new(9);
    let searched: u64 = (0..10).map(|_| answers_by_gjk(&mut dice)).sum();
    assert!(searched <= 2, "{searched} updates were searches");
}
