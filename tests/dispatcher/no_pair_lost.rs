//! With this dispatcher, no contact may be lost.
//!
//! rapier throws the result of a narrow-phase query away, so a pair that the dispatcher does not support
//! falls through the floor in silence, and parry's dispatcher passes itself, not us, to the routines for
//! compounds, meshes, heightfields and voxels. So every shape meets every shape: the dispatcher supports
//! exactly what parry supports, finds contacts wherever parry does, and passes every pair of balls and sharp polytopes
//! through untouched, to the last bit, but for cuboids on triangles. Of compounds only the parts are: we find them ourselves, and their poses may be
//! rounded otherwise. Two capsules are ours: they have the same depth, and more contacts. So are hulls, cylinders, cones
//! and whatever has a rounded border.

use std::fmt::Debug;

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher};
use testkit::memory::{Manifold, Memory, UpdateManifolds};
use testkit::shape_samples::{ShapeSample, poses, shape_samples};

const PREDICTION: Real = 0.1;

/// A frame later: moved by less than a hundredth.
fn nudged(pose: &Pose) -> Pose {
    let turn = Rotation::from_scaled_axis(Vector::new(0.004, -0.002, 0.003));
    Pose::from_parts(
        pose.translation + Vector::new(-0.002, -0.003, 0.001),
        turn * pose.rotation,
    )
}

/// Contacts of cylinders, cones and rounded shapes are ours.
fn is_curved(sample: &ShapeSample) -> bool {
    let ours = ["cylinder", "cone", "round"];
    ours.iter().any(|name| sample.name.contains(name))
}

/// A capsule is ours beside whatever is or has sharp polytopes.
fn is_capsule_beside_polytopes(pair: [&ShapeSample; 2]) -> bool {
    let [first, second] = pair.map(|sample| sample.name);
    let closed_form = ["capsule", "ball", "half-space"];
    [[first, second], [second, first]]
        .iter()
        .any(|[capsule, other]| *capsule == "capsule" && !closed_form.contains(other))
}

/// What consists of cuboids is ours beside whatever consists of triangles.
fn are_cuboids_on_triangles(pair: [&ShapeSample; 2]) -> bool {
    let names = pair.map(|sample| sample.name);
    let is_any = |kinds: &[&str]| names.iter().any(|name| kinds.contains(name));
    is_any(&["cuboid", "voxels", "compound"]) && is_any(&["triangle", "trimesh", "heightfield"])
}

/// Every ordered pair of shapes, except those that make parry itself panic.
fn pairs(samples: &[ShapeSample]) -> impl Iterator<Item = [&ShapeSample; 2]> {
    samples
        .iter()
        .flat_map(move |first| samples.iter().map(move |second| [first, second]))
        .filter(|[first, second]| !parry_panics(first.name, second.name))
}

/// An infinite shape meets one made of finitely many cells.
fn parry_panics(first: &str, second: &str) -> bool {
    let infinite = |name| name == "half-space";
    let cells = |name| name == "voxels" || name == "heightfield";
    (infinite(first) && cells(second)) || (cells(first) && infinite(second))
}

fn contacts(
    dispatcher: &impl UpdateManifolds,
    pair: [&ShapeSample; 2],
    pose: &Pose,
    memory: &mut Memory,
) -> bool {
    let [first, second] = pair;
    dispatcher
        .update_manifolds(
            pose,
            [&*first.shape, &*second.shape],
            PREDICTION,
            &mut memory.manifolds,
            &mut memory.workspace,
        )
        .is_ok()
}

/// The distance of the deepest point of all manifolds.
fn deepest(manifolds: &[Manifold]) -> Option<Real> {
    manifolds
        .iter()
        .filter_map(|m| m.find_deepest_contact())
        .map(|point| point.dist)
        .reduce(Real::min)
}

/// Equal to the last bit: floats print in as many digits as tell them apart.
fn assert_same(ours: &impl Debug, theirs: &impl Debug, what: impl Fn() -> String) {
    assert_eq!(format!("{ours:?}"), format!("{theirs:?}"), "{}", what());
}

/// The same parts meet, as deeply. `we_predict` if parry finds no contact of these shapes before they overlap.
fn assert_near(
    ours: &[Manifold],
    theirs: &[Manifold],
    we_predict: bool,
    what: impl Fn() -> String,
) {
    let [mut ours, theirs] = [ours, theirs].map(|manifolds| {
        let deepest =
            |m: &Manifold| Some((m.subshape1, m.subshape2, m.find_deepest_contact()?.dist));
        // At the very edge of the prediction either answer is right.
        let near = manifolds.iter().filter_map(deepest);
        let mut near: Vec<_> = near.filter(|&(.., dist)| dist < 0.9 * PREDICTION).collect();
        near.sort_by_key(|&(part_1, part_2, _)| (part_1, part_2));
        near
    });
    if we_predict {
        let is_theirs = |a: u32, b: u32| theirs.iter().any(|part| (part.0, part.1) == (a, b));
        ours.retain(|part| part.2 <= 0.0 || is_theirs(part.0, part.1));
    }
    let is_near = ours.len() == theirs.len()
        && ours
            .iter()
            .zip(&theirs)
            .all(|(a, b)| (a.0, a.1) == (b.0, b.1) && (a.2 - b.2).abs() < 1e-4);
    assert!(is_near, "{}: {ours:?}, parry {theirs:?}", what());
}

#[test]
fn contacts_are_found_wherever_parry_finds_them() {
    let (mut checked, mut in_contact) = (0, 0);
    for pair in pairs(&shape_samples()) {
        let is_ours = pair
            .iter()
            .any(|sample| sample.has_hull || is_curved(sample))
            || is_capsule_beside_polytopes(pair)
            || are_cuboids_on_triangles(pair);
        // All distances are among them: there are eight. What is passed on needs fewer poses.
        for pose in poses().into_iter().step_by(if is_ours { 5 } else { 7 }) {
            let dispatcher = IsaGjkDispatcher::default();
            let (mut ours, mut theirs) = (Memory::default(), Memory::default());
            for pose in [pose, nudged(&pose)] {
                let what = || format!("{} / {} at {pose:?}", pair[0].name, pair[1].name);
                let we_can = contacts(&dispatcher, pair, &pose, &mut ours);
                let they_can = contacts(&DefaultQueryDispatcher, pair, &pose, &mut theirs);
                assert_eq!(we_can, they_can, "supported: {}", what());
                if is_ours {
                    // Not parry's contacts.
                } else if pair.iter().any(|sample| sample.name == "compound")
                    || pair.iter().all(|sample| sample.name == "capsule")
                {
                    let we_predict = pair.iter().any(|sample| sample.name == "voxels");
                    assert_near(&ours.manifolds, &theirs.manifolds, we_predict, what);
                } else {
                    assert_same(&ours.manifolds, &theirs.manifolds, what);
                }
                checked += 1;
                // At the very edge of the prediction either answer is right.
                if deepest(&theirs.manifolds).is_some_and(|dist| dist < 0.9 * PREDICTION) {
                    assert!(deepest(&ours.manifolds).is_some(), "lost: {}", what());
                    in_contact += 1;
                }
            }
        }
    }
    let share = f64::from(in_contact) / f64::from(checked);
    assert!(
        (0.2..0.9).contains(&share),
        "the samples hardly meets: {share}"
    );
}

#[test]
fn scene_queries_are_supported_wherever_parry_supports_them() {
    let ours = IsaGjkDispatcher::default();
    let theirs = DefaultQueryDispatcher;
    for pair in pairs(&shape_samples()) {
        let (g1, g2) = (&*pair[0].shape, &*pair[1].shape);
        for pose in poses().iter().step_by(11) {
            let keeps = |ours: bool, theirs: bool, query: &str| {
                let [first, second] = pair.map(|sample| sample.name);
                let is_lost = theirs && !ours;
                assert!(!is_lost, "{query}, {first} / {second} at {pose:?}");
            };
            macro_rules! compare {
                ($query:ident $arguments:tt) => {
                    keeps(
                        ours.$query $arguments.is_ok(),
                        theirs.$query $arguments.is_ok(),
                        stringify!($query),
                    )
                };
            }
            let still = NonlinearRigidMotion::identity();
            let spin = Vector::new(0.1, 0.2, 0.3);
            let moving = NonlinearRigidMotion::new(*pose, Vector::ZERO, -pose.translation, spin);
            let options = ShapeCastOptions::default();
            compare!(intersection_test(pose, g1, g2));
            compare!(distance(pose, g1, g2));
            compare!(contact(pose, g1, g2, PREDICTION));
            compare!(closest_points(pose, g1, g2, PREDICTION));
            compare!(cast_shapes(pose, -pose.translation, g1, g2, options));
            compare!(cast_shapes_nonlinear(
                &still, g1, &moving, g2, 0.0, 1.0, true
            ));
        }
    }
}
