//! Scene queries of height fields and voxels: what the nearest of their cells would answer alone.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{IVector, Pose, Real, Vector};
use parry3d::query::{
    ClosestPoints, NonlinearRigidMotion, QueryDispatcher, ShapeCastHit, ShapeCastOptions,
};
use parry3d::shape::{Cuboid, HeightField, SharedShape, Triangle, Voxels};
use parry3d::utils::Array2;
use testkit::generate::{Rng, prepared};
use testkit::memory::{Memory, UpdateManifolds};
use testkit::pose::ExactPose;

/// Of lengths, in a scene of unit size.
const TOLERANCE: Real = 1e-4;

/// A shape, and its convex parts with their places.
struct Whole {
    shape: SharedShape,
    parts: Vec<(Pose, SharedShape)>,
}

fn field(rng: &mut Rng) -> Whole {
    let side = rng.count(3, 9);
    let heights = (0..side * side).map(|_| rng.range(-0.3, 0.3) as Real);
    let heights = Array2::new(side, side, heights.collect());
    let field = HeightField::new(heights, Vector::new(2.0, 1.0, 2.0));
    let mut parts = Vec::new();
    field.map_elements_in_local_aabb(&field.local_aabb(), &mut |_, triangle: &Triangle| {
        parts.push((Pose::IDENTITY, SharedShape::new(*triangle)));
    });
    Whole {
        shape: SharedShape::new(field),
        parts,
    }
}

fn voxels(rng: &mut Rng) -> Whole {
    let mut coordinate = || rng.count(0, 3) as i32 - 2;
    let cells: Vec<IVector> = (0..9)
        .map(|_| IVector::new(coordinate(), coordinate(), coordinate()))
        .collect();
    let voxels = Voxels::new(Vector::new(0.4, 0.3, 0.5), &cells);
    let cuboid = SharedShape::new(Cuboid::new(voxels.voxel_size() / 2.0));
    let filled = voxels.voxels().filter(|voxel| !voxel.state.is_empty());
    let parts = filled.map(|voxel| (Pose::from_translation(voxel.center), cuboid.clone()));
    Whole {
        parts: parts.collect(),
        shape: SharedShape::new(voxels),
    }
}

/// A convex shape or a compound.
fn other(rng: &mut Rng) -> Whole {
    let hull = rng.hull(12, 0.8).shape;
    let alone = |shape: SharedShape| Whole {
        parts: vec![(Pose::IDENTITY, shape.clone())],
        shape,
    };
    match rng.count(0, 5) {
        0 => alone(prepared(&hull)),
        1 => alone(SharedShape::cylinder(0.2, 0.3)),
        2 => alone(SharedShape::ball(0.3)),
        3 => {
            let parts = vec![
                (Pose::translation(0.4, 0.1, 0.0), hull),
                (Pose::translation(-0.4, 0.0, 0.0), SharedShape::ball(0.2)),
            ];
            Whole {
                shape: SharedShape::compound(parts.clone()),
                parts,
            }
        }
        _ => alone(hull),
    }
}

fn random_pose(rng: &mut Rng, reach: f64) -> Pose {
    let translation = rng.direction() * rng.range(0.0, reach);
    let rotation = rng.rotation();
    let pose = ExactPose {
        rotation,
        translation,
    };
    pose.rounded().to_f32()
}

struct Pair {
    wholes: [Whole; 2],
    pos12: Pose,
}

impl Pair {
    fn random(rng: &mut Rng) -> Self {
        let cells = match rng.count(0, 1) {
            0 => field(rng),
            _ => voxels(rng),
        };
        let other = other(rng);
        Self {
            wholes: [cells, other],
            pos12: random_pose(rng, 2.0),
        }
    }

    /// The least of what the parts answer, each at the pose of the second in the frame of the first.
    fn least(
        &self,
        mut answer: impl FnMut([&(Pose, SharedShape); 2], Pose) -> Option<Real>,
    ) -> Option<Real> {
        let [first, second] = &self.wholes;
        let pairs = first
            .parts
            .iter()
            .flat_map(|a| second.parts.iter().map(move |b| [a, b]));
        let answers = pairs.filter_map(|[a, b]| {
            let pose = a.0.inverse() * self.pos12 * b.0;
            answer([a, b], pose)
        });
        answers.reduce(Real::min)
    }

    fn reversed(self) -> Self {
        let [a, b] = self.wholes;
        Self {
            wholes: [b, a],
            pos12: self.pos12.inverse(),
        }
    }

    fn judge_near(&self, what: &str) {
        let us = IsaGjkDispatcher::default();
        let (pos12, prediction) = (&self.pos12, 0.3);
        let [g1, g2] = self.wholes.each_ref().map(|whole| &*whole.shape);
        let apart = |[a, b]: [&(Pose, SharedShape); 2], pose| {
            let found = us.distance(&pose, &*a.1, &*b.1);
            Some(found.expect("supported").distance)
        };
        let distance = self.least(apart).expect("parts");
        let found = us.distance(pos12, g1, g2).expect("supported").distance;
        let off = (found - distance).abs();
        assert!(off < TOLERANCE, "{what}: {found}, not {distance}");
        let meets = us.intersection_test(pos12, g1, g2).expect("supported");
        assert!(
            meets.intersecting == (distance == 0.0) || distance < TOLERANCE,
            "{what}: {meets:?} at {distance}"
        );
        let near = us.closest_points(pos12, g1, g2, 0.5).expect("supported");
        let is_right = match near {
            ClosestPoints::Intersecting => distance < TOLERANCE,
            ClosestPoints::WithinMargin(p1, p2) => {
                ((pos12 * p2).distance(p1) - distance).abs() < TOLERANCE
            }
            ClosestPoints::Disjoint => distance > 0.5 - TOLERANCE,
        };
        assert!(is_right, "{what}: {near:?} at {distance}");
        let depth = |[a, b]: [&(Pose, SharedShape); 2], pose| {
            let found = us.contact(&pose, &*a.1, &*b.1, prediction);
            found.expect("supported").map(|contact| contact.dist)
        };
        let expected = self.least(depth);
        let found = us.contact(pos12, g1, g2, prediction).expect("supported");
        let found = found.map(|contact| {
            let between = pos12 * contact.point2 - contact.point1;
            let off = between.dot(contact.normal1) - contact.dist;
            assert!(off.abs() < TOLERANCE, "{what}: {contact:?}");
            contact.dist
        });
        let is_near = |a: Option<Real>, b: Option<Real>| {
            let [a, b] = [a, b].map(|x| x.unwrap_or(prediction));
            (a - b).abs() < TOLERANCE
        };
        assert!(is_near(found, expected), "{what}: {found:?}, {expected:?}");
    }

    /// Whether it meets anything.
    fn judge_casts(&self, rng: &mut Rng, what: &str) -> bool {
        let us = IsaGjkDispatcher::default();
        let [g1, g2] = self.wholes.each_ref().map(|whole| &*whole.shape);
        let velocity = rng.direction().as_vec3() - self.pos12.translation;
        let options = ShapeCastOptions {
            max_time_of_impact: 2.0,
            target_distance: [0.0, 0.2][rng.count(0, 1)],
            stop_at_penetration: rng.count(0, 1) == 0,
            ..Default::default()
        };
        let time = |hit: ShapeCastHit| hit.time_of_impact;
        let expected = self.least(|[a, b], pose| {
            let velocity = a.0.rotation.inverse() * velocity;
            let hit = us.cast_shapes(&pose, velocity, &*a.1, &*b.1, options);
            hit.expect("supported").map(time)
        });
        let hit = us.cast_shapes(&self.pos12, velocity, g1, g2, options);
        let found = hit.expect("supported").map(time);
        let off = (found.unwrap_or(2.0) - expected.unwrap_or(2.0)).abs();
        assert!(off < 1e-3, "{what}: {found:?}, not {expected:?}");
        let spin = rng.direction().as_vec3() * 2.0;
        let still = NonlinearRigidMotion::identity();
        let moving = NonlinearRigidMotion::new(self.pos12, Vector::ZERO, velocity, spin);
        let expected = self.least(|[a, b], _| {
            let (still, moving) = (still.prepend(a.0), moving.prepend(b.0));
            let hit = us.cast_shapes_nonlinear(&still, &*a.1, &moving, &*b.1, 0.0, 1.0, true);
            hit.expect("supported").map(time)
        });
        let hit = us.cast_shapes_nonlinear(&still, g1, &moving, g2, 0.0, 1.0, true);
        let found = hit.expect("supported").map(time);
        let off = (found.unwrap_or(1.0) - expected.unwrap_or(1.0)).abs();
        assert!(off < 1e-3, "{what}, turning: {found:?}, not {expected:?}");
        found.is_some()
    }
}

#[test]
fn height_fields_and_voxels_answer_as_their_cells() {
    let mut rng = Rng::new(41);
    let mut hits = 0;
    for round in 0..240 {
        let mut pair = Pair::random(&mut rng);
        if round % 2 == 1 {
            pair = pair.reversed();
        }
        let types = pair.wholes.each_ref().map(|whole| whole.shape.shape_type());
        let what = format!("{round}: {types:?}");
        pair.judge_near(&what);
        if round % 4 < 2 {
            hits += usize::from(pair.judge_casts(&mut rng, &what));
        }
    }
    assert!(hits > 40, "only {hits} meet");
}

/// No query counts the cells in the endless box of a half-space.
#[test]
fn half_spaces_meet_cells() {
    let us = IsaGjkDispatcher::default();
    let mut rng = Rng::new(42);
    let plane = SharedShape::halfspace(Vector::Y);
    for whole in [field(&mut rng), voxels(&mut rng)] {
        let high = Pose::translation(0.0, 10.0, 0.0);
        let lowest = |(at, part): &(Pose, SharedShape)| part.compute_aabb(at).mins.y;
        let bottom = whole.parts.iter().map(lowest).fold(Real::MAX, Real::min);
        let found = us.distance(&high, &*plane, &*whole.shape);
        let off = found.expect("supported").distance - (10.0 + bottom);
        assert!(off.abs() < TOLERANCE, "{off}");
        let options = ShapeCastOptions::default();
        let hit = us.cast_shapes(&high, -Vector::Y, &*plane, &*whole.shape, options);
        let hit = hit.expect("supported").expect("it falls on the plane");
        assert!((hit.time_of_impact - (10.0 + bottom)).abs() < TOLERANCE);
        let far = us.intersection_test(&high, &*plane, &*whole.shape);
        assert!(!far.expect("supported").intersecting);
    }
}

/// As a hull alone does: otherwise what falls on them fast is stopped just above them, and then falls through.
#[test]
fn compounds_meet_voxels_within_the_prediction() {
    let us = IsaGjkDispatcher::default();
    let hull = Rng::new(43).hull(20, 0.5).shape;
    // Any of some parts is the one that is near.
    let compounds = [0, 1, 2, 3, 4].map(|above| {
        let high = |i: usize| Pose::translation(0.0, 3.0 * i as Real, 0.0);
        let parts = (0..=above).rev().map(|i| (high(i), hull.clone()));
        SharedShape::compound(parts.collect())
    });
    let cells: Vec<_> = (0..4).map(|i| IVector::new(i % 2, -1, i / 2)).collect();
    let ground = SharedShape::voxels(Vector::ONE, &cells);
    let bottom = hull.compute_local_aabb().mins.y;
    let gaps = [-0.01, 0.01, 0.05, 0.09];
    for (gap, compound) in gaps
        .into_iter()
        .flat_map(|g| compounds.iter().map(move |c| (g, c)))
    {
        let pose = Pose::translation(1.1, gap - bottom, 0.9);
        for (is_reversed, shapes) in [(false, [&ground, compound]), (true, [compound, &ground])] {
            let pos12 = if is_reversed { pose.inverse() } else { pose };
            let shapes = shapes.map(|shape| &**shape);
            let mut memory = Memory::default();
            let (manifolds, workspace) = (&mut memory.manifolds, &mut memory.workspace);
            us.update_manifolds(&pos12, shapes, 0.1, manifolds, workspace)
                .expect("supported");
            let contacts = memory.manifolds.iter().flat_map(|m| &m.points);
            let least = contacts.map(|point| point.dist).reduce(Real::min);
            assert!(
                least.is_some_and(|least| (least - gap).abs() < TOLERANCE),
                "{gap}, {is_reversed}: {least:?}"
            );
        }
    }
}
