//! What the dispatcher remembers may make it faster, never wrong.
//!
//! The state of a pair lives in the manifold that rapier keeps for it, so it can be anything: a
//! frame old, a teleport old, made by another dispatcher, made for other shapes, or nonsense.
//! Whatever it is, the answer must be the one a cold query gives, and the manifold must keep the
//! contract that the solver relies on. Shapes themselves come and go, are mutated in place, and
//! are given the addresses of shapes that died: no answer may come from the dead.

mod common;

use common::cases::{Hull, hulls, trajectories};
use common::generate::{Dice, hull_of};
use common::memory::{Manifold, Memory, cold_manifold};
use common::oracle::{Solid, regret, signed_distance};
use common::pose::ExactPose;
use common::report::{Finding, Report};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Real, Vector};
use parry3d::query::{
    DefaultQueryDispatcher, PersistentQueryDispatcher, QueryDispatcher, TrackedContact,
};
use parry3d::shape::{ConvexPolyhedron, PackedFeatureId, SharedShape};

/// Warm against cold, relative to the size of the pair.
const DISTANCE_TOLERANCE: f64 = 1.0e-5;
/// Normals and points of manifolds, relative to the size of the pair.
const MANIFOLD_TOLERANCE: f64 = 1.0e-4;
/// Manifolds reach this far, relative to the size of the pair.
const REACH: f64 = 0.02;

/// One pose of a pair, with the exact answer.
struct Scene<'a> {
    solids: [&'a Solid; 2],
    shapes: [&'a SharedShape; 2],
    pose: ExactPose,
    exact: f64,
    scale: f64,
}

impl<'a> Scene<'a> {
    /// A pose whose exact answer the oracle finds.
    fn new(a: &'a Hull, b: &'a Hull, pose: ExactPose) -> Self {
        Self {
            solids: [&a.solid, &b.solid],
            shapes: [&a.shape, &b.shape],
            pose,
            exact: signed_distance(&a.solid, &b.solid, &pose),
            scale: a.solid.diameter().max(b.solid.diameter()),
        }
    }

    /// The same pose, seen from the other shape.
    fn swapped(&self) -> Self {
        let [a, b] = self.solids;
        let [shape_a, shape_b] = self.shapes;
        Self {
            solids: [b, a],
            shapes: [shape_b, shape_a],
            pose: self.pose.inverse(),
            ..*self
        }
    }

    fn prediction(&self) -> Real {
        (REACH * self.scale) as Real
    }

    fn update<'m>(
        &self,
        dispatcher: &IsaGjkDispatcher,
        memory: &'m mut Memory,
    ) -> Option<&'m Manifold> {
        memory.update(
            dispatcher,
            &self.pose.to_f32(),
            self.shapes,
            self.prediction(),
        )
    }

    fn cold(&self, dispatcher: &IsaGjkDispatcher) -> Option<Manifold> {
        cold_manifold(
            dispatcher,
            &self.pose.to_f32(),
            self.shapes,
            self.prediction(),
        )
    }

    /// Everything a manifold promises.
    fn judge(&self, manifold: Option<&Manifold>) -> Finding {
        let mut finding = Finding::default();
        match manifold {
            Some(manifold) => {
                self.judge_depth(&mut finding, manifold);
                if !manifold.points.is_empty() {
                    self.judge_normals(&mut finding, manifold);
                }
                for point in &manifold.points {
                    self.judge_point(&mut finding, manifold, point);
                }
            }
            None => finding.require(false, || "no manifold".to_owned()),
        }
        finding
    }

    /// The deepest point is as deep as the pair; out of reach there may be none.
    fn judge_depth(&self, finding: &mut Finding, manifold: &Manifold) {
        let slack = MANIFOLD_TOLERANCE * self.scale;
        let out_of_reach = self.exact > f64::from(self.prediction()) - slack;
        match manifold.find_deepest_contact() {
            Some(deepest) => finding.at_most(
                "depth error/scale",
                (f64::from(deepest.dist) - self.exact).abs() / self.scale,
                DISTANCE_TOLERANCE,
            ),
            None => finding.require(out_of_reach, || format!("lost a pair at {:e}", self.exact)),
        }
    }

    /// The normals are opposite unit vectors, and no other direction separates better.
    fn judge_normals(&self, finding: &mut Finding, manifold: &Manifold) {
        let (n1, n2) = (manifold.local_n1.as_dvec3(), manifold.local_n2.as_dvec3());
        finding.at_most("|n1|-1", (n1.length() - 1.0).abs(), DISTANCE_TOLERANCE);
        let opposite = self.pose.rotation * n2 + n1;
        finding.at_most("n1+n2", opposite.length(), DISTANCE_TOLERANCE);
        let [a, b] = self.solids;
        let regret = regret(a, b, &self.pose, n1, self.exact);
        finding.at_most("regret/scale", regret / self.scale, MANIFOLD_TOLERANCE);
    }

    /// A point lies in both shapes, and its distance is measured along the normal.
    fn judge_point(&self, finding: &mut Finding, manifold: &Manifold, point: &TrackedContact<()>) {
        let (p1, p2) = (point.local_p1.as_dvec3(), point.local_p2.as_dvec3());
        let along = (self.pose.apply(p2) - p1).dot(manifold.local_n1.as_dvec3());
        finding.at_most(
            "dist error/scale",
            (along - f64::from(point.dist)).abs() / self.scale,
            DISTANCE_TOLERANCE,
        );
        let outside = self.solids[0].outside(p1).max(self.solids[1].outside(p2));
        finding.at_most(
            "outside/scale",
            outside.max(0.0) / self.scale,
            MANIFOLD_TOLERANCE,
        );
    }

    /// Warm and cold see the same contact: the same depth, and normals that are equally good.
    fn judge_warm(&self, warm: Option<&Manifold>, cold: Option<&Manifold>) -> Finding {
        let mut finding = self.judge(warm);
        let deepest = |manifold: Option<&Manifold>| {
            manifold.and_then(|m| m.find_deepest_contact().map(|p| f64::from(p.dist)))
        };
        if let (Some(warm), Some(cold)) = (deepest(warm), deepest(cold)) {
            finding.at_most(
                "warm-cold/scale",
                (warm - cold).abs() / self.scale,
                DISTANCE_TOLERANCE,
            );
        }
        finding
    }

    /// The stateless queries, which have nothing to be misled by but the shapes.
    fn judge_stateless(&self, dispatcher: &IsaGjkDispatcher) -> Finding {
        let mut finding = Finding::default();
        let [shape1, shape2] = self.shapes;
        let pose = self.pose.to_f32();
        let limit = DISTANCE_TOLERANCE;
        match dispatcher.distance(&pose, &**shape1, &**shape2) {
            Ok(answer) => {
                let error = (f64::from(answer.distance) - self.exact.max(0.0)).abs();
                finding.at_most("distance error/scale", error / self.scale, limit);
            }
            Err(_) => finding.require(false, || "no distance".to_owned()),
        }
        let reach = (self.exact.max(0.0) + self.scale) as Real;
        match dispatcher.contact(&pose, &**shape1, &**shape2, reach) {
            Ok(Some(contact)) => {
                let error = (f64::from(contact.dist) - self.exact).abs();
                finding.at_most("contact error/scale", error / self.scale, limit);
            }
            other => finding.require(false, || format!("no contact: {other:?}")),
        }
        finding
    }
}

/// Follows one pair through its frames, both ways round, and compares with cold queries.
fn follow<'a>(report: &mut Report, name: &str, scenes: impl Iterator<Item = (String, Scene<'a>)>) {
    let dispatcher = IsaGjkDispatcher::default();
    let (mut memory, mut mirrored) = (Memory::default(), Memory::default());
    for (id, scene) in scenes {
        let cold = scene.cold(&dispatcher);
        let warm = scene.update(&dispatcher, &mut memory);
        report.add(
            &format!("{name}, warm"),
            &id,
            scene.judge_warm(warm, cold.as_ref()),
        );
        report.add(&format!("{name}, cold"), &id, scene.judge(cold.as_ref()));

        let swapped = scene.swapped();
        let warm = swapped.update(&dispatcher, &mut mirrored);
        report.add(
            &format!("{name}, warm, swapped"),
            &id,
            swapped.judge_warm(warm, cold.as_ref()),
        );
    }
}

/// Two hulls of 8 to 300 corners, and about how far apart their centres are when they touch.
fn random_pair(dice: &mut Dice) -> (Hull, Hull, f64) {
    let [a, b] = [(); 2].map(|()| {
        let corners = if dice.range(0.0, 1.0) < 0.2 {
            dice.count(100, 300)
        } else {
            dice.count(8, 100)
        };
        let size = dice.range(0.5, 1.5);
        dice.hull(corners, size)
    });
    let reach = 0.5 * (a.solid.diameter() + b.solid.diameter());
    (a, b, reach)
}

/// A pose near touching more often than not: the middle of a random approach.
fn random_scene<'a>(dice: &mut Dice, a: &'a Hull, b: &'a Hull, reach: f64) -> Scene<'a> {
    let frame = dice.count(0, 15);
    Scene::new(a, b, dice.passage(32, reach)[frame])
}

#[test]
fn published_trajectories_are_answered_warm_as_cold() {
    let mut report = Report::new("published trajectories");
    for frames in trajectories() {
        let scenes = frames.iter().map(|case| {
            let (a, b) = (&hulls()[&case.shape_a], &hulls()[&case.shape_b]);
            let scene = Scene {
                solids: [&a.solid, &b.solid],
                shapes: [&a.shape, &b.shape],
                pose: case.pose(),
                exact: case.signed_distance,
                scale: case.scale,
            };
            (case.id.clone(), scene)
        });
        follow(&mut report, "manifold", scenes);
    }
    report.conclude();
}

#[test]
fn smooth_motions_are_answered_warm_as_cold() {
    let mut report = Report::new("smooth random motions");
    let mut dice = Dice::new(1);
    for motion in 0..100 {
        let (a, b, reach) = random_pair(&mut dice);
        let poses = dice.passage(60, reach);
        let scenes = poses.into_iter().enumerate().map(|(frame, pose)| {
            let id = format!("motion {motion} frame {frame}");
            (id, Scene::new(&a, &b, pose))
        });
        follow(&mut report, "manifold", scenes);
    }
    report.conclude();
}

#[test]
fn a_teleport_is_answered_as_if_nothing_were_remembered() {
    let mut report = Report::new("teleports");
    let mut dice = Dice::new(2);
    for motion in 0..100 {
        let (a, b, reach) = random_pair(&mut dice);
        let mut poses = dice.passage(40, reach);
        for frame in (7..40).step_by(4) {
            poses[frame] = dice.pose(1.2 * reach);
        }
        let scenes = poses.into_iter().enumerate().map(|(frame, pose)| {
            let id = format!("motion {motion} frame {frame}");
            (id, Scene::new(&a, &b, pose))
        });
        follow(&mut report, "manifold", scenes);
    }
    report.conclude();
}

/// Rolled back, copied to another world or stepped by another dispatcher, a pair goes on as it
/// would have gone on, to the last bit.
#[test]
fn a_copy_goes_on_alike() {
    let mut dice = Dice::new(8);
    for _ in 0..20 {
        let (a, b, reach) = random_pair(&mut dice);
        let poses = dice.passage(60, reach);
        let shapes = [&a.shape, &b.shape];
        let dispatcher = IsaGjkDispatcher::default();
        let mut memory = Memory::default();
        let mut history = Vec::new();
        for pose in &poses {
            history.push(memory.clone());
            memory.update(&dispatcher, &pose.to_f32(), shapes, 0.02);
        }
        for start in [10, 25, 30, 45] {
            let mut copy = history[start].clone();
            let dispatcher = IsaGjkDispatcher::default();
            for frame in start..start + 10 {
                copy.update(&dispatcher, &poses[frame].to_f32(), shapes, 0.02);
                let (now, then) = (&copy.manifolds, &history[frame + 1].manifolds);
                assert_eq!(format!("{now:?}"), format!("{then:?}"), "frame {frame}");
            }
        }
    }
}

/// Queries `scene` with a memory that is not its own, twice: the second frame sees what the
/// first one made of it.
fn judge_with(report: &mut Report, route: &str, id: &str, scene: &Scene, mut memory: Memory) {
    let dispatcher = IsaGjkDispatcher::default();
    for frame in ["first frame", "second frame"] {
        let manifold = scene.update(&dispatcher, &mut memory);
        report.add(&format!("{route}, {frame}"), id, scene.judge(manifold));
    }
}

#[test]
fn manifolds_of_another_dispatcher_do_no_harm() {
    let mut report = Report::new("manifolds filled by parry");
    let mut dice = Dice::new(3);
    for pair in 0..100 {
        let (a, b, reach) = random_pair(&mut dice);
        let scene = random_scene(&mut dice, &a, &b, reach);
        let earlier = random_scene(&mut dice, &a, &b, reach);
        for (route, source) in [("same pose", &scene), ("another pose", &earlier)] {
            let mut memory = Memory::default();
            DefaultQueryDispatcher
                .contact_manifolds(
                    &source.pose.to_f32(),
                    &**source.shapes[0],
                    &**source.shapes[1],
                    source.prediction(),
                    &mut memory.manifolds,
                    &mut memory.workspace,
                )
                .expect("parry supports hulls");
            judge_with(&mut report, route, &format!("pair {pair}"), &scene, memory);
        }
    }
    report.conclude();
}

#[test]
fn manifolds_of_larger_hulls_do_no_harm() {
    let mut report = Report::new("manifolds of other hulls");
    let mut dice = Dice::new(4);
    for pair in 0..100 {
        let [large_a, large_b] = [(); 2].map(|()| dice.hull(300, 1.0));
        let [small_a, small_b] = [(); 2].map(|()| {
            let corners = dice.count(4, 12);
            dice.hull(corners, 1.0)
        });
        let large = random_pose_scene(&mut dice, &large_a, &large_b);
        let small = random_scene(&mut dice, &small_a, &small_b, 1.0);
        let mut memory = Memory::default();
        large.update(&IsaGjkDispatcher::default(), &mut memory);
        memory.workspace = None;
        judge_with(
            &mut report,
            "indices out of range",
            &format!("pair {pair}"),
            &small,
            memory,
        );
    }
    report.conclude();
}

/// A pose of hulls that only serve to fill a manifold: no oracle needed.
fn random_pose_scene<'a>(dice: &mut Dice, a: &'a Hull, b: &'a Hull) -> Scene<'a> {
    Scene {
        solids: [&a.solid, &b.solid],
        shapes: [&a.shape, &b.shape],
        pose: dice.pose(1.2),
        exact: f64::NAN,
        scale: 1.0,
    }
}

#[test]
fn manifolds_full_of_nonsense_do_no_harm() {
    let mut report = Report::new("nonsense in the manifold");
    let mut dice = Dice::new(5);
    let nonsense = [
        Vector::ZERO,
        Vector::NAN,
        Vector::INFINITY,
        Vector::NEG_INFINITY,
        Vector::MAX,
        Vector::splat(1.0e-40),
        Vector::new(7.0, -3.0, 1.0e9),
        Vector::new(0.5, Real::NAN, 4.0e9),
    ];
    for pair in 0..12 {
        let (a, b, reach) = random_pair(&mut dice);
        let scene = random_scene(&mut dice, &a, &b, reach);
        for n1 in nonsense {
            for n2 in nonsense {
                for (route, points) in [("no points", 0), ("one point", 1), ("four points", 4)] {
                    let memory = Memory {
                        manifolds: vec![nonsensical_manifold(n1, n2, points)],
                        workspace: None,
                    };
                    let id = format!("pair {pair}, n1 {n1:?}, n2 {n2:?}");
                    judge_with(&mut report, route, &id, &scene, memory);
                }
            }
        }
    }
    report.conclude();
}

fn nonsensical_manifold(n1: Vector, n2: Vector, points: u32) -> Manifold {
    let mut manifold = Manifold::new();
    manifold.local_n1 = n1;
    manifold.local_n2 = n2;
    manifold.points = (0..points)
        .map(|i| {
            let feature1 = PackedFeatureId::vertex(1000 * i);
            let feature2 = PackedFeatureId::face(1000 * i);
            TrackedContact::new(n2, n1, feature1, feature2, n1.x)
        })
        .collect();
    manifold
}

/// Small and large hulls are known again in different ways.
const SIZES: [usize; 2] = [30, 200];

/// New hulls with the same number of corners, so that the allocator hands out old addresses.
#[test]
fn replaced_shapes_are_answered_as_they_are() {
    SIZES.into_iter().for_each(check_replaced_shapes);
}

fn check_replaced_shapes(corners: usize) {
    let mut report = Report::new(format!("replaced shapes of {corners} corners"));
    let mut dice = Dice::new(6);
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let mut addresses = Vec::new();
    for turn in 0..200 {
        let [a, b] = [(); 2].map(|()| dice.hull(corners, 1.0));
        addresses.push(std::ptr::from_ref(&*a.shape).addr());
        let scene = random_scene(&mut dice, &a, &b, 0.9);
        let id = format!("turn {turn}");
        let manifold = scene.update(&dispatcher, &mut memory);
        report.add("manifold", &id, scene.judge(manifold));
        report.add("stateless", &id, scene.judge_stateless(&dispatcher));
        memory.workspace = None;
    }
    report.conclude();
    let turns = addresses.len();
    addresses.sort_unstable();
    addresses.dedup();
    assert!(addresses.len() < turns, "the allocator reused no address");
}

/// Changes the polyhedron inside `shape` where it lies.
fn mutate(shape: &mut SharedShape, change: impl FnOnce(&mut ConvexPolyhedron)) {
    let before = std::ptr::from_ref(&**shape).addr();
    let polyhedron = shape
        .make_mut()
        .as_convex_polyhedron_mut()
        .expect("a convex polyhedron");
    change(polyhedron);
    let after = std::ptr::from_ref(&**shape).addr();
    assert_eq!(before, after, "the shape did not stay in place");
}

/// A hull put in the place of another.
fn replace_in_place(hull: &mut Hull, other: Hull) {
    let new = other
        .shape
        .as_convex_polyhedron()
        .expect("a convex polyhedron")
        .clone();
    mutate(&mut hull.shape, |polyhedron| *polyhedron = new);
    hull.solid = other.solid;
}

/// A hull scaled without moving even its list of points.
fn scale_in_place(hull: &mut Hull, scale: Vector) {
    let stand_in = hull_of(&[Vector::ZERO, Vector::X, Vector::Y, Vector::Z]);
    let stand_in = stand_in
        .expect("a tetrahedron is convex")
        .shape
        .as_convex_polyhedron()
        .expect("a convex polyhedron")
        .clone();
    let mut points = Vec::new();
    mutate(&mut hull.shape, |polyhedron| {
        let scaled = std::mem::replace(polyhedron, stand_in)
            .scaled(scale)
            .expect("a scaled hull");
        points = scaled.points().to_vec();
        *polyhedron = scaled;
    });
    hull.solid = hull.solid.with_points(points.iter().map(|p| p.as_dvec3()));
}

#[test]
fn shapes_mutated_in_place_are_answered_as_they_are() {
    SIZES.into_iter().for_each(check_shapes_mutated_in_place);
}

fn check_shapes_mutated_in_place(corners: usize) {
    let mut report = Report::new(format!("shapes of {corners} corners mutated in place"));
    let mut dice = Dice::new(7);
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let [mut a, b] = [(); 2].map(|()| dice.hull(corners, 1.0));
    for turn in 0..150 {
        let route = if turn % 3 == 0 {
            replace_in_place(&mut a, dice.hull(corners, 1.0));
            "replaced"
        } else {
            let scale = Vector::splat(if turn % 3 == 1 { 1.5 } else { 0.5 });
            scale_in_place(&mut a, scale * Vector::new(1.0, 0.9, 1.1));
            "scaled"
        };
        let reach = 0.5 * (a.solid.diameter() + b.solid.diameter());
        let scene = random_scene(&mut dice, &a, &b, reach);
        let id = format!("turn {turn}");
        let manifold = scene.update(&dispatcher, &mut memory);
        report.add(&format!("{route}, manifold"), &id, scene.judge(manifold));
        report.add(
            &format!("{route}, stateless"),
            &id,
            scene.judge_stateless(&dispatcher),
        );
        memory.workspace = None;
    }
    report.conclude();
}
