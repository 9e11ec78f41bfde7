//! `SeparationBounds` hold the exact signed distance, nearly meet, and their proofs prove what they say.
//! Checking a proof needs only the shapes and arithmetic, and nothing of this crate.

use std::collections::HashMap;

use glam::{DQuat, DVec3};
use isa_gjk::query::{Certificate, QueryError, SeparationBounds};
use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::{ConvexPolyhedron, Cuboid, HalfSpace, SharedShape};
use testkit::generate::{Rng, prepared};
use testkit::oracle::{Solid, signed_distance};
use testkit::pose::ExactPose;
use testkit::rounded::{self, Rounded};
use testkit::scenes::hulls;

/// Of the smaller shape's size.
const MEET: f64 = 2e-6;
/// Of both sizes and the offset: rounding in f64.
const ROUNDING: f64 = 1e-12;
/// Of both sizes: what the oracle is sure of.
const ORACLE: f64 = 1e-7;

struct Check<'a> {
    shapes: [&'a Rounded; 2],
    pose: ExactPose,
    what: String,
}

impl Check<'_> {
    fn scale(&self) -> f64 {
        let [a, b] = self.shapes;
        let borders = 2.0 * (a.border + b.border);
        a.core.diameter() + b.core.diameter() + borders + self.pose.translation.length()
    }

    fn smaller(&self) -> f64 {
        let size = |shape: &Rounded| shape.core.diameter() + 2.0 * shape.border;
        size(self.shapes[0]).min(size(self.shapes[1]))
    }

    fn run(&self) -> SeparationBounds {
        let [a, b] = self.shapes;
        let pose = self.pose.to_f32();
        let bounds = SeparationBounds::between(&*a.shape, &*b.shape, &pose).expect(&self.what);
        let exact = signed_distance(&a.core, &b.core, &self.pose) - a.border - b.border;
        let (what, slack) = (&self.what, ORACLE * self.scale());
        let (lower, upper) = (bounds.lower, bounds.upper);
        assert!(lower <= exact + slack, "{what}: from {lower}, is {exact}");
        assert!(upper >= exact - slack, "{what}: up to {upper}, is {exact}");
        let apart = upper - lower;
        assert!(
            apart >= 0.0 && apart <= MEET * self.smaller(),
            "{what}: {apart:e} apart"
        );
        self.planes(&bounds);
        match &bounds.certificate {
            Certificate::Points(points) => self.points(&bounds, *points),
            Certificate::Surface(faces) => self.surface(&bounds, faces),
            other => panic!("{what}: {other:?}"),
        }
        bounds
    }

    /// All of shape 1 is below, all of shape 2 above.
    fn planes(&self, bounds: &SeparationBounds) {
        let (what, slack) = (&self.what, ROUNDING * self.scale());
        let [a, b] = self.shapes;
        let normal = bounds.normal;
        assert!((normal.length() - 1.0).abs() < ROUNDING, "{what}: {normal}");
        let highest = a.core.support(normal) + a.border;
        let of_2 = b
            .core
            .points
            .iter()
            .map(|p| normal.dot(self.pose.apply(*p)));
        let lowest = of_2.fold(f64::INFINITY, f64::min) - b.border;
        let [below, above] = bounds.planes;
        assert!(highest <= below + slack, "{what}: {highest} for {below}");
        assert!(lowest >= above - slack, "{what}: {lowest} for {above}");
        assert!(
            bounds.lower <= above - below,
            "{what}: no proof of {}",
            bounds.lower
        );
        assert!(
            (bounds.border - a.border - b.border).abs() < slack,
            "{what}: the border"
        );
    }

    /// The oracle's faces are beneath its points by as much as f32 dents them.
    fn is_in_core(&self, [on_1, on_2]: [DVec3; 2]) -> bool {
        let slack = ORACLE * self.scale();
        let on_2 = self.pose.inverse().apply(on_2);
        let is_in = |core: &Solid, p| distance_to_core(core, p) <= slack;
        is_in(&self.shapes[0].core, on_1) && is_in(&self.shapes[1].core, on_2)
    }

    fn points(&self, bounds: &SeparationBounds, points: [DVec3; 2]) {
        let what = &self.what;
        assert!(
            self.is_in_core(points),
            "{what}: {points:?} beside the shapes"
        );
        let proved = points[0].distance(points[1]) - bounds.border;
        assert!(
            proved <= bounds.upper,
            "{what}: no proof of {}",
            bounds.upper
        );
    }

    /// A closed surface of points of the difference, which goes once around the origin at a distance.
    fn surface(&self, bounds: &SeparationBounds, faces: &[[[DVec3; 2]; 3]]) {
        let what = &self.what;
        let radius = -(bounds.upper + bounds.border);
        let mut sides = HashMap::new();
        let key = |p: DVec3| p.to_array().map(f64::to_bits);
        for corners in faces {
            assert!(
                corners.iter().all(|c| self.is_in_core(*c)),
                "{what}: a corner is beside"
            );
            let face = corners.map(|[p, q]| p - q);
            let distance = distance_to_triangle(face);
            let slack = ROUNDING * self.scale();
            assert!(
                distance >= radius - slack,
                "{what}: a face at {distance} for {radius}"
            );
            for i in 0..3 {
                let [from, to] = [face[i], face[(i + 1) % 3]].map(key);
                *sides.entry((from, to)).or_insert(0) += 1;
                *sides.entry((to, from)).or_insert(0) -= 1;
            }
        }
        assert!(
            sides.values().all(|&count| count == 0),
            "{what}: an open surface"
        );
        let turns: i32 = faces
            .iter()
            .map(|corners| crossing(corners.map(|[p, q]| p - q)))
            .sum();
        assert_eq!(turns, 1, "{what}: not around the origin");
    }
}

/// Also where the core is flat, or a line, or a point.
fn distance_to_core(core: &Solid, p: DVec3) -> f64 {
    if core.points.len() > 3 {
        core.outside(p)
    } else {
        core.distance_to_surface(p)
    }
}

fn distance_to_triangle(corners: [DVec3; 3]) -> f64 {
    Solid::new(corners.into(), &[[0, 1, 2]]).distance_to_surface(DVec3::ZERO)
}

/// Whether a ray from the origin leaves through a triangle (1), comes in (-1), or misses it.
fn crossing([a, b, c]: [DVec3; 3]) -> i32 {
    let ray = DVec3::new(0.3719, -0.5423, 0.7517);
    let turn = |p: DVec3, q: DVec3| ray.dot(p.cross(q));
    let turns = [turn(a, b), turn(b, c), turn(c, a)];
    let outward = (b - a).cross(c - a);
    let is_ahead = outward.dot(a) * outward.dot(ray) > 0.0;
    match is_ahead {
        true if turns.iter().all(|t| *t > 0.0) => 1,
        true if turns.iter().all(|t| *t < 0.0) => -1,
        _ => 0,
    }
}

/// Deep, a little deep, touching, near and far.
fn places(rng: &mut Rng, shapes: [&Rounded; 2]) -> Vec<ExactPose> {
    let rotation = if rng.count(0, 2) == 0 {
        DQuat::IDENTITY
    } else {
        rng.rotation()
    };
    let direction = rng.direction();
    let place = |distance: f64| ExactPose {
        rotation,
        translation: direction * distance,
    };
    let [a, b] = shapes;
    let gap = |at: f64| signed_distance(&a.core, &b.core, &place(at)) - a.border - b.border;
    let farthest = 2.0 * (a.core.diameter() + b.core.diameter() + a.border + b.border);
    let (mut low, mut touching) = (0.0, farthest);
    for _ in 0..50 {
        let middle = 0.5 * (low + touching);
        (low, touching) = if gap(middle) > 0.0 {
            (low, middle)
        } else {
            (middle, touching)
        };
    }
    let size = a
        .core
        .diameter()
        .min(b.core.diameter())
        .max(a.border + b.border);
    let gaps = [
        -touching,
        -0.3 * size,
        -1e-2 * size,
        -1e-6 * size,
        0.0,
        1e-6 * size,
        0.1 * size,
    ];
    let near = gaps.map(|gap| place(touching + gap));
    near.into_iter()
        .chain([place(9.0 * touching)])
        .map(ExactPose::rounded)
        .collect()
}

#[test]
fn bounds_hold_and_are_proved() {
    let mut rng = Rng::new(34);
    let (mut points, mut surfaces) = (0, 0);
    for size in [1.0, 1.0, 0.02, 50.0] {
        let others = rounded::all(&mut rng, size);
        let hulls = rounded::all(&mut rng, 1.0);
        for hull in &hulls[..2] {
            for other in &others {
                for pose in places(&mut rng, [hull, other]) {
                    let what = format!("{}, {} of {size} at {pose:?}", hull.name, other.name);
                    let swapped = pose.inverse().rounded();
                    for (shapes, pose) in [([hull, other], pose), ([other, hull], swapped)] {
                        let what = what.clone();
                        match (Check { shapes, pose, what }).run().certificate {
                            Certificate::Points(_) => points += 1,
                            _ => surfaces += 1,
                        }
                    }
                }
            }
        }
    }
    assert!(
        points > 200 && surfaces > 200,
        "{points} points and {surfaces} surfaces"
    );
}

/// Moved along the normal by what the lower bound says, the shapes are apart; by less, they are not.
#[test]
fn the_normal_leads_out() {
    let mut rng = Rng::new(35);
    for _ in 0..100 {
        let [a, b] = [0, 1].map(|_| rng.any_hull(1.0));
        let pose = rng.pose(0.4);
        let bounds =
            SeparationBounds::between(&*a.shape, &*b.shape, &pose.to_f32()).expect("hulls");
        if bounds.upper > -1e-3 {
            continue;
        }
        let after = |by: f64| {
            let translation = pose.translation + bounds.normal * by;
            signed_distance(
                &a.solid,
                &b.solid,
                &ExactPose {
                    translation,
                    ..pose
                },
            )
        };
        let (out, in_) = (after(1e-9 - bounds.lower), after(-0.99 * bounds.upper));
        assert!(out >= -ORACLE, "still {out:e} inside at {pose:?}");
        assert!(in_ < 0.0, "out too soon at {pose:?}: {in_:e}");
    }
}

#[test]
fn cylinders_and_cones_have_bounds() {
    let hull = prepared(&cube());
    for (shape, apart) in [
        (SharedShape::cylinder(0.5, 0.4), 0.1),
        (SharedShape::cone(0.5, 0.4), 0.1),
        (SharedShape::round_cylinder(0.4, 0.3, 0.1), 0.1),
    ] {
        for signed in [apart, -apart] {
            // Along y all of them end in a plane half a metre up, or in a tip.
            let pose = Pose::translation(0.0, 1.0 + signed as Real, 0.0);
            let bounds = SeparationBounds::between(&*hull, &*shape, &pose).expect("known");
            let (lower, upper) = (bounds.lower, bounds.upper);
            assert!(
                lower <= signed + 1e-7 && upper >= signed - 1e-7,
                "{lower} {upper}"
            );
            assert!(upper - lower < 3e-6, "{lower} to {upper}");
        }
    }
}

fn cube() -> SharedShape {
    hulls::cuboid(Vector::splat(0.5)).expect("a box")
}

/// Over a half-space the lowest point is the whole proof.
#[test]
fn half_spaces_have_bounds() {
    let mut rng = Rng::new(38);
    let mut depths = 0;
    for shape in rounded::all(&mut rng, 1.0).drain(..2) {
        for _ in 0..200 {
            let up = rng.direction().as_vec3();
            let ground = SharedShape::new(HalfSpace::new(up));
            let up = up.as_dvec3().normalize();
            let pose = rng.pose(0.8);
            let height = |p: &DVec3| up.dot(pose.apply(*p)) - shape.border;
            let heights = shape.core.points.iter().map(height);
            let exact = heights.fold(f64::INFINITY, f64::min);
            for is_first in [true, false] {
                let what = format!("{} at {pose:?}, first: {is_first}", shape.name);
                let (a, b, pos12) = if is_first {
                    (&ground, &shape.shape, pose)
                } else {
                    (&shape.shape, &ground, pose.inverse())
                };
                let found = SeparationBounds::between(&**a, &**b, &pos12.to_f32());
                let bounds = found.expect(&what);
                // The inverse is rounded to f32.
                let slack = if is_first { ORACLE } else { 1e-6 };
                assert!(
                    bounds.lower <= exact + slack,
                    "{what}: {bounds:?} for {exact}"
                );
                assert!(
                    bounds.upper >= exact - slack,
                    "{what}: {bounds:?} for {exact}"
                );
                assert!(bounds.upper - bounds.lower < 1e-13, "{what}: {bounds:?}");
                let [below, above] = bounds.planes;
                assert!(bounds.lower <= above - below, "{what}: {bounds:?}");
                let Certificate::Height(point) = bounds.certificate else {
                    panic!("{what}: {bounds:?}");
                };
                let in_ground = if is_first { point } else { pose.apply(point) };
                let proved = up.dot(in_ground) - bounds.border;
                assert!(proved <= bounds.upper + slack, "{what}: {point}");
                depths += usize::from(bounds.upper < 0.0);
            }
        }
    }
    assert!(depths > 100);
}

#[test]
fn what_has_no_bounds_says_why() {
    let hull = cube();
    let ball = SharedShape::ball(0.5);
    let (corners, faces) = Cuboid::new(Vector::new(1.0, 1.0, 1e-7)).to_trimesh();
    let flat = ConvexPolyhedron::from_convex_mesh(corners, &faces).expect("a closed surface");
    let flat = SharedShape::new(flat);
    let compound = SharedShape::compound(vec![(Pose::IDENTITY, hull.clone())]);
    let (near, nowhere) = (
        Pose::translation(0.5, 0.0, 0.0),
        Pose::translation(Real::NAN, 0.0, 0.0),
    );
    let cases = [
        (&ball, &ball, near, QueryError::NoHull),
        (&compound, &ball, near, QueryError::NoHull),
        (&hull, &compound, near, QueryError::OtherShape),
        (
            &hull,
            &SharedShape::ball(-1.0),
            near,
            QueryError::OtherShape,
        ),
        (&hull, &flat, near, QueryError::HullNotPrepared),
        (&hull, &ball, nowhere, QueryError::NotFinite),
        (
            &hull,
            &hull,
            Pose::translation(0.0, Real::INFINITY, 0.0),
            QueryError::NotFinite,
        ),
    ];
    for (a, b, pose, expected) in cases {
        for (a, b) in [(a, b), (b, a)] {
            let found = SeparationBounds::between(&**a, &**b, &pose).map(|_| ());
            assert_eq!(
                found,
                Err(expected),
                "{:?} {:?}",
                a.shape_type(),
                b.shape_type()
            );
            assert!(!expected.to_string().is_empty());
        }
    }
}
