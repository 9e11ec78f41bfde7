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
