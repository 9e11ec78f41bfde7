//! Shape casts that start in contact: they end at once if the shapes approach, whatever the shapes are.

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{Contact, QueryDispatcher, ShapeCastHit, ShapeCastOptions, ShapeCastStatus};
use parry3d::shape::SharedShape;
use testkit::generate::Rng;

/// Where shapes that touch at the start are found to meet, in units of their size over the speed, which is one.
const AT_ONCE: Real = 1e-4;

fn shapes(rng: &mut Rng) -> Vec<SharedShape> {
    vec![
        SharedShape::ball(0.4),
        SharedShape::capsule_y(0.4, 0.2),
        SharedShape::cuboid(0.3, 0.5, 0.4),
        SharedShape::round_cuboid(0.3, 0.2, 0.4, 0.1),
        SharedShape::cylinder(0.5, 0.3),
        SharedShape::round_cylinder(0.4, 0.3, 0.05),
        SharedShape::cone(0.5, 0.4),
        rng.hull(20, 1.0).shape,
    ]
}

/// Two shapes, and where the second one is.
struct Pair<'a> {
    shapes: [&'a SharedShape; 2],
    pose: Pose,
}

impl Pair<'_> {
    fn contact(&self, pose: &Pose) -> Contact {
        let [a, b] = self.shapes;
        IsaGjkDispatcher::default()
            .contact(pose, &**a, &**b, Real::MAX)
            .expect("supported")
            .expect("within reach")
    }

    /// Moves the second shape along a direction until they are this far apart.
    fn move_to(&mut self, direction: DVec3, distance: Real) {
        let (mut near, mut far) = (0.0, 4.0);
        for _ in 0..60 {
            let middle = 0.5 * (near + far);
            self.pose.translation = (direction * middle).as_vec3();
            if self.contact(&self.pose).dist < distance {
                near = middle;
            } else {
                far = middle;
            }
        }
    }

    fn cast(&self, velocity: Vector, stop_at_penetration: bool) -> Option<ShapeCastHit> {
        let [a, b] = self.shapes;
        let options = ShapeCastOptions {
            stop_at_penetration,
            max_time_of_impact: 10.0,
            ..ShapeCastOptions::default()
        };
        IsaGjkDispatcher::default()
            .cast_shapes(&self.pose, velocity, &**a, &**b, options)
            .expect("supported")
    }

    fn check(&self, aside: Vector, what: &str) {
        let contact = self.contact(&self.pose);
        let approaching = (0.3 * aside - contact.normal1).normalize();
        let hit = self.cast(approaching, false);
        let hit = hit.unwrap_or_else(|| panic!("{what}: missed what it overlaps"));
        assert!(hit.time_of_impact < AT_ONCE, "{what}: {hit:?}");
        if contact.dist < -1e-3 {
            assert_eq!(hit.status, ShapeCastStatus::PenetratingOrWithinTargetDist);
            let turned = hit.normal1.distance(contact.normal1);
            assert!(turned < 1e-3, "{what}: {hit:?} for {contact:?}");
            let off = (hit.witness1 - contact.point1).dot(contact.normal1).abs();
            assert!(off < 1e-4, "{what}: {hit:?} for {contact:?}");
            assert!(self.cast(-approaching, false).is_none(), "{what}: departs");
            let stopped = self.cast(-approaching, true).expect("it overlaps");
            assert_eq!(stopped.time_of_impact, 0.0, "{what}");
        }
    }
}

#[test]
fn casts_that_start_in_contact_end_at_once() {
    let mut rng = Rng::new(41);
    let all = shapes(&mut rng);
    for a in &all {
        for b in &all {
            for distance in [-0.2, -0.02, -1e-4, -1e-6, -1e-7, 0.0] {
                for _ in 0..4 {
                    let rotation = rng.rotation().as_quat();
                    let mut pair = Pair {
                        shapes: [a, b],
                        pose: Pose::from_parts(Vector::ZERO, rotation),
                    };
                    pair.move_to(rng.direction(), distance);
                    let what = format!(
                        "{:?} and {:?} at {distance}, {:?}",
                        a.shape_type(),
                        b.shape_type(),
                        pair.pose
                    );
                    pair.check(rng.direction().as_vec3(), &what);
                }
            }
        }
    }
}

/// A character that has stopped at a wall is up to a rounding nearer to it than it should be. Its way along the wall leads
/// over the seam of two triangles, and then past the upper edge.
#[test]
fn a_way_along_a_wall_leads_over_its_seams() {
    const TARGET: Real = 0.002;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 0.5), (-1.0, 0.5)];
    let corners = corners.map(|(x, y)| Vector::new(x, y, 0.0)).to_vec();
    let wall = SharedShape::trimesh(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    let shapes = [
        ("cone", SharedShape::cone(0.06, 0.04), 0.04),
        ("cylinder", SharedShape::cylinder(0.06, 0.03), 0.03),
        ("capsule", SharedShape::capsule_y(0.03, 0.03), 0.03),
        ("cuboid", SharedShape::cuboid(0.03, 0.06, 0.03), 0.03),
        ("ball", SharedShape::ball(0.03), 0.03),
    ];
    let options = ShapeCastOptions {
        target_distance: TARGET,
        stop_at_penetration: false,
        max_time_of_impact: 2.0,
        ..ShapeCastOptions::default()
    };
    let dispatcher = IsaGjkDispatcher::default();
    for (name, shape, half) in &shapes {
        for (i, velocity) in (0..200).flat_map(|i| [(i, Vector::Y), (i, Vector::X)]) {
            let x = -0.4 + 0.0037 * i as Real;
            let nearer = 1e-9 * (i % 15) as Real;
            let pose = Pose::translation(x, -0.8, half + TARGET - nearer);
            let cast = |velocity| {
                let hit = dispatcher.cast_shapes(&pose, velocity, &*wall, &**shape, options);
                hit.expect("supported")
            };
            let hit = cast(velocity);
            assert!(hit.is_none(), "the {name} stops at {hit:?}, from {pose:?}");
            let hit = cast(velocity - Vector::Z * 0.01).expect("they approach");
            assert!(hit.time_of_impact < 1e-3, "the {name} meets late: {hit:?}");
        }
    }
}
