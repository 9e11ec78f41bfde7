//! Hulls against balls, capsules, segments and half-spaces: exact, cold and coherent, whichever of
//! the two comes first, in poses and sizes that games have.

use glam::{DQuat, DVec3};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::QueryDispatcher;
use parry3d::shape::SharedShape;
use testkit::cases::Hull;
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, UpdateManifolds, cold_manifold};
use testkit::oracle::{Solid, regret, signed_distance};
use testkit::pose::ExactPose;

/// Of the larger shape's diameter.
const DISTANCE: f64 = 1.0e-5;
const REGRET: f64 = 1.0e-4;
/// The share of the smaller radius by which contacts that keep their places come apart sideways.
const KEPT: f64 = 2.0e-2;

/// A core with a border around it, for the oracle and for parry.
struct Round {
    name: &'static str,
    core: Solid,
    border: f64,
    shape: SharedShape,
}

fn ball(radius: Real) -> Round {
    Round {
        name: "ball",
        core: Solid::point(DVec3::ZERO),
        border: radius.into(),
        shape: SharedShape::ball(radius),
    }
}

fn capsule(ends: [Vector; 2], radius: Real) -> Round {
    let core = Solid::segment(ends.map(|p| p.as_dvec3()));
    let [a, b] = ends;
    if radius > 0.0 {
        Round {
            name: "capsule",
            core,
            border: radius.into(),
            shape: SharedShape::capsule(a, b, radius),
        }
    } else {
        Round {
            name: "segment",
            core,
            border: 0.0,
            shape: SharedShape::segment(a, b),
        }
    }
}

fn rounds(size: Real) -> Vec<Round> {
    let ends = [Vector::new(-0.1, -0.4, 0.2), Vector::new(0.2, 0.5, -0.1)].map(|p| p * size);
    vec![
        ball(0.3 * size),
        ball(0.01 * size),
        ball(3.0 * size),
        capsule(ends, 0.15 * size),
        capsule(ends.map(|p| p * 0.05), 0.4 * size),
        capsule(ends, 0.0),
    ]
}

/// The checks in one pose.
struct Check<'a> {
    hull: &'a Hull,
    round: &'a Round,
    pose: ExactPose,
    prediction: f64,
    what: String,
}

impl Check<'_> {
    fn scale(&self) -> f64 {
        let round = self.round.core.diameter() + 2.0 * self.round.border;
        self.hull.solid.diameter().max(round)
    }

    /// `normals` and `points` of the hull and of the round shape, in their own frames.
    fn answer(&self, kind: &str, distance: f64, normals: [DVec3; 2], points: [DVec3; 2]) {
        let what = format!("{kind}, {}", self.what);
        let core = signed_distance(&self.hull.solid, &self.round.core, &self.pose);
        let exact = core - self.round.border;
        let error = (distance - exact).abs() / self.scale();
        assert!(error <= DISTANCE, "{what}: {distance} for {exact}");
        let worse = regret(
            &self.hull.solid,
            &self.round.core,
            &self.pose,
            normals[0],
            core,
        );
        assert!(worse <= REGRET * self.scale(), "{what}: regret {worse:e}");
        let opposite = self.pose.rotation * normals[1];
        assert!(
            opposite.distance(-normals[0]) < 1.0e-5,
            "{what}: {normals:?}"
        );
        self.points(&what, distance, normals[0], points);
    }

    /// The points are on their surfaces, and apart by the distance along the normal.
    fn points(&self, what: &str, distance: f64, normal: DVec3, [on_hull, on_round]: [DVec3; 2]) {
        let slack = 2.0 * DISTANCE * self.scale();
        // Contacts that keep their places may come apart across the normal.
        let across = if what.starts_with("warm") {
            KEPT * self.scale()
        } else {
            slack
        };
        let gap = self.pose.apply(on_round) - on_hull;
        assert!(
            (gap.dot(normal) - distance).abs() <= slack,
            "{what}: {gap} for {distance}"
        );
        assert!(
            gap.distance(normal * distance) <= across,
            "{what}: {gap} for {distance}"
        );
        assert!(
            self.hull.solid.outside(on_hull).abs() <= slack,
            "{what}: off the hull"
        );
        let core = &self.round.core.points;
        let [a, b] = [core[0], core[core.len() - 1]];
        let along = (b - a).normalize_or_zero();
        let from_a = on_round - a;
        let t = from_a.dot(along).clamp(0.0, a.distance(b));
        assert!(
            (from_a.distance(along * t) - self.round.border).abs() <= slack,
            "{what}: off the surface"
        );
    }

    fn manifold(&self, kind: &str, manifold: &Manifold, swapped: bool) {
        let core = signed_distance(&self.hull.solid, &self.round.core, &self.pose);
        let exact = core - self.round.border;
        let Some(deepest) = manifold.find_deepest_contact() else {
            let missed = self.prediction - exact;
            assert!(
                missed <= DISTANCE * self.scale(),
                "{kind}, {}: lost",
                self.what
            );
            return;
        };
        let normals = ordered([manifold.local_n1, manifold.local_n2], swapped);
        let points = |p: &parry3d::query::TrackedContact<u32>| {
            ordered([p.local_p1, p.local_p2], swapped).map(|p| p.as_dvec3())
        };
        let normals = normals.map(|n| n.as_dvec3());
        self.answer(kind, deepest.dist.into(), normals, points(deepest));
        for point in &manifold.points {
            let [p, q] = points(point);
            let gap = (self.pose.apply(q) - p).dot(normals[0]);
            let off = (gap - f64::from(point.dist)).abs();
            assert!(
                off <= DISTANCE * self.scale(),
                "{kind}, {}: {point:?}",
                self.what
            );
        }
    }
}

fn ordered<T>([a, b]: [T; 2], swapped: bool) -> [T; 2] {
    if swapped { [b, a] } else { [a, b] }
}

/// The pose that a dispatcher is given, and the exact one that it stands for.
fn given(pose: ExactPose, swapped: bool) -> (Pose, ExactPose) {
    if swapped {
        let inverse = pose.inverse().rounded();
        (inverse.to_f32(), inverse.inverse())
    } else {
        (pose.to_f32(), pose)
    }
}

#[test]
fn answers_are_exact_cold_and_coherent_in_either_order() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(3);
    for (size, vertices) in [(1.0, 8), (1.0, 60), (1.0e-3, 20), (30.0, 24), (1.0, 6)] {
        let hull = rng.hull(vertices, size);
        for round in rounds(size as Real) {
            let reach = 0.5 * hull.solid.diameter() + 0.5 * round.core.diameter() + round.border;
            let prediction = 0.05 * size;
            let frames = rng.trajectory(40, reach);
            for swapped in [false, true] {
                let mut warm = Memory::default();
                for (i, frame) in frames.iter().enumerate() {
                    let (pose12, pose) = given(*frame, swapped);
                    let check = Check {
                        hull: &hull,
                        round: &round,
                        pose,
                        prediction,
                        what: format!(
                            "{} of {} on {vertices} vertices of {size}, frame {i}, {swapped}",
                            round.name, round.border
                        ),
                    };
                    let shapes = ordered([&hull.shape, &round.shape], swapped);
                    let reach = prediction as Real;
                    let manifold = warm.update(&dispatcher, &pose12, shapes, reach);
                    check.manifold("warm", manifold.expect("supported"), swapped);
                    let manifold = cold_manifold(&dispatcher, &pose12, shapes, reach);
                    check.manifold("cold", &manifold.expect("supported"), swapped);
                    let contact = dispatcher
                        .contact(&pose12, &**shapes[0], &**shapes[1], Real::MAX)
                        .expect("supported")
                        .expect("within reach");
                    let normals = ordered([contact.normal1, contact.normal2], swapped);
                    let points = ordered([contact.point1, contact.point2], swapped);
                    check.answer(
                        "contact",
                        contact.dist.into(),
                        normals.map(|n| n.as_dvec3()),
                        points.map(|p| p.as_dvec3()),
                    );
                    let apart = dispatcher
                        .distance(&pose12, &**shapes[0], &**shapes[1])
                        .expect("supported");
                    assert_eq!(apart.distance, contact.dist.max(0.0), "{}", check.what);
                }
            }
        }
    }
}

/// A box as a hull, one unit high, its top at the height 0.5.
fn table() -> SharedShape {
    let corner = |i: u32| {
        let side = |bit: u32, half: Real| if i >> bit & 1 == 0 { -half } else { half };
        Vector::new(side(0, 1.0), side(1, 0.5), side(2, 1.0))
    };
    SharedShape::convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).expect("a box")
}

#[test]
fn a_lying_capsule_rests_on_both_ends() {
    let dispatcher = IsaGjkDispatcher::default();
    let capsule = SharedShape::capsule_x(0.4, 0.2);
    for (x, ends) in [(0.0, [-0.4, 0.4]), (0.9, [0.5, 1.0])] {
        // Sunk in, lying exactly flat and tilted by less than the prediction.
        for tilt in [0.0, 0.001] {
            let rotation = DQuat::from_rotation_z(tilt).as_quat();
            let pose = Pose::from_parts(Vector::new(x, 0.69, 0.1), rotation);
            for swapped in [false, true] {
                let shapes = ordered([&table(), &capsule], swapped).map(Clone::clone);
                let pose = if swapped { pose.inverse() } else { pose };
                let shapes = [&shapes[0], &shapes[1]];
                let manifold = cold_manifold(&dispatcher, &pose, shapes, 0.02).expect("supported");
                let mut places: Vec<Real> = manifold
                    .points
                    .iter()
                    .map(|p| ordered([p.local_p1, p.local_p2], swapped)[0].x)
                    .collect();
                places.sort_by(Real::total_cmp);
                assert_eq!(places.len(), 2, "{places:?}");
                for (place, end) in places.iter().zip(ends) {
                    assert!((place - end).abs() < 2.0e-3, "{places:?} for {ends:?}");
                }
            }
        }
    }
}

#[test]
fn a_rolling_ball_keeps_its_impulse() {
    let dispatcher = IsaGjkDispatcher::default();
    let (floor, ball) = (Rng::new(8).hull(200, 4.0).shape, SharedShape::ball(0.5));
    let top = |x: Real| {
        // Where the ball touches, above the point that it rolls over.
        let apart = |y: Real| {
            let pose = Pose::translation(x, y, 0.0);
            let distance = dispatcher
                .distance(&pose, &*floor, &*ball)
                .expect("supported");
            distance.distance
        };
        let (mut low, mut high) = (0.0, 8.0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if apart(middle) > 0.0 {
                high = middle
            } else {
                low = middle
            }
        }
        high - 0.001
    };
    for swapped in [false, true] {
        let mut manifolds = Vec::new();
        let mut features = std::collections::BTreeSet::new();
        for step in 0..60 {
            let x = -0.6 + 0.02 * step as Real;
            let pose = Pose::translation(x, top(x), 0.0);
            let pose = if swapped { pose.inverse() } else { pose };
            let [s1, s2] = ordered([&floor, &ball], swapped);
            dispatcher
                .update_manifolds(&pose, [&**s1, &**s2], 0.02, &mut manifolds, &mut None)
                .expect("supported");
            let [point] = &mut manifolds[0].points[..] else {
                panic!("a ball has one contact")
            };
            assert_eq!(point.data, step, "the impulse of the frame before");
            point.data += 1;
            features.insert(ordered([point.fid1, point.fid2], swapped)[0].0);
        }
        assert!(
            features.len() > 3,
            "it rolled over {} features",
            features.len()
        );
    }
}

#[test]
fn half_spaces_carry_hulls_on_their_lowest_face() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(5);
    for (size, vertices) in [(1.0, 8), (1.0, 100), (1.0e-3, 30), (30.0, 30)] {
        let hull = rng.hull(vertices, size);
        let up = rng.direction();
        let normal = up.as_vec3().normalize();
        let up = normal.as_dvec3().normalize();
        let ground = SharedShape::halfspace(normal);
        let prediction = 0.05 * size;
        for frame in rng.trajectory(60, 0.5 * hull.solid.diameter()) {
            for swapped in [false, true] {
                let (pose12, pose) = given(frame, swapped);
                let tolerance = 1.0e-6 * (hull.solid.diameter() + pose.translation.length());
                let inverse = pose.inverse();
                let heights = hull.solid.points.iter().map(|p| up.dot(inverse.apply(*p)));
                let exact = heights.fold(f64::INFINITY, f64::min);
                let shapes = ordered([&hull.shape, &ground], swapped);
                let contact = dispatcher
                    .contact(&pose12, &**shapes[0], &**shapes[1], Real::MAX)
                    .expect("supported")
                    .expect("within reach");
                assert!((f64::from(contact.dist) - exact).abs() <= tolerance);
                let manifold = cold_manifold(&dispatcher, &pose12, shapes, prediction as Real)
                    .expect("supported");
                let Some(deepest) = manifold.find_deepest_contact() else {
                    assert!(exact > prediction - tolerance, "lost at {exact}");
                    continue;
                };
                assert!((f64::from(deepest.dist) - exact).abs() <= tolerance);
                let normals = ordered([manifold.local_n1, manifold.local_n2], swapped);
                assert!(normals[1].distance(normal) < 1.0e-6);
                for point in &manifold.points {
                    let points = ordered([point.local_p1, point.local_p2], swapped);
                    let [p, q] = points.map(|p| p.as_dvec3());
                    assert!(hull.solid.outside(p).abs() <= tolerance);
                    assert!(up.dot(q).abs() <= tolerance, "{q} is not on the plane");
                    let height = up.dot(inverse.apply(p));
                    assert!((f64::from(point.dist) - height).abs() <= tolerance);
                    assert!((inverse.apply(p) - up * height).distance(q) <= tolerance);
                }
            }
        }
    }
}

#[test]
fn a_box_on_a_half_space_stands_on_four_corners() {
    let dispatcher = IsaGjkDispatcher::default();
    let ground = SharedShape::halfspace(Vector::Y);
    let pose = Pose::translation(3.0, 0.499, -2.0);
    let manifold = cold_manifold(&dispatcher, &pose, [&ground, &table()], 0.01);
    let manifold = manifold.expect("supported");
    assert_eq!(manifold.points.len(), 4);
    assert!(
        manifold
            .points
            .iter()
            .all(|p| (p.dist + 0.001).abs() < 1.0e-6)
    );
}

#[test]
fn nothing_finite_comes_of_nonsense() {
    let dispatcher = IsaGjkDispatcher::default();
    let hull = table();
    let odd = [
        SharedShape::ball(0.0),
        SharedShape::ball(Real::MAX),
        SharedShape::capsule_y(0.0, 0.2),
        SharedShape::segment(Vector::ONE, Vector::ONE),
        SharedShape::ball(1.0e-30),
    ];
    for shape in &odd {
        for at in [
            Vector::ZERO,
            Vector::new(0.3, 0.5, 0.0),
            Vector::splat(1.0e6),
        ] {
            for [s1, s2] in [[&hull, shape], [shape, &hull]] {
                let pose = Pose::from_translation(at);
                let manifold = cold_manifold(&dispatcher, &pose, [s1, s2], 0.02);
                for point in manifold.expect("supported").points {
                    assert!(point.dist.is_finite() && point.local_p1.is_finite());
                }
            }
        }
    }
}
