//! Shapes that touch exactly: at a corner, along an edge, over a face, in any combination. All queries
//! give one answer there, and one each just above and just below. Grids of crates and levels of blocks
//! have such poses all the time.
//!
//! All coordinates are small whole numbers times a power of two, so that touching is exact in f32.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DQuat, DVec3};
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{ClosestPoints, Contact, QueryDispatcher, ShapeCastOptions};
use parry3d::shape::{Shape, SharedShape};
use testkit::generate::{Rng, hull_of};
use testkit::memory::Memory;
use testkit::oracle::Solid;
use testkit::report::{Finding, Report};

/// Relative to the sizes of both shapes together.
const ACCURACY: f64 = 1e-6;
/// The f32 rounding of points, relative to the larger coordinates.
const SINGLE: f64 = 4e-7;
/// The same for points that are clipped in f32 over nearly parallel sides.
const CLIPPED: f64 = 4e-6;
/// The step from touching to apart or overlapping: a share of the way to the middle.
const STEP: f64 = 1.0 / (1 << 18) as f64;

/// The corners of solids.
const SOLIDS: [&[[i8; 3]]; 6] = [
    &[
        [-2, -2, -2],
        [2, -2, -2],
        [-2, 2, -2],
        [2, 2, -2],
        [-2, -2, 2],
        [2, -2, 2],
        [-2, 2, 2],
        [2, 2, 2],
    ],
    &[
        [-4, -4, -1],
        [4, -4, -1],
        [-4, 4, -1],
        [4, 4, -1],
        [-4, -4, 1],
        [4, -4, 1],
        [-4, 4, 1],
        [4, 4, 1],
    ],
    &[
        [-2, 0, 0],
        [2, 0, 0],
        [0, -2, 0],
        [0, 2, 0],
        [0, 0, -2],
        [0, 0, 2],
    ],
    &[[-2, -2, -2], [2, 2, -2], [2, -2, 2], [-2, 2, 2]],
    &[
        [-4, 0, 0],
        [4, 0, 0],
        [-4, 2, 1],
        [4, 2, 1],
        [-4, 2, -1],
        [4, 2, -1],
    ],
    &[
        [-2, -4, 0],
        [-2, 4, 0],
        [2, -4, 0],
        [2, 4, 0],
        [-1, -4, 2],
        [-1, 4, 2],
        [1, -4, 2],
        [1, 4, 2],
        [-1, -4, -2],
        [-1, 4, -2],
        [1, -4, -2],
        [1, 4, -2],
    ],
];
/// Those of triangles.
const TRIANGLES: [&[[i8; 3]]; 3] = [
    &[[-2, 0, -2], [2, 0, -2], [0, 0, 4]],
    &[[-4, 0, 0], [4, 0, 0], [0, 1, 1]],
    &[[0, 0, 0], [2, 1, 0], [0, 2, 1]],
];

#[derive(Clone, Copy)]
enum Kind {
    Hull,
    HullShape,
    RoundHull,
    Cuboid,
    RoundCuboid,
    Triangle,
    Segment,
    Capsule,
    Ball,
}

/// A shape and its corners.
struct Body {
    shape: SharedShape,
    /// Those of the core within a rounded border.
    corners: Vec<DVec3>,
    border: f64,
    surface: Solid,
}

fn body(rng: &mut Rng, kinds: [Kind; 2]) -> Body {
    let scale = 2.0_f64.powi([-16, -3, 0, 0, 0, 8][rng.count(0, 5)]);
    let kind = kinds[rng.count(0, 1)];
    let is_around_origin = matches!(kind, Kind::Cuboid | Kind::RoundCuboid | Kind::Ball);
    let offset = if is_around_origin {
        0.0
    } else {
        [0.0, 256.0][rng.count(0, 1)]
    };
    let offset = (rng.direction() * offset).round();
    let place = |corner: &[i8; 3]| (DVec3::from(corner.map(f64::from)) + offset) * scale;
    let corners: Vec<DVec3> = match kind {
        Kind::Hull | Kind::HullShape | Kind::RoundHull => SOLIDS[rng.count(0, 5)],
        Kind::Cuboid | Kind::RoundCuboid => SOLIDS[rng.count(0, 1)],
        Kind::Triangle => TRIANGLES[rng.count(0, 2)],
        Kind::Segment | Kind::Capsule => &TRIANGLES[rng.count(0, 2)][1..],
        Kind::Ball => &[[0; 3]],
    }
    .iter()
    .map(place)
    .collect();
    let points: Vec<Vector> = corners.iter().map(|p| p.as_vec3()).collect();
    let has_border = matches!(
        kind,
        Kind::RoundHull | Kind::RoundCuboid | Kind::Capsule | Kind::Ball
    );
    let border = if has_border {
        scale * [0.25, 1.0, 8.0][rng.count(0, 2)]
    } else {
        0.0
    };
    let radius = border as Real;
    let last = *points.last().expect("there are some");
    let shape = match kind {
        Kind::Hull => hull_of(&points).expect("all are corners").shape,
        Kind::HullShape => SharedShape::new(HullShape::from_points(&points).expect("a solid")),
        Kind::RoundHull => SharedShape::round_convex_hull(&points, radius).expect("a solid"),
        Kind::Cuboid => SharedShape::cuboid(last.x, last.y, last.z),
        Kind::RoundCuboid => SharedShape::round_cuboid(last.x, last.y, last.z, radius),
        Kind::Triangle => SharedShape::triangle(points[0], points[1], last),
        Kind::Segment => SharedShape::segment(points[0], last),
        Kind::Capsule => SharedShape::capsule(points[0], last, radius),
        Kind::Ball => SharedShape::ball(radius),
    };
    let surface = match corners.len() {
        1 => Solid::new(corners.clone(), &[[0; 3]]),
        2 => Solid::new(corners.clone(), &[[0, 1, 1]]),
        3 => Solid::new(corners.clone(), &[[0, 1, 2]]),
        _ => hull_of(&points).expect("all are corners").solid,
    };
    Body {
        shape,
        corners,
        border,
        surface,
    }
}

impl Body {
    fn middle(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / self.corners.len() as f64
    }

    fn size(&self) -> f64 {
        let middle = self.middle();
        let farthest = self
            .corners
            .iter()
            .map(|p| p.distance(middle))
            .fold(0.0, f64::max);
        farthest + self.border
    }

    /// How far a point is from the surface.
    fn off(&self, point: DVec3) -> f64 {
        // Within a core that is deep inside there is another way to the surface.
        (self.surface.distance_to_surface(point) - self.border).abs()
    }

    /// Of the corners that are extreme along a direction one, or the middle of two.
    fn extreme(&self, along: DVec3, rng: &mut Rng) -> DVec3 {
        let most = self
            .corners
            .iter()
            .map(|p| p.dot(along))
            .fold(f64::NEG_INFINITY, f64::max);
        let extreme: Vec<DVec3> = self
            .corners
            .iter()
            .copied()
            .filter(|p| p.dot(along) == most)
            .collect();
        let mut any = || extreme[rng.count(0, extreme.len() - 1)];
        if any() == any() {
            any()
        } else {
            0.5 * (any() + any())
        }
    }

    fn support(&self, along: DVec3) -> f64 {
        self.corners
            .iter()
            .map(|p| p.dot(along))
            .fold(f64::NEG_INFINITY, f64::max)
    }
}

/// The turns that take axes to axes.
fn quarter_turns(rng: &mut Rng) -> DQuat {
    let axis = [DVec3::X, DVec3::Y, DVec3::Z][rng.count(0, 2)];
    match rng.count(0, 3) {
        0 | 1 => DQuat::IDENTITY,
        2 => DQuat::from_vec4(axis.extend(0.0)),
        _ => DQuat::from_vec4((axis * FRAC_1_SQRT_2).extend(FRAC_1_SQRT_2)),
    }
}

/// Two bodies at a place of the second.
struct Scene<'a> {
    bodies: [&'a Body; 2],
    rotation: DQuat,
    translation: DVec3,
}

impl Scene<'_> {
    fn pose(&self) -> Pose {
        Pose::from_parts(self.translation.as_vec3(), self.rotation.as_quat())
    }

    fn shapes(&self) -> [&dyn Shape; 2] {
        self.bodies.map(|body| &*body.shape)
    }

    fn size(&self) -> f64 {
        self.bodies[0].size() + self.bodies[1].size()
    }

    fn separation(&self, normal: DVec3) -> f64 {
        let [a, b] = self.bodies;
        let turned = self.rotation.inverse() * normal;
        normal.dot(self.translation) - b.support(-turned) - a.support(normal) - a.border - b.border
    }

    fn contact(&self, prediction: f64) -> Option<Contact> {
        let [a, b] = self.shapes();
        IsaGjkDispatcher::default()
            .contact(&self.pose(), a, b, prediction as Real)
            .expect("supported")
    }

    fn manifold(&self, prediction: f64) -> Vec<Contact> {
        let shapes = self.bodies.map(|body| &body.shape);
        let mut memory = Memory::default();
        let us = IsaGjkDispatcher::default();
        memory.update(&us, &self.pose(), shapes, prediction as Real);
        memory.update(&us, &self.pose(), shapes, prediction as Real);
        let manifold = &memory.manifolds[0];
        let contact = |p: &parry3d::query::TrackedContact<u32>| {
            Contact::new(
                p.local_p1,
                p.local_p2,
                manifold.local_n1,
                manifold.local_n2,
                p.dist,
            )
        };
        manifold.points.iter().map(contact).collect()
    }

    /// A contact whose distance is between these: its points are on their surfaces, and the normal is
    /// right.
    fn judge(
        &self,
        finding: &mut Finding,
        contact: &Contact,
        rounding: f64,
        [low, high]: [f64; 2],
    ) {
        let [a, b] = self.bodies;
        let smaller = a.size().min(b.size());
        let limit = ACCURACY * self.size();
        let coordinates = a.middle().length() + b.middle().length() + self.size();
        let of_points = ACCURACY * smaller + rounding * coordinates;
        let (p1, p2) = (contact.point1.as_dvec3(), contact.point2.as_dvec3());
        let (normal, dist) = (contact.normal1.as_dvec3(), f64::from(contact.dist));
        let sideways = self.rotation * p2 + self.translation - p1 - normal * dist;
        finding.at_most("point1", a.off(p1) / of_points, 1.0);
        finding.at_most("point2", b.off(p2) / of_points, 1.0);
        finding.at_most("sideways", sideways.length() / of_points, 1.0);
        finding.at_most("below", (low - dist) / limit, 1.0);
        finding.at_most(
            "above",
            if high.is_finite() {
                (dist - high) / limit
            } else {
                0.0
            },
            1.0,
        );
        // The others of a manifold may be farther apart.
        if high.is_finite() {
            finding.at_most("regret", (dist - self.separation(normal)) / limit, 1.0);
        }
    }

    /// All answers, of which it is known whether the shapes meet, and that their distance is between `range`.
    fn check(&self, meet: bool, range: [f64; 2]) -> Finding {
        let mut finding = Finding::default();
        let us = IsaGjkDispatcher::default();
        let [a, b] = self.shapes();
        let far = 0.1 * self.size();
        let intersecting = us
            .intersection_test(&self.pose(), a, b)
            .expect("supported")
            .intersecting;
        finding.require(intersecting == meet, || {
            format!("intersection {intersecting}")
        });
        let distance = f64::from(us.distance(&self.pose(), a, b).expect("supported").distance);
        finding.require((distance == 0.0) == meet, || {
            format!("distance {distance:e}")
        });
        finding.at_most(
            "distance",
            (distance - range[1].max(0.0)) / (ACCURACY * self.size()),
            1.0,
        );
        for within in [0.0, far] {
            let closest = us
                .closest_points(&self.pose(), a, b, within as Real)
                .expect("supported");
            let is_right = match closest {
                ClosestPoints::Intersecting => meet,
                ClosestPoints::WithinMargin(..) => !meet && within > 0.0,
                ClosestPoints::Disjoint => !meet && within == 0.0,
            };
            finding.require(is_right, || format!("{closest:?} within {within}"));
            let is_near = meet || within > 0.0;
            match self.contact(within) {
                Some(contact) => {
                    finding.require(is_near, || format!("contact within {within}"));
                    self.judge(&mut finding, &contact, SINGLE, range);
                }
                None => finding.require(!is_near, || format!("no contact within {within}")),
            }
            let points = self.manifold(within);
            finding.require(is_near != points.is_empty(), || {
                format!("{} points within {within}", points.len())
            });
            if let Some(deepest) = points.iter().min_by(|a, b| a.dist.total_cmp(&b.dist)) {
                self.judge(&mut finding, deepest, CLIPPED, range);
            }
            // The others are on the true surfaces only if these are flat.
            let is_round = self.bodies.iter().any(|body| body.border > 0.0);
            for point in points.iter().filter(|_| !is_round) {
                self.judge(&mut finding, point, CLIPPED, [range[0], f64::INFINITY]);
            }
        }
        finding
    }
}

impl Scene<'_> {
    /// What touches from the beginning has met at time 0, unless it moves apart and may.
    fn check_casts(&self, finding: &mut Finding, inwards: DVec3) {
        for (way, stop_at_penetration, meets) in [
            (1.0, false, true),
            (1.0, true, true),
            (-1.0, false, false),
            (-1.0, true, true),
        ] {
            let options = ShapeCastOptions {
                stop_at_penetration,
                ..ShapeCastOptions::default()
            };
            let [a, b] = self.shapes();
            let velocity = (inwards * way).as_vec3();
            let hit = IsaGjkDispatcher::default()
                .cast_shapes(&self.pose(), velocity, a, b, options)
                .expect("supported");
            let time = hit.map(|hit| hit.time_of_impact);
            finding.require(time == meets.then_some(0.0), || {
                format!("cast {way}, {stop_at_penetration}: {time:?}")
            });
            if let Some(hit) = hit {
                let contact =
                    Contact::new(hit.witness1, hit.witness2, hit.normal1, hit.normal2, 0.0);
                self.judge(finding, &contact, SINGLE, [0.0, 0.0]);
            }
        }
    }
}

/// A few directions along which features of solids are extreme; with rounded borders only those along
/// which a length is exact.
fn direction(rng: &mut Rng, is_rounded: bool) -> DVec3 {
    loop {
        let direction = DVec3::from([(); 3].map(|()| rng.count(0, 4) as f64 - 2.0));
        let is_along_axis = direction.length() == direction.element_sum().abs();
        if direction != DVec3::ZERO && (is_along_axis || !is_rounded) {
            return direction;
        }
    }
}

const HULLS: [Kind; 2] = [Kind::Hull, Kind::HullShape];

/// Kinds of the second shape, and how many pairs of each.
const OTHERS: [[Kind; 2]; 5] = [
    HULLS,
    [Kind::Cuboid, Kind::Triangle],
    [Kind::Segment, Kind::Capsule],
    [Kind::Ball, Kind::RoundHull],
    [Kind::RoundCuboid, Kind::RoundHull],
];

/// Whether the shapes touch, and by which step.
const STEPS: [(&str, f64); 3] = [("at", 0.0), ("above", STEP), ("below", -STEP)];

#[test]
fn all_queries_agree_at_above_and_below_touching() {
    let mut rng = Rng::new(17);
    let mut report = Report::new("exact touches");
    for round in 0..3000 {
        let [a, b] = [
            body(&mut rng, HULLS),
            body(&mut rng, OTHERS[round % OTHERS.len()]),
        ];
        let rotation = quarter_turns(&mut rng);
        let along = direction(&mut rng, b.border > 0.0);
        let on_a = a.extreme(along, &mut rng);
        let on_b = b.extreme(-(rotation.inverse() * along).round(), &mut rng);
        let touching = on_a - rotation * on_b + along.normalize() * b.border;
        let middle = a.middle() - rotation * b.middle();
        for (name, step) in STEPS {
            let translation = touching + (touching - middle) * step;
            let way = (touching - middle).length();
            let most = way * step.abs();
            // Where f32 does not hold the place, rounding may move the shapes together or apart.
            let rounding = translation.as_vec3().as_dvec3().distance(translation);
            if rounding > 1e-14 * translation.length() {
                continue;
            }
            let range = [
                if step < 0.0 { -most } else { 0.0 },
                if step > 0.0 { most } else { 0.0 },
            ];
            let scene = Scene {
                bodies: [&a, &b],
                rotation,
                translation,
            };
            let inverse = rotation.inverse();
            let swapped = Scene {
                bodies: [&b, &a],
                rotation: inverse,
                translation: -(inverse * translation),
            };
            for (order, scene, inwards) in [
                ("", scene, middle - touching),
                (", swapped", swapped, inverse * (touching - middle)),
            ] {
                let mut finding = scene.check(step <= 0.0, range);
                let is_inwards = along.dot(middle - touching) < -1e-3 * along.length() * way;
                // A shape a millionth as large may be passed sideways.
                let is_alike = a.size().min(b.size()) > 1e-5 * scene.size();
                if step == 0.0 && is_inwards && is_alike {
                    scene.check_casts(&mut finding, inwards);
                }
                let kinds = [0, 1].map(|i| scene.shapes()[i].shape_type());
                report.add(
                    &format!("{name}{order}"),
                    &format!("{round} {kinds:?} {translation}"),
                    finding,
                );
            }
        }
    }
    report.conclude();
}

/// Whether shapes meet, as each query says it: no two may be at odds.
fn who_says_that_they_meet(pose: &Pose, shapes: [&SharedShape; 2]) -> Vec<(&'static str, bool)> {
    let us = IsaGjkDispatcher::default();
    let [a, b] = shapes.map(|shape| &**shape);
    let intersecting = us
        .intersection_test(pose, a, b)
        .expect("supported")
        .intersecting;
    let distance = us.distance(pose, a, b).expect("supported").distance;
    let closest = us.closest_points(pose, a, b, 0.0).expect("supported");
    let near = us.closest_points(pose, a, b, 1.0).expect("supported");
    let contact = us.contact(pose, a, b, 0.0).expect("supported");
    vec![
        ("intersection_test", intersecting),
        ("distance", distance == 0.0),
        ("closest_points", closest == ClosestPoints::Intersecting),
        ("closest_points, near", near == ClosestPoints::Intersecting),
        ("contact", contact.is_some()),
    ]
}

/// On half-spaces, and on curved shapes, where parry says how deep the overlap is.
#[test]
fn smooth_shapes_meet_for_all_queries_or_for_none() {
    let mut rng = Rng::new(18);
    // A point of each with its normal along y.
    let others = [
        (SharedShape::halfspace(Vector::Y), DVec3::ZERO),
        (SharedShape::cylinder(1.0, 0.5), DVec3::Y),
        (SharedShape::cylinder(1.0, 0.5), DVec3::new(0.5, 1.0, 0.0)),
        (SharedShape::cone(1.0, 0.5), DVec3::Y),
        (SharedShape::round_cylinder(1.0, 0.5, 0.25), DVec3::Y * 1.25),
    ];
    for round in 0..2000 {
        let hull = body(&mut rng, HULLS);
        let rotation = quarter_turns(&mut rng);
        let lowest = hull.extreme((rotation.inverse() * DVec3::NEG_Y).round(), &mut rng);
        let (other, top) = &others[round % others.len()];
        for step in [0.0, STEP, -STEP] {
            // More than the gap that GJK leaves on curved shapes.
            let lift = 16.0 * step * (hull.size() + 2.0);
            let place = *top - rotation * lowest + DVec3::Y * lift;
            let rounding = place.as_vec3().as_dvec3().distance(place);
            // Beneath an edge there is not always an overlap.
            if rounding > 1e-14 * place.length() + 0.1 * lift.abs()
                || step < 0.0 && *top != DVec3::ZERO
            {
                continue;
            }
            let inverse = rotation.inverse();
            let orders = [
                (place, rotation, [other, &hull.shape]),
                (-(inverse * place), inverse, [&hull.shape, other]),
            ];
            for (place, rotation, shapes) in orders {
                let pose = Pose::from_parts(place.as_vec3(), rotation.as_quat());
                let answers = who_says_that_they_meet(&pose, shapes);
                let is_right = answers.iter().all(|(_, meet)| *meet == (step <= 0.0));
                let kind = other.shape_type();
                assert!(is_right, "{round}, {kind:?}, {step}, {place}: {answers:?}");
            }
        }
    }
}
