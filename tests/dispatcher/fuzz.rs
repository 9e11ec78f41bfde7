//! Whatever shapes, poses and predictions come in any order: the promises hold.
//!
//! Strings of bytes are decoded into pairs and motions (`common/bytes.rs`): random ones by seed,
//! and a corpus of those that once reached something new. What is asked of every answer needs no
//! oracle: it is finite, the same from both sides, the same warm and cold, and no direction
//! separates the shapes by more than the distance, the normal by no less.
//!
//! `FUZZ_SECONDS=600 FUZZ_SEED=7 cargo test --release --test dispatcher fuzz` runs longer;
//! `FUZZ_KEEP=1` with it adds inputs to the corpus.

use std::collections::BTreeSet;
use std::path::PathBuf;

use glam::DVec3;
use isa_gjk::{HullShape, IsaGjkDispatcher, Stats};
use parry3d::math::{Pose, Real};
use parry3d::query::{QueryDispatcher, ShapeCastOptions};
use parry3d::shape::{Shape, SharedShape};
use testkit::budget;
use testkit::bytes::Bytes;
use testkit::memory::{Manifold, Memory, cold_manifold};

/// Relative to the larger shape: what the documentation promises.
const DISTANCE: f64 = 1.0e-5;
const NORMAL: f64 = 1.0e-4;
/// Shapes whose sizes are farther apart than that need only be survived.
const SMALLEST: Real = 1.0e-6;
/// The most poses of one pair.
const FRAMES: usize = 12;
/// Rounding of coordinates far from the frame's origin, relative to how far.
const ROUNDING: f64 = 1.0e-6;

/// The points that span a shape, and the radius of the ball around each; `None` for others.
fn core(shape: &SharedShape) -> Option<(Vec<DVec3>, f64)> {
    let cuboid = shape.as_cuboid().map(|cuboid| {
        let corner = |i: u32| {
            let side = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            DVec3::new(side(0), side(1), side(2)) * cuboid.half_extents.as_dvec3()
        };
        ((0..8).map(corner).collect(), 0.0)
    });
    let points = |points: &[parry3d::math::Vector]| points.iter().map(|p| p.as_dvec3()).collect();
    let hull = shape
        .as_convex_polyhedron()
        .map(|hull| (points(hull.points()), 0.0));
    let prepared = shape.as_shape::<HullShape>();
    let prepared = prepared.map(|shape| (points(shape.hull().points()), 0.0));
    let round = shape.as_round_convex_polyhedron();
    let round = round.map(|r| (points(r.inner_shape.points()), r.border_radius.into()));
    let triangle = shape.as_triangle().map(|t| (points(&[t.a, t.b, t.c]), 0.0));
    cuboid.or(hull).or(prepared).or(round).or(triangle)
}

/// Two convex shapes and where the second is.
struct Scene<'a> {
    shapes: [&'a SharedShape; 2],
    pose: Pose,
    prediction: Real,
    size: f64,
}

impl Scene<'_> {
    fn is_finite(&self) -> bool {
        let turn = self.pose.rotation.length_squared();
        let place = self.pose.translation.abs().max_element();
        self.pose.translation.is_finite()
            && place < 1.0e7
            && (turn - 1.0).abs() < 1.0e-3
            && self.prediction.is_finite()
    }

    /// How far a distance may be off.
    fn slack(&self) -> f64 {
        DISTANCE * self.size + ROUNDING * f64::from(self.pose.translation.length())
    }

    /// How far the shapes are apart along a unit direction, in the frame of the first.
    fn separation(&self, normal: DVec3) -> Option<f64> {
        let [a, b] = [core(self.shapes[0])?, core(self.shapes[1])?];
        let turn = self.pose.rotation.as_dquat().normalize();
        let place = self.pose.translation.as_dvec3();
        let nearest = b.0.iter().map(|p| normal.dot(turn * *p + place));
        let farthest = a.0.iter().map(|p| normal.dot(*p));
        let gap =
            nearest.fold(f64::INFINITY, f64::min) - farthest.fold(f64::NEG_INFINITY, f64::max);
        Some(gap - a.1 - b.1)
    }

    fn check(&self, warm: &Manifold, cold: &Manifold) {
        assert!(is_finite(warm) && is_finite(cold), "not finite");
        let distances = [warm, cold].map(|m| m.find_deepest_contact().map(|p| f64::from(p.dist)));
        let reach = f64::from(self.prediction);
        let [Some(warm_dist), Some(cold_dist)] = distances else {
            let found = distances.into_iter().flatten().next();
            let at_the_edge = found.is_none_or(|dist| dist > reach - self.slack());
            assert!(
                at_the_edge || reach < 0.0,
                "warm, cold: {distances:?} of {reach}"
            );
            return;
        };
        let apart = (warm_dist - cold_dist).abs();
        assert!(
            apart <= self.slack(),
            "warm {warm_dist:e}, cold {cold_dist:e}"
        );
        let normal = warm.local_n1.as_dvec3();
        if let Some(shown) = self.separation(normal) {
            let slack = self.slack() + NORMAL * self.size;
            assert!(
                shown > warm_dist - slack,
                "{normal} shows {shown:e} of {warm_dist:e}"
            );
            for direction in directions() {
                let other = self.separation(direction).unwrap_or(f64::NEG_INFINITY);
                let better = other - warm_dist;
                assert!(
                    better < self.slack(),
                    "{direction} shows {other:e}, not {warm_dist:e}"
                );
            }
        }
    }

    /// The other way round: the same distance.
    fn check_swapped(&self) {
        let us = IsaGjkDispatcher::default();
        let [g1, g2] = self.shapes.map(|shape| &**shape);
        let distance = |pose: &Pose, g1: &dyn Shape, g2: &dyn Shape| {
            let contact = us
                .contact(pose, g1, g2, self.prediction)
                .expect("supported");
            contact.map(|contact| f64::from(contact.dist))
        };
        let here = distance(&self.pose, g1, g2);
        let there = distance(&self.pose.inverse(), g2, g1);
        if let (Some(here), Some(there)) = (here, there) {
            // The pose itself is rounded by the way.
            let slack = 2.0 * self.slack();
            assert!((here - there).abs() <= slack, "{here:e} and {there:e}");
        }
    }

    /// No panic and no endless loop. Whether the shapes meet, and how far they are apart.
    fn ask_everything(&self) -> (bool, f64) {
        let us = IsaGjkDispatcher::default();
        let [g1, g2] = self.shapes.map(|shape| &**shape);
        let supported = "supported";
        let test = us.intersection_test(&self.pose, g1, g2).expect(supported);
        let distance = us.distance(&self.pose, g1, g2).expect(supported).distance;
        us.closest_points(&self.pose, g1, g2, self.prediction)
            .expect(supported);
        let options = ShapeCastOptions {
            target_distance: self.prediction,
            ..ShapeCastOptions::default()
        };
        us.cast_shapes(&self.pose, -self.pose.translation, g1, g2, options)
            .expect(supported);
        (test.intersecting, distance.into())
    }
}

fn directions() -> impl Iterator<Item = DVec3> {
    let steps = || [-1.0, 0.0, 1.0].into_iter();
    let all = steps()
        .flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| DVec3::new(x, y, z))));
    all.filter_map(DVec3::try_normalize)
}

fn is_finite(manifold: &Manifold) -> bool {
    manifold.local_n1.is_finite()
        && manifold.points.iter().all(|point| {
            point.local_p1.is_finite() && point.local_p2.is_finite() && point.dist.is_finite()
        })
}

fn size(shape: &SharedShape) -> f64 {
    let sphere = shape.compute_local_bounding_sphere();
    2.0 * f64::from(sphere.radius + sphere.center.length())
}

/// Whether we answer: both shapes are sound polytopes, one of them a hull.
fn is_ours(shapes: [&SharedShape; 2]) -> bool {
    let us = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    memory.update(&us, &Pose::IDENTITY, shapes, 0.0);
    us.stats().queries() > 0
}

/// Runs one input. What it did, for the corpus: `None` if the bytes describe no pair.
fn run(input: &[u8], show: bool) -> Option<String> {
    let mut bytes = Bytes::new(input);
    // Pairs without a hull are parry's, with their assertions about numbers that are none.
    let first = bytes.hull()?;
    let with_parts = input.first().is_some_and(|byte| byte % 5 == 4);
    let second = if with_parts {
        bytes.composite()?
    } else {
        bytes.convex()?
    };
    let shapes = [&first, &second];
    let sound = bytes.size_ratio() > SMALLEST && !bytes.is_tampered();
    // Composite shapes have no manifold of their own to count. Their parts are sound.
    let sound = sound && (!with_parts || is_ours([&first, &SharedShape::ball(1.0)]));
    let exact = sound && !with_parts && is_ours(shapes);
    let us = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let size = size(&first).max(size(&second));
    let kinds = shapes.map(|shape| shape.shape_type());
    let mut pose = Pose::IDENTITY;
    for _ in 0..FRAMES {
        if bytes.is_empty() {
            break;
        }
        pose = bytes.pose(&pose, size as Real);
        let scene = Scene {
            shapes,
            pose,
            prediction: bytes.prediction(size as Real),
            size,
        };
        if show {
            println!("{kinds:?} at {:?}, within {}", scene.pose, scene.prediction);
        }
        if with_parts {
            check_parts(&scene, &us, &mut memory, sound);
            continue;
        }
        let (pose, prediction) = (&scene.pose, scene.prediction);
        let warm = memory.update(&us, pose, shapes, prediction)?.clone();
        let cold = cold_manifold(&us, pose, shapes, prediction)?;
        let (meet, distance) = scene.ask_everything();
        if exact && scene.is_finite() {
            let far = distance > scene.slack();
            assert!(!(meet && far), "meet at a distance of {distance:e}");
            scene.check(&warm, &cold);
            scene.check_swapped();
        }
    }
    Some(format!("{kinds:?} {exact} {}", stages(&us.stats())))
}

/// Of shapes with parts the deepest contact is compared. Parry looks at more triangles than a mesh
/// shows within reach if it has met them before, so there may be more contacts warm than cold.
fn check_parts(scene: &Scene, us: &IsaGjkDispatcher, memory: &mut Memory, exact: bool) {
    let deepest = |memory: &mut Memory| {
        memory.update(us, &scene.pose, scene.shapes, scene.prediction);
        let points = memory.manifolds.iter().flat_map(|m| &m.points);
        points.map(|point| point.dist).reduce(Real::min)
    };
    let [warm, cold] = [deepest(memory), deepest(&mut Memory::default())];
    if exact
        && scene.is_finite()
        && let Some(cold) = cold
    {
        let lost = warm.map_or(f64::INFINITY, |warm| f64::from(warm - cold));
        // A mesh corrects normals, and the depth along a corrected one is off by as much as it.
        let slack = scene.slack() + NORMAL * scene.size;
        assert!(lost <= slack, "{warm:?} of {cold:?}");
    }
}

/// Which stages answered.
fn stages(stats: &Stats) -> String {
    stats
        .answered
        .iter()
        .map(|count| if *count > 0 { 'x' } else { '-' })
        .collect()
}

fn corpus() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests/data/corpus"]
        .iter()
        .collect()
}

#[test]
fn the_corpus_holds() {
    let mut count = 0;
    for entry in std::fs::read_dir(corpus()).expect("the corpus is part of the repository") {
        let path = entry.expect("a readable directory").path();
        let input = std::fs::read(&path).expect("a readable file");
        println!("{}", path.display());
        assert!(run(&input, true).is_some(), "no pair of shapes");
        count += 1;
    }
    assert!(count >= 20, "only {count} inputs");
}

#[test]
fn random_inputs_hold() {
    let seed = budget::seed();
    let keep = std::env::var_os("FUZZ_KEEP").is_some();
    let mut rng = oorandom::Rand64::new(seed.into());
    let (mut runs, mut pairs) = (0, 0);
    let (mut seen, mut findings) = (BTreeSet::new(), Vec::new());
    for turn in budget::turns(20_000) {
        runs += 1;
        let length = rng.rand_range(40..400) as usize;
        let input: Vec<u8> = (0..length).map(|_| rng.rand_u64() as u8).collect();
        let done = std::panic::catch_unwind(|| run(&input, false));
        let Ok(outcome) = done else {
            let path = std::env::temp_dir().join(format!("isa-gjk-{seed}-{turn}.bin"));
            std::fs::write(&path, &input).expect("a place for what was found");
            findings.push(path);
            continue;
        };
        let Some(outcome) = outcome else { continue };
        pairs += 1;
        if seen.insert(outcome) && keep {
            let path = corpus().join(format!("{seed}-{turn}.bin"));
            std::fs::write(path, &input).expect("a writable corpus");
        }
    }
    assert!(findings.is_empty(), "see {findings:?}");
    println!("{pairs} pairs in {runs} runs, {} behaviours", seen.len());
    assert!(
        3 * pairs > runs,
        "only {pairs} of {runs} were pairs of shapes"
    );
}
