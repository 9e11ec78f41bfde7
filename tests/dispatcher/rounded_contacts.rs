//! Contacts of rounded shapes, the witness and those beside it: their points lie on the rounded surfaces.

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Rotation, Vector};
use parry3d::query::details::NormalConstraints;
use parry3d::shape::SharedShape;
use testkit::generate::{Rng, hull_of};
use testkit::memory::{Manifold, UpdateManifolds, cold_manifold};
use testkit::oracle::signed_distance;
use testkit::pose::ExactPose;
use testkit::rounded::{self, Rounded};

/// Of the larger shape's diameter.
const OFF_SURFACE: f64 = 1.0e-6;

/// How far a point is from the rounded surface. It is never inside the core.
fn off_surface(shape: &Rounded, point: DVec3) -> f64 {
    (shape.core.distance_to_surface(point) - shape.border).abs()
}

fn scale(shape: &Rounded) -> f64 {
    shape.core.diameter() + 2.0 * shape.border
}

#[test]
fn points_lie_on_both_rounded_surfaces() {
    let mut rng = Rng::new(5);
    let mut beside = 0;
    for _ in 0..12 {
        let hulls = rounded::all(&mut rng, 1.0);
        let others = rounded::all(&mut rng, 1.0);
        for hull in &hulls[..2] {
            for other in others
                .iter()
                .filter(|other| hull.border + other.border > 0.0)
            {
                beside += check_points(&mut rng, [hull, other]);
            }
        }
    }
    assert!(beside > 1000, "only {beside} contacts beside the witness");
}

/// Contacts on both of two triangles that lie nearly in one plane belong to one witness. A normal that leans leaves the
/// border over a point of one triangle far from it: behind the other one, or behind what is next to that.
#[test]
fn points_over_triangles_nearly_in_one_plane_lie_on_both_rounded_surfaces() {
    let mut rng = Rng::new(8);
    let mut beside = 0;
    for _ in 0..120 {
        let stone = with_cluster(&mut rng);
        for other in &rounded::all(&mut rng, 1.0)[..6] {
            beside += check_points(&mut rng, [&stone, other]);
        }
    }
    assert!(beside > 10_000, "only {beside} contacts beside the witness");
}

/// A rounded hull with two triangles that bend by half a degree.
fn with_cluster(rng: &mut Rng) -> Rounded {
    const BORDER: f64 = 0.1;
    loop {
        let mut hull = rng.hull(10, 1.0).solid;
        let [a, b, c] = hull.faces()[0];
        let is_beyond =
            |face: &&[u32; 3]| face.contains(&b) && face.contains(&c) && !face.contains(&a);
        let beyond = hull
            .faces()
            .iter()
            .find(is_beyond)
            .expect("a closed surface");
        let d = beyond
            .iter()
            .find(|d| ![b, c].contains(d))
            .expect("three corners");
        let [a, b, c, d] = [a, b, c, *d].map(|i| i as usize);
        let points = &mut hull.points;
        let [from, to] = [points[b] - points[a], points[c] - points[a]];
        let (normal, way) = (from.cross(to).normalize(), points[d] - points[a]);
        let beside = (way - from).reject_from((to - from).normalize()).length();
        points[d] -= normal * (normal.dot(way) + 0.5_f64.to_radians().tan() * beside);
        let rounded: Vec<Vector> = points.iter().map(|p| p.as_vec3()).collect();
        if let Some(hull) = hull_of(&rounded) {
            let shape = SharedShape::round_convex_hull(&rounded, BORDER as f32).expect("a solid");
            return Rounded {
                name: "hull with a cluster",
                core: hull.solid,
                border: BORDER,
                shape,
            };
        }
    }
}

/// That the points of contacts in some poses lie on both surfaces. Returns how many contacts were beside the witness.
fn check_points(rng: &mut Rng, shapes: [&Rounded; 2]) -> usize {
    let dispatcher = IsaGjkDispatcher::default();
    let scale = shapes.map(scale).into_iter().fold(0.0, f64::max);
    let mut beside = 0;
    for _ in 0..12 {
        let pose = touching(rng, shapes);
        let [shape_1, shape_2] = shapes.map(|rounded| &rounded.shape);
        let manifold = cold_manifold(&dispatcher, &pose.to_f32(), [shape_1, shape_2], 0.1);
        let manifold = manifold.expect("supported");
        for point in &manifold.points {
            let on_1 = off_surface(shapes[0], point.local_p1.as_dvec3());
            let on_2 = off_surface(shapes[1], point.local_p2.as_dvec3());
            assert!(
                on_1.max(on_2) <= OFF_SURFACE * scale,
                "{} and {}: {point:?} is {on_1}, {on_2} off at {pose:?}",
                shapes[0].name,
                shapes[1].name
            );
        }
        beside += manifold.points.len().saturating_sub(1);
    }
    beside
}

/// The second shape a little above the first, or in it.
fn touching(rng: &mut Rng, [a, b]: [&Rounded; 2]) -> ExactPose {
    let mut pose = rng.pose(0.0);
    let (apart, gap) = (rng.direction(), rng.range(-0.02, 0.06));
    let distance = |away: f64| {
        let pose = ExactPose {
            translation: apart * away,
            ..pose
        };
        signed_distance(&a.core, &b.core, &pose) - a.border - b.border
    };
    let (mut near, mut far) = (0.0, 4.0);
    for _ in 0..40 {
        let middle = 0.5 * (near + far);
        if distance(middle) < gap {
            near = middle;
        } else {
            far = middle;
        }
    }
    pose.translation = apart * near;
    pose
}

/// A rounded shape in some turn, a little above a ground at this height or in it.
fn lying(rng: &mut Rng, round: &Rounded, ground: f64) -> ExactPose {
    let rotation = rng.rotation();
    let lowest = -round.core.support(rotation.inverse() * DVec3::NEG_Y);
    ExactPose {
        rotation,
        translation: DVec3::Y * (ground + round.border - lowest + rng.range(-0.02, 0.04)),
    }
}

fn assert_on_surface(round: &Rounded, point: Vector, pose: &ExactPose) {
    let off = off_surface(round, point.as_dvec3());
    assert!(
        off <= OFF_SURFACE * scale(round),
        "{point:?} is {off} off at {pose:?}"
    );
}

#[test]
fn points_over_a_half_space_lie_on_the_rounded_surface() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(7);
    let ground = SharedShape::halfspace(Vector::Y);
    let mut beside = 0;
    for _ in 0..400 {
        let round = &rounded::all(&mut rng, 1.0)[1];
        let pose = lying(&mut rng, round, 0.0);
        let shapes = [&ground, &round.shape];
        let manifold = cold_manifold(&dispatcher, &pose.to_f32(), shapes, 0.2).expect("supported");
        for point in &manifold.points {
            assert_on_surface(round, point.local_p2, &pose);
            let height = pose.apply(point.local_p2.as_dvec3()).y;
            assert!((height - f64::from(point.dist)).abs() < OFF_SURFACE * scale(round));
        }
        beside += manifold.points.len().saturating_sub(1);
    }
    assert!(beside > 400, "only {beside} contacts beside the deepest");
}

/// Allows one normal only.
struct Only(Vector);

impl NormalConstraints for Only {
    fn project_local_normal_mut(&self, normal: &mut Vector) -> bool {
        *normal = self.0;
        true
    }
}

#[test]
fn points_along_corrected_normals_lie_on_the_rounded_surface() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(6);
    let ground = SharedShape::cuboid(4.0, 1.0, 4.0);
    let mut beside = 0;
    for _ in 0..400 {
        let round = &rounded::all(&mut rng, 1.0)[1];
        let pose = lying(&mut rng, round, 1.0);
        let leaning = Rotation::from_scaled_axis(rng.direction().as_vec3() * 0.1) * Vector::Y;
        let constraints: [Option<&dyn NormalConstraints>; 2] = [Some(&Only(leaning)), None];
        let mut manifold = Manifold::new();
        dispatcher
            .update_manifold(
                &pose.to_f32(),
                [&*ground, &*round.shape],
                constraints,
                0.2,
                &mut manifold,
            )
            .expect("supported");
        for point in &manifold.points {
            assert_on_surface(round, point.local_p2, &pose);
        }
        beside += manifold.points.len().saturating_sub(1);
    }
    assert!(beside > 100, "only {beside} contacts beside the deepest");
}
