//! Nothing a user can do to a pair may hang the step, panic in it, or poison the next one.
//!
//! A body that was given a NaN impulse, a prediction of zero or without bound, a pebble on a
//! planet, a world ten kilometres from its origin, a hull that is almost flat: a physics engine
//! meets all of them sooner or later. Finite input must give finite output, whatever its size;
//! input that is not finite may give any answer, but it must give it soon and leave no trace.

use std::sync::mpsc;
use std::time::Duration;

use glam::{DQuat, DVec3};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{ClosestPoints, Contact, QueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::cases::Hull;
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, UpdateManifolds, cold_manifold};
use testkit::oracle::{Solid, regret, signed_distance};
use testkit::pose::ExactPose;
use testkit::report::{Finding, Report};
use testkit::shape_samples::{poses, shape_samples};

/// Fails if `work` takes longer than any query may.
fn soon<T: Send + 'static>(what: &str, work: impl FnOnce() -> T + Send + 'static) -> T {
    const PATIENCE: Duration = Duration::from_secs(20);
    let (done, result) = mpsc::channel();
    std::thread::spawn(move || done.send(work()));
    result
        .recv_timeout(PATIENCE)
        .unwrap_or_else(|error| panic!("{what}: {error}"))
}

fn manifold_is_finite(manifold: &Manifold) -> bool {
    manifold.local_n1.is_finite()
        && manifold.points.iter().all(|point| {
            point.local_p1.is_finite() && point.local_p2.is_finite() && point.dist.is_finite()
        })
}

fn contact_is_finite(contact: &Contact) -> bool {
    let vectors = [
        contact.point1,
        contact.point2,
        contact.normal1,
        contact.normal2,
    ];
    contact.dist.is_finite() && vectors.iter().all(|v| v.is_finite())
}

/// What the stateless queries and a cold manifold say about a pair.
struct Answers {
    distance: Real,
    contact: Option<Contact>,
    closest_points: ClosestPoints,
    manifold: Manifold,
}

impl Answers {
    fn new(pose: &Pose, shapes: [&SharedShape; 2], prediction: Real) -> Self {
        let dispatcher = IsaGjkDispatcher::default();
        let (g1, g2) = (&**shapes[0], &**shapes[1]);
        let supported = "hulls are supported";
        dispatcher.intersection_test(pose, g1, g2).expect(supported);
        Self {
            distance: dispatcher.distance(pose, g1, g2).expect(supported).distance,
            contact: dispatcher
                .contact(pose, g1, g2, prediction)
                .expect(supported),
            closest_points: dispatcher
                .closest_points(pose, g1, g2, prediction)
                .expect(supported),
            manifold: cold_manifold(&dispatcher, pose, shapes, prediction).expect(supported),
        }
    }

    fn are_finite(&self) -> bool {
        let points_are_finite = match self.closest_points {
            ClosestPoints::WithinMargin(p1, p2) => p1.is_finite() && p2.is_finite(),
            ClosestPoints::Intersecting | ClosestPoints::Disjoint => true,
        };
        self.distance.is_finite()
            && self.contact.as_ref().is_none_or(contact_is_finite)
            && points_are_finite
            && manifold_is_finite(&self.manifold)
    }
}

/// A small, a medium and a large hull.
fn hulls() -> [Hull; 3] {
    let mut rng = Rng::new(21);
    [4, 30, 200].map(|corners| rng.hull(corners, 1.0))
}

/// Measures all answers about a pair in units of the `tolerance`.
fn judge(a: &Hull, b: &Hull, pose: ExactPose, tolerance: f64) -> Finding {
    let exact = signed_distance(&a.solid, &b.solid, &pose);
    let prediction = (exact.max(0.0) * 1.1 + 100.0 * tolerance) as Real;
    let answers = Answers::new(&pose.to_f32(), [&a.shape, &b.shape], prediction);
    let mut finding = Finding::default();
    finding.require(answers.are_finite(), || "not finite".to_owned());
    let error = (f64::from(answers.distance) - exact.max(0.0)).abs();
    finding.at_most("distance error", error / tolerance, 1.0);
    let deepest = answers.manifold.find_deepest_contact();
    judge_dist(
        &mut finding,
        "manifold error",
        deepest.map(|p| p.dist),
        exact,
        tolerance,
    );
    let contact = answers.contact;
    judge_dist(
        &mut finding,
        "contact error",
        contact.map(|c| c.dist),
        exact,
        tolerance,
    );
    if let Some(contact) = contact {
        let normal = contact.normal1.as_dvec3();
        let regret = regret(&a.solid, &b.solid, &pose, normal, exact);
        finding.at_most("regret", regret / tolerance, 10.0);
    }
    finding
}

/// Measures one signed distance that must be there.
fn judge_dist(
    finding: &mut Finding,
    quantity: &'static str,
    dist: Option<Real>,
    exact: f64,
    tolerance: f64,
) {
    match dist {
        Some(dist) => {
            let error = (f64::from(dist) - exact).abs();
            finding.at_most(quantity, error / tolerance, 1.0);
        }
        None => finding.require(false, || format!("{quantity}: nothing at {exact:e}")),
    }
}

/// Poses with every kind of number that is not one, in every place.
fn impossible_poses() -> Vec<Pose> {
    let bad = [Real::NAN, Real::INFINITY, Real::NEG_INFINITY];
    let mut poses = vec![
        Pose::from_parts(Vector::X, Rotation::from_xyzw(0.0, 0.0, 0.0, 0.0)),
        Pose::from_parts(Vector::MAX, Rotation::IDENTITY),
        Pose::from_parts(Vector::MIN, Rotation::IDENTITY),
    ];
    for x in bad {
        for translation in [
            Vector::new(x, 0.0, 0.0),
            Vector::new(0.3, x, 0.0),
            Vector::splat(x),
        ] {
            poses.push(Pose::from_parts(translation, Rotation::IDENTITY));
        }
        for rotation in [[x, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, x], [x; 4]] {
            poses.push(Pose::from_parts(Vector::X, Rotation::from_array(rotation)));
        }
    }
    poses
}

#[test]
fn impossible_poses_between_hulls_leave_no_trace() {
    let mut report = Report::new("after an impossible pose");
    let [small, medium, large] = hulls();
    let possible = ExactPose {
        rotation: DQuat::from_rotation_x(0.5),
        translation: DVec3::new(0.2, 0.3, 0.1),
    }
    .rounded();
    for [a, b] in [[&small, &medium], [&medium, &large], [&large, &large]] {
        let exact = signed_distance(&a.solid, &b.solid, &possible);
        for impossible in impossible_poses() {
            let id = format!("{impossible:?}");
            let shapes = [a.shape.clone(), b.shape.clone()];
            let deepest = soon(&id, move || {
                let dispatcher = IsaGjkDispatcher::default();
                let [a, b] = &shapes;
                let mut memory = Memory::default();
                Answers::new(&impossible, [a, b], 0.1);
                memory.update(&dispatcher, &impossible, [a, b], 0.1);
                memory.update(&dispatcher, &impossible, [a, b], 0.1);
                let manifold = memory.update(&dispatcher, &possible.to_f32(), [a, b], 0.1)?;
                manifold.find_deepest_contact().map(|point| point.dist)
            });
            let mut finding = Finding::default();
            judge_dist(&mut finding, "manifold error", deepest, exact, 1.0e-5);
            report.add("next frame", &id, finding);
        }
    }
    report.conclude();
}

#[test]
fn impossible_poses_of_other_shapes_end_soon() {
    let [_, hull, _] = hulls();
    let others = [
        SharedShape::cuboid(0.3, 0.4, 0.5),
        SharedShape::ball(0.5),
        SharedShape::cylinder(0.5, 0.3),
    ];
    for other in others {
        for pose in impossible_poses() {
            let (hull, other) = (hull.shape.clone(), other.clone());
            let supported = soon(&format!("{pose:?}"), move || {
                let dispatcher = IsaGjkDispatcher::default();
                [[&hull, &other], [&other, &hull]]
                    .map(|pair| cold_manifold(&dispatcher, &pose, pair, 0.1).is_some())
            });
            assert_eq!(supported, [true, true], "{pose:?}");
        }
    }
}

#[test]
fn any_prediction_is_survived() {
    let mut report = Report::new("predictions");
    let [small, medium, large] = hulls();
    let finite = [
        0.0,
        -0.0,
        -0.1,
        -1.0e10,
        1.0e-30,
        0.3,
        1.0e10,
        Real::MIN,
        Real::MAX,
    ];
    let not_finite = [Real::INFINITY, Real::NEG_INFINITY, Real::NAN];
    for [a, b] in [[&small, &medium], [&medium, &large]] {
        for offset in [0.0, 0.4, 0.9, 1.1, 3.0] {
            let pose = ExactPose {
                rotation: DQuat::from_rotation_z(0.4),
                translation: DVec3::new(offset, 0.05, 0.02),
            }
            .rounded();
            let exact = signed_distance(&a.solid, &b.solid, &pose);
            for prediction in finite.into_iter().chain(not_finite) {
                let shapes = [a.shape.clone(), b.shape.clone()];
                let answers = soon(&format!("prediction {prediction}"), move || {
                    Answers::new(&pose.to_f32(), [&shapes[0], &shapes[1]], prediction)
                });
                if prediction.is_finite() {
                    let id = format!("{prediction:e} at {exact:e}");
                    report.add("any", &id, judge_within(&answers, prediction.into(), exact));
                }
            }
        }
    }
    report.conclude();
}

/// Finite, right when in reach, and silent when out of reach.
fn judge_within(answers: &Answers, prediction: f64, exact: f64) -> Finding {
    const TOLERANCE: f64 = 1.0e-5;
    let mut finding = Finding::default();
    finding.require(answers.are_finite(), || "not finite".to_owned());
    let contact = answers.contact.map(|contact| contact.dist);
    let deepest = answers.manifold.find_deepest_contact().map(|p| p.dist);
    if prediction >= 0.0 && exact < prediction - TOLERANCE {
        judge_dist(&mut finding, "contact error", contact, exact, TOLERANCE);
        judge_dist(&mut finding, "manifold error", deepest, exact, TOLERANCE);
    }
    if prediction >= 0.0 && exact > prediction + TOLERANCE {
        finding.require(contact.is_none(), || format!("out of reach: {contact:?}"));
    }
    finding
}

/// A hull scaled to another size.
fn scaled(hull: &Hull, scale: Real) -> Hull {
    let polyhedron = hull
        .shape
        .as_convex_polyhedron()
        .expect("a convex polyhedron");
    let shape = polyhedron
        .clone()
        .scaled(Vector::splat(scale))
        .expect("a scaled hull");
    let points = shape.points().iter().map(|p| p.as_dvec3());
    Hull {
        solid: hull.solid.with_points(points),
        shape: SharedShape::new(shape),
    }
}

/// A pebble of a millimetre on a rock of a kilometre: as exact as f32 places it.
#[test]
fn sizes_may_be_a_million_apart() {
    const ROUNDING: f64 = 1.0e3 * 1.0e-6;
    let mut report = Report::new("sizes a million apart");
    let mut rng = Rng::new(22);
    for turn in 0..40 {
        let rock = scaled(&rng.hull(60, 1.0), 1.0e3);
        let pebble = scaled(&rng.hull(30, 1.0), 1.0e-3);
        let up = rng.direction();
        let ground = rock.solid.support(up);
        for height in [-0.5, -1.0e-3, 0.0, 1.0e-3, 0.5, 100.0] {
            let pose = ExactPose {
                rotation: rng.rotation(),
                translation: up * (ground + height),
            }
            .rounded();
            let id = format!("rock {turn}, height {height}");
            report.add("rock, pebble", &id, judge(&rock, &pebble, pose, ROUNDING));
            let pose = pose.inverse().rounded();
            report.add("pebble, rock", &id, judge(&pebble, &rock, pose, ROUNDING));
        }
    }
    report.conclude();
}

/// Both bodies ten kilometres out: their relative pose is only as good as f32 makes it.
#[test]
fn bodies_may_be_ten_kilometres_from_the_origin() {
    const ROUNDING: f64 = 1.0e-5;
    let mut report = Report::new("ten kilometres from the origin");
    let mut rng = Rng::new(23);
    for turn in 0..100 {
        let [a, b] = [20, 80].map(|corners| rng.hull(corners, 1.0));
        let place1 = Pose::from_parts(rng.direction().as_vec3() * 1.0e4, rng.rotation().as_quat());
        let offset = (rng.direction() * rng.range(0.0, 1.5)).as_vec3();
        let place2 = Pose::from_parts(place1.translation + offset, rng.rotation().as_quat());
        let pose12 = place1.inv_mul(&place2);
        let pose = ExactPose {
            rotation: pose12.rotation.as_dquat(),
            translation: pose12.translation.as_dvec3(),
        }
        .rounded();
        let finding = judge(&a, &b, pose, ROUNDING);
        report.add("pair", &format!("turn {turn}"), finding);
    }
    report.conclude();
}

/// Ten kilometres apart, or built ten kilometres from their own origins.
#[test]
fn relative_translations_may_be_large() {
    const ROUNDING: f64 = 1.0e4 * 1.0e-6;
    let mut report = Report::new("large relative translations");
    let mut rng = Rng::new(24);
    for turn in 0..40 {
        let [a, b] = [20, 80].map(|corners| rng.hull(corners, 1.0));
        let apart = ExactPose {
            rotation: rng.rotation(),
            translation: rng.direction() * 1.0e4,
        };
        let finding = judge(&a, &b, apart.rounded(), ROUNDING);
        report.add("apart", &format!("turn {turn}"), finding);

        let shift = rng.direction() * 1.0e4;
        let far = moved(&b, shift);
        let turned = rng.rotation();
        let back = ExactPose {
            rotation: turned,
            translation: rng.direction() * rng.range(0.0, 1.5) - turned * shift,
        };
        let finding = judge(&a, &far, back.rounded(), ROUNDING);
        report.add("far from its origin", &format!("turn {turn}"), finding);
    }
    report.conclude();
}

/// A hull whose points are all `shift` away; they are rounded there, so it is a new solid.
fn moved(hull: &Hull, shift: DVec3) -> Hull {
    let points: Vec<Vector> = hull
        .solid
        .points
        .iter()
        .map(|p| (*p + shift).as_vec3())
        .collect();
    let shape = SharedShape::convex_mesh(points.clone(), hull.solid.faces());
    Hull {
        solid: hull.solid.with_points(points.iter().map(|p| p.as_dvec3())),
        shape: shape.expect("a closed surface"),
    }
}

#[test]
fn tetrahedra_are_answered_exactly() {
    let mut report = Report::new("tetrahedra");
    let mut rng = Rng::new(25);
    for turn in 0..300 {
        let [a, b] = [(); 2].map(|()| rng.hull(4, 1.0));
        let finding = judge(&a, &b, rng.pose(1.2), 1.0e-5);
        report.add("pair", &format!("turn {turn}"), finding);
    }
    report.conclude();
}

/// A millionth as thick as wide.
#[test]
fn almost_flat_tetrahedra_are_answered_exactly() {
    let mut report = Report::new("almost flat tetrahedra");
    let mut rng = Rng::new(26);
    for thickness in [1.0e-3, 1.0e-5, 1.0e-6] {
        let flat = tetrahedron(thickness);
        let other = rng.hull(30, 1.0);
        for turn in 0..50 {
            for [a, b] in [[&flat, &other], [&other, &flat], [&flat, &flat]] {
                let finding = judge(a, b, rng.pose(1.0), 2.0e-5);
                let route = format!("thickness {thickness}");
                report.add(&route, &format!("turn {turn}"), finding);
            }
        }
    }
    report.conclude();
}

/// A triangle with an apex barely above it.
fn tetrahedron(height: Real) -> Hull {
    let points = vec![
        Vector::new(-1.0, -1.0, 0.0),
        Vector::new(1.0, -1.0, 0.0),
        Vector::new(0.0, 1.0, 0.0),
        Vector::new(0.0, 0.0, height),
    ];
    let faces = [[2, 1, 0], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    Hull {
        solid: Solid::new(points.iter().map(|p| p.as_dvec3()).collect(), &faces),
        shape: SharedShape::convex_mesh(points, &faces).expect("a closed surface"),
    }
}

/// Parry's routines for cells panic or overflow when they meet a shape without end.
#[test]
fn half_spaces_and_cells_do_not_panic() {
    let samples = shape_samples();
    let shape = |name| {
        let sample = samples.iter().find(|sample| sample.name == name);
        &*sample.expect("a sample").shape.0
    };
    let dispatcher = IsaGjkDispatcher::default();
    let half_space = shape("half-space");
    for cells in [shape("voxels"), shape("heightfield")] {
        for pose in poses() {
            for [a, b] in [[cells, half_space], [half_space, cells]] {
                let way = -pose.translation;
                let cast = dispatcher.cast_shapes(&pose, way, a, b, ShapeCastOptions::default());
                assert!(cast.is_ok(), "{cast:?}");
                let mut manifolds: Vec<Manifold> = Vec::new();
                let _ = dispatcher.update_manifolds(&pose, [a, b], 0.1, &mut manifolds, &mut None);
            }
        }
    }
}

/// Parry's own routine asserts that the margin is not negative.
#[test]
fn no_margin_of_nearest_points_panics() {
    let dispatcher = IsaGjkDispatcher::default();
    let samples = shape_samples();
    for [a, b] in samples
        .iter()
        .flat_map(|a| samples.iter().map(move |b| [a, b]))
    {
        let pose = Pose::translation(9.0, 0.0, 0.0);
        for margin in [-1.0, -0.0, Real::NEG_INFINITY, Real::NAN] {
            let found = dispatcher.closest_points(&pose, &*a.shape, &*b.shape, margin);
            let is_near = matches!(found, Ok(ClosestPoints::WithinMargin(..)));
            let may_be_near = margin.is_nan();
            assert!(
                may_be_near || !is_near,
                "{} and {} within {margin}",
                a.name,
                b.name
            );
        }
    }
}
