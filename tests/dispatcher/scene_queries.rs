//! Scene queries about hulls, alone and as parts of other shapes.
//!
//! Sensors, shape casts and character controllers ask the dispatcher about pairs without memory. Hulls are
//! measured against the exact answers; shapes with parts must be answered as their nearest part is, in either
//! order of the shapes.

use glam::{DQuat, DVec3};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    ClosestPoints, DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher, ShapeCastHit,
    ShapeCastOptions,
};
use parry3d::shape::{Shape, SharedShape, Triangle};
use testkit::cases::{Hull, hulls};
use testkit::generate::{Rng, prepared};
use testkit::oracle::{Solid, signed_distance};
use testkit::pose::ExactPose;
use testkit::report::{Finding, Report};
use testkit::shape_samples::shape_samples;

/// Relative to the size of the pair.
const TOLERANCE: f64 = 1.0e-5;

fn dispatcher() -> IsaGjkDispatcher {
    IsaGjkDispatcher::default()
}

/// A body of several hulls, and where they are in it.
struct Body {
    shape: SharedShape,
    parts: Vec<(ExactPose, Hull)>,
}

impl Body {
    fn new(rng: &mut Rng) -> Self {
        let parts: Vec<(ExactPose, Hull)> =
            (0..3).map(|_| (rng.pose(0.8), rng.hull(24, 0.7))).collect();
        let shapes = parts
            .iter()
            .map(|(pose, hull)| (pose.to_f32(), hull.shape.clone()));
        Self {
            shape: SharedShape::compound(shapes.collect()),
            parts,
        }
    }

    fn signed_distance(&self, other: &Solid, pose: &ExactPose) -> f64 {
        let distances = self.parts.iter().map(|(place, hull)| {
            let back = place.inverse();
            let relative = ExactPose {
                rotation: back.rotation * pose.rotation,
                translation: back.apply(pose.translation),
            };
            signed_distance(&hull.solid, other, &relative)
        });
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// Judges all queries without motion about two shapes that are `exact` apart.
fn judge(shapes: [&SharedShape; 2], pose: &ExactPose, exact: f64) -> Finding {
    let mut finding = Finding::default();
    let (g1, g2) = (&**shapes[0], &**shapes[1]);
    let (pos12, us) = (pose.to_f32(), dispatcher());
    let distance = us.distance(&pos12, g1, g2).expect("supported").distance;
    let error = f64::from(distance) - exact.max(0.0);
    finding.at_most("distance", error.abs(), TOLERANCE);
    let contact = us.contact(&pos12, g1, g2, 10.0).expect("supported");
    let dist = contact.map_or(f64::NAN, |contact| contact.dist.into());
    finding.at_most("contact", (dist - exact).abs(), TOLERANCE);
    if exact.abs() > TOLERANCE {
        let test = us.intersection_test(&pos12, g1, g2).expect("supported");
        let right = test.intersecting == (exact < 0.0);
        finding.require(right, || format!("intersecting at {exact:e}"));
        let points = us.closest_points(&pos12, g1, g2, 10.0).expect("supported");
        match points {
            ClosestPoints::WithinMargin(p1, p2) => {
                let apart = (pos12 * p2).distance(p1);
                finding.at_most("points", (f64::from(apart) - exact).abs(), TOLERANCE);
            }
            ClosestPoints::Intersecting => finding.require(exact < 0.0, || format!("{exact:e}")),
            ClosestPoints::Disjoint => finding.require(false, || "disjoint".to_owned()),
        }
    }
    finding
}

#[test]
fn a_compound_is_as_near_as_its_nearest_hull() {
    let mut report = Report::new("compounds of hulls");
    let mut rng = Rng::new(41);
    for turn in 0..60 {
        let (body, hull) = (Body::new(&mut rng), rng.hull(40, 0.8));
        let prepared = prepared(&hull.shape);
        for _ in 0..4 {
            let pose = rng.pose(1.6);
            let exact = body.signed_distance(&hull.solid, &pose);
            let back = pose.inverse().rounded();
            let exact_back = body.signed_distance(&hull.solid, &back.inverse());
            let id = format!("body {turn}");
            let body = &body.shape;
            report.add("hull", &id, judge([body, &hull.shape], &pose, exact));
            report.add("hull shape", &id, judge([body, &prepared], &pose, exact));
            report.add(
                "swapped",
                &id,
                judge([&hull.shape, body], &back, exact_back),
            );
        }
    }
    report.conclude();
}

/// At a maximum distance of zero, too.
#[test]
fn what_overlaps_a_compound_intersects_it_for_nearest_points() {
    let parts = [-1.0, 1.0].map(|x| (Pose::translation(x, 0.0, 0.0), cube()));
    let pair = SharedShape::compound(parts.to_vec());
    for max_distance in [-1.0, 0.0, 0.1] {
        for (x, expected) in [(1.25, true), (3.0, false)] {
            let pose = Pose::translation(x, 0.0, 0.0);
            for (pose, shapes) in [(pose, [&pair, &cube()]), (pose.inverse(), [&cube(), &pair])] {
                let found =
                    dispatcher().closest_points(&pose, &**shapes[0], &**shapes[1], max_distance);
                let meets = found == Ok(ClosestPoints::Intersecting);
                assert_eq!(meets, expected, "{x} up to {max_distance}: {found:?}");
            }
        }
    }
}

/// The triangles of a mesh or height field.
fn triangles(shape: &dyn Shape) -> Vec<Triangle> {
    match (shape.as_trimesh(), shape.as_heightfield()) {
        (Some(mesh), _) => mesh.triangles().collect(),
        (_, Some(field)) => field.triangles().collect(),
        _ => Vec::new(),
    }
}

#[test]
fn a_mesh_is_met_as_its_triangles_are() {
    let us = dispatcher();
    let mut rng = Rng::new(42);
    let mut hits = 0;
    for sample in shape_samples() {
        let ground = &*sample.shape;
        let triangles = triangles(ground);
        let first = |times: &mut dyn Iterator<Item = Option<Real>>| {
            times.flatten().fold(Real::INFINITY, Real::min)
        };
        for _ in 0..60 * usize::from(!triangles.is_empty()) {
            let hull = rng.hull(20, 0.5).shape;
            let pose = rng.pose(1.0).to_f32();
            let deepest = |shape: &dyn Shape| {
                let contact = us.contact(&pose, shape, &*hull, 0.1).expect("supported");
                contact.map(|contact| contact.dist)
            };
            let whole = deepest(ground).unwrap_or(Real::INFINITY);
            let parts = first(&mut triangles.iter().map(|t| deepest(t)));
            assert_eq!(whole, parts, "contact with the {}", sample.name);

            let start = Pose::from_parts(pose.translation + Vector::Y * 3.0, pose.rotation);
            let options = ShapeCastOptions::default();
            let cast = |shape: &dyn Shape| {
                let hit = us.cast_shapes(&start, -Vector::Y, shape, &*hull, options);
                hit.expect("supported").map(|hit| hit.time_of_impact)
            };
            let whole = cast(ground).unwrap_or(Real::INFINITY);
            let parts = first(&mut triangles.iter().map(|t| cast(t)));
            assert_eq!(whole, parts, "cast at the {}", sample.name);
            hits += usize::from(whole.is_finite());
        }
    }
    assert!(hits > 60, "only {hits} casts hit");
}

/// A hull that flies past or into another one.
struct Flight<'a> {
    hulls: [&'a Hull; 2],
    pose: ExactPose,
    velocity: Vector,
    target: Real,
}

impl Flight<'_> {
    fn cast(&self) -> Option<ShapeCastHit> {
        let [a, b] = self.hulls.map(|hull| &*hull.shape);
        let options = ShapeCastOptions {
            target_distance: self.target,
            max_time_of_impact: 5.0,
            ..ShapeCastOptions::default()
        };
        let hit = dispatcher().cast_shapes(&self.pose.to_f32(), self.velocity, a, b, options);
        hit.expect("supported")
    }

    fn pose_at(&self, time: f64) -> ExactPose {
        ExactPose {
            translation: self.pose.translation + self.velocity.as_dvec3() * time,
            ..self.pose
        }
    }

    fn distance_at(&self, time: f64) -> f64 {
        let [a, b] = self.hulls.map(|hull| &hull.solid);
        signed_distance(a, b, &self.pose_at(time))
    }

    /// The least distance up to the maximum time; it is a convex function of time.
    fn least_distance(&self) -> f64 {
        let (mut low, mut high) = (0.0, 5.0);
        for _ in 0..60 {
            let [a, b] = [1.0, 2.0].map(|third| low + (high - low) * third / 3.0);
            if self.distance_at(a) < self.distance_at(b) {
                high = b;
            } else {
                low = a;
            }
        }
        self.distance_at(low)
    }

    fn judge(&self) -> Finding {
        let mut finding = Finding::default();
        let target = f64::from(self.target);
        let Some(hit) = self.cast() else {
            let least = self.least_distance();
            finding.require(least > target - TOLERANCE, || {
                format!("missed at {least:e}")
            });
            return finding;
        };
        // f32 rounds the time, hence the way.
        let time = f64::from(hit.time_of_impact);
        let error = self.distance_at(time) - target;
        let begins_near = time == 0.0 && error < 0.0;
        finding.require(begins_near || error.abs() < TOLERANCE, || {
            format!("{error:e}")
        });
        if time > 0.0 {
            finding.at_most("distance at impact", error.abs(), TOLERANCE);
            let [w1, w2] = [hit.witness1, hit.witness2].map(|w| w.as_dvec3());
            let [a, b] = self.hulls.map(|hull| &hull.solid);
            finding.at_most("witness 1", a.outside(w1).abs(), TOLERANCE);
            finding.at_most("witness 2", b.outside(w2).abs(), TOLERANCE);
            let gap = self.pose_at(time).apply(w2) - w1;
            let along = gap - hit.normal1.as_dvec3() * target;
            finding.at_most("gap", along.length(), TOLERANCE);
            let opposite = self.pose.rotation * hit.normal2.as_dvec3() + hit.normal1.as_dvec3();
            finding.at_most("normals", opposite.length(), TOLERANCE);
        }
        finding
    }
}

#[test]
fn a_cast_ends_where_the_solids_meet() {
    let mut report = Report::new("shape casts");
    let mut rng = Rng::new(43);
    for turn in 0..400 {
        let [a, b] = [8, 40].map(|corners| rng.hull(corners, 1.0));
        let pose = rng.pose(3.0);
        let aim = -pose.translation.normalize_or(DVec3::X) + 0.3 * rng.direction();
        let flight = Flight {
            hulls: [&a, &b],
            pose,
            velocity: (aim * rng.range(0.5, 3.0)).as_vec3(),
            target: [0.0, 0.1][turn % 2],
        };
        let route = if flight.cast().is_some() {
            "hit"
        } else {
            "miss"
        };
        report.add(route, &format!("flight {turn}"), flight.judge());
    }
    report.conclude();
}

fn cube() -> SharedShape {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
        Vector::new(side(0), side(1), side(2))
    };
    SharedShape::convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).expect("a cube")
}

/// What the options say, on cubes above each other: parry's cuboids are the model.
#[test]
fn casts_honour_their_options_as_parry_does() {
    let (hull, cuboid) = (cube(), SharedShape::cuboid(0.5, 0.5, 0.5));
    let down = Vector::new(0.0, -1.0, 0.0);
    let directions = [down, -down, Vector::X, Vector::ZERO, down + Vector::X * 0.1];
    let heights = [0.75, 1.0, 1.125, 1.5, 3.0];
    let limits = [-1.0, 0.0, 0.25, 10.0];
    let mut hits = 0;
    for (height, velocity) in heights.iter().flat_map(|h| directions.map(|v| (*h, v))) {
        for (target, limit) in [0.0, 0.25].into_iter().flat_map(|t| limits.map(|l| (t, l))) {
            for stop in [true, false] {
                let options = ShapeCastOptions {
                    max_time_of_impact: limit,
                    target_distance: target,
                    stop_at_penetration: stop,
                    compute_impact_geometry_on_penetration: true,
                };
                let pose = Pose::translation(0.0, height, 0.0);
                let cast = |d: &dyn QueryDispatcher, shape: &SharedShape| {
                    let hit = d.cast_shapes(&pose, velocity, &**shape, &**shape, options);
                    hit.expect("supported")
                };
                let ours = cast(&dispatcher(), &hull);
                let theirs = cast(&DefaultQueryDispatcher, &cuboid);
                let what = format!("{height}, {velocity}, {options:?}: {ours:?}, {theirs:?}");
                // Moving along a face that is exactly touched is a hit or not.
                let tangential = velocity == Vector::X && height - 1.0 <= target;
                assert!(ours.is_some() == theirs.is_some() || tangential, "{what}");
                if let (Some(ours), Some(theirs)) = (ours, theirs) {
                    hits += 1;
                    let late = ours.time_of_impact - theirs.time_of_impact;
                    assert!(late.abs() < 1.0e-4, "{what}");
                    assert_eq!(ours.status, theirs.status, "{what}");
                    assert!(ours.normal1.distance(theirs.normal1) < 1.0e-3, "{what}");
                }
            }
        }
    }
    assert!(hits > 50, "only {hits} hits");
}

#[test]
fn rounded_borders_are_met_first() {
    let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let round = SharedShape::round_convex_hull(&corners, 0.25).expect("a solid");
    let pose = Pose::translation(-0.2, -0.2, 4.0);
    let (velocity, options) = (-Vector::Z, ShapeCastOptions::default());
    let hit = dispatcher().cast_shapes(&pose, velocity, &*round, &*round, options);
    let hit = hit.expect("supported").expect("a hit");
    // The upper one's flat bottom meets the lower one's tip.
    assert!((hit.time_of_impact - 2.5).abs() < 1.0e-5, "{hit:?}");
    assert!((hit.normal1 - Vector::Z).length() < 1.0e-5, "{hit:?}");
    assert!(
        (hit.witness1 - Vector::Z * 1.25).length() < 1.0e-5,
        "{hit:?}"
    );
    assert!((hit.witness2.z + 0.25).abs() < 1.0e-5, "{hit:?}");
}

/// Where faces overlap the points are one over the other, and on both shapes.
#[test]
fn witnesses_of_deep_overlaps_face_each_other() {
    let mut rng = Rng::new(9);
    let mut report = Report::new("witnesses of overlapping faces");
    for name in ["box_unit", "prism16", "prism64_coin"] {
        let Hull { solid, shape } = &hulls()[name];
        let extents = shape.compute_local_aabb().extents().as_dvec3();
        for _ in 0..300 {
            let turn = DVec3::AXES[rng.count(0, 2)] * rng.range(0.0, 6.0);
            let aside = [(); 3].map(|()| rng.range(-0.6, 0.6));
            let pose = ExactPose {
                rotation: DQuat::from_scaled_axis(turn),
                translation: DVec3::from(aside) * extents,
            };
            let pose = pose.rounded();
            let contact = dispatcher().contact(&pose.to_f32(), &**shape, &**shape, 0.0);
            let Some(contact) = contact.expect("supported") else {
                continue;
            };
            let on_2 = pose.apply(contact.point2.as_dvec3());
            let between = on_2 - contact.point1.as_dvec3();
            let along = contact.normal1.as_dvec3() * f64::from(contact.dist);
            let size = solid.diameter();
            let mut finding = Finding::default();
            finding.at_most("aside", (between - along).length() / size, TOLERANCE);
            for point in [contact.point1, contact.point2] {
                let off = solid.outside(point.as_dvec3()).abs() / size;
                finding.at_most("off the surface", off, TOLERANCE);
            }
            report.add(name, "", finding);
        }
    }
    report.conclude();
}

/// A vertex beside the rim of a box without thickness, in its plane.
#[test]
fn a_flat_box_ends_where_its_rim_is() {
    let corners = [
        Vector::ZERO,
        Vector::new(1.0, -0.1, -0.1),
        Vector::new(1.0, 0.1, -0.1),
        Vector::new(1.0, 0.0, 0.2),
    ];
    let tip = SharedShape::convex_hull(&corners).expect("a solid");
    let mut rng = Rng::new(10);
    for _ in 0..2000 {
        let [x, z] = [(); 2].map(|()| rng.range(0.1, 2.0) as Real);
        let plate = SharedShape::cuboid(x, 0.0, z);
        let [beside, beyond] = [(); 2].map(|()| rng.range(0.0, 0.3) as Real);
        let pose = Pose::translation(x + beside, 0.0, z + beyond);
        let distance = dispatcher().distance(&pose, &*plate, &*tip);
        let distance = distance.expect("supported").distance;
        let reach = distance + rng.range(0.01, 0.5) as Real;
        let contact = dispatcher().contact(&pose, &*plate, &*tip, reach);
        let contact = contact.expect("supported").expect("near").dist;
        assert!(
            (contact - distance).abs() < 1e-6,
            "{contact}, not {distance}"
        );
    }
}

/// The hull inside of a rounded one may be at the same address, and has no border.
#[test]
fn a_hull_is_not_its_rounded_self() {
    let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let round = SharedShape::round_convex_hull(&corners, 0.25).expect("a solid");
    let round = round.as_round_convex_polyhedron().expect("rounded");
    let pose = Pose::translation(0.0, 0.0, 2.0);
    let between = |a: &dyn Shape, b: &dyn Shape| {
        let answer = dispatcher().distance(&pose, a, b);
        f64::from(answer.expect("supported").distance)
    };
    let hull = &round.inner_shape;
    for (a, b, borders) in [
        (hull as &dyn Shape, hull as &dyn Shape, 0.0),
        (hull, round, 1.0),
        (round, hull, 1.0),
        (round, round, 2.0),
    ] {
        let error = between(a, b) - (1.0 - borders * 0.25);
        assert!(error.abs() < TOLERANCE, "{borders} borders: off by {error}");
    }
}

/// A motion whose numbers are no numbers meets nothing, and no assertion.
#[test]
fn impossible_casts_meet_nothing() {
    let hull = cube();
    let options = ShapeCastOptions::default();
    for bad in [Real::NAN, Real::INFINITY] {
        let far = Pose::translation(bad, 0.0, 3.0);
        let near = Pose::translation(0.0, 0.0, 3.0);
        for (pose, velocity) in [(far, -Vector::Z), (near, Vector::new(0.0, bad, -1.0))] {
            let hit = dispatcher().cast_shapes(&pose, velocity, &*hull, &*hull, options);
            assert!(hit.expect("supported").is_none(), "{pose:?} {velocity}");
        }
    }
}

/// A spinning hull falls on another: at the time of impact they touch, and before they do not, up to the
/// tolerance of parry's search, which calls our distance query in every step.
#[test]
fn spinning_casts_end_in_touch() {
    let mut rng = Rng::new(44);
    let mut hits = 0;
    for turn in 0..100 {
        let [a, b] = [12, 40].map(|corners| rng.hull(corners, 1.0));
        let start = ExactPose {
            rotation: DQuat::IDENTITY,
            translation: rng.direction() * 2.5,
        };
        let velocity = -start.translation.as_vec3();
        let spin = (rng.direction() * 4.0).as_vec3();
        let still = NonlinearRigidMotion::identity();
        let motion = NonlinearRigidMotion::new(start.to_f32(), Vector::ZERO, velocity, spin);
        let (g1, g2) = (&*a.shape, &*b.shape);
        let hit = dispatcher().cast_shapes_nonlinear(&still, g1, &motion, g2, 0.0, 1.0, true);
        let Some(hit) = hit.expect("supported") else {
            continue;
        };
        hits += 1;
        let distance = |time: Real| {
            let pose = motion.position_at_time(time);
            let pose = ExactPose {
                rotation: pose.rotation.as_dquat().normalize(),
                translation: pose.translation.as_dvec3(),
            };
            signed_distance(&a.solid, &b.solid, &pose)
        };
        let at_impact = distance(hit.time_of_impact);
        assert!(at_impact.abs() < 5.0e-4, "turn {turn}: {at_impact:e}");
        for step in 0..20 {
            let before = distance(hit.time_of_impact * step as Real / 20.0);
            assert!(before > -5.0e-4, "turn {turn}, step {step}: {before:e}");
        }
    }
    assert!(hits > 60, "only {hits} hits");
}
