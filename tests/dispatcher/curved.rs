//! Hulls against cylinders and cones: how far apart they are and how deep they overlap, with proofs.

use glam::DVec3;
use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{ClosestPoints, DefaultQueryDispatcher, QueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::cases::Hull;
use testkit::generate::{Rng, prepared};
use testkit::memory::{Manifold, Memory};
use testkit::pose::ExactPose;

/// Of the sum of the two diameters.
const DISTANCE: f64 = 1.0e-5;
/// Of the smaller diameter: parry's search on curved surfaces, with its own hulls, is off by so much.
const DEPTH: f64 = 5.0e-3;

#[derive(Clone, Copy, Debug)]
enum Kind {
    Cylinder,
    Cone,
}

/// A cylinder or cone, perhaps with a border, as the oracle knows it.
#[derive(Clone, Copy, Debug)]
struct Curved {
    kind: Kind,
    half_height: Real,
    radius: Real,
    border: Real,
}

impl Curved {
    fn all() -> impl Iterator<Item = Self> {
        let sizes = [(0.5, 0.4), (0.05, 0.6), (1.5, 0.1)];
        let kinds = [Kind::Cylinder, Kind::Cone];
        kinds.into_iter().flat_map(move |kind| {
            let each = sizes
                .into_iter()
                .flat_map(|size| [(size, 0.0), (size, 0.1)]);
            each.map(move |((half_height, radius), border)| Self {
                kind,
                half_height,
                radius,
                border,
            })
        })
    }

    fn shape(&self) -> SharedShape {
        let (h, r, b) = (self.half_height, self.radius, self.border);
        match (self.kind, b > 0.0) {
            (Kind::Cylinder, false) => SharedShape::cylinder(h, r),
            (Kind::Cylinder, true) => SharedShape::round_cylinder(h, r, b),
            (Kind::Cone, false) => SharedShape::cone(h, r),
            (Kind::Cone, true) => SharedShape::round_cone(h, r, b),
        }
    }

    /// The largest `direction · p`, for a direction of length one.
    fn support(&self, direction: DVec3) -> f64 {
        let [h, r, b] = [self.half_height, self.radius, self.border].map(f64::from);
        let rim = r * direction.x.hypot(direction.z);
        b + match self.kind {
            Kind::Cylinder => h * direction.y.abs() + rim,
            Kind::Cone => (h * direction.y).max(rim - h * direction.y),
        }
    }

    /// By how much a point is outside of it, beyond some plane that supports it.
    fn outside(&self, point: DVec3, rng: &mut Rng) -> f64 {
        let samples = (0..50).map(|_| rng.direction());
        let excess = |n: DVec3| n.dot(point) - self.support(n);
        samples.map(excess).fold(f64::NEG_INFINITY, f64::max)
    }

    fn diameter(&self) -> f64 {
        2.0 * f64::from(self.half_height.hypot(self.radius) + self.border)
    }
}

/// Both orders, and the hull plain and prepared.
fn each_way(
    hull: &Hull,
    curved: &SharedShape,
    pose: &ExactPose,
    check: &mut dyn FnMut([&SharedShape; 2], &Pose, bool),
) {
    for hull in [hull.shape.clone(), prepared(&hull.shape)] {
        check([&hull, curved], &pose.to_f32(), false);
        check([curved, &hull], &pose.inverse().to_f32(), true);
    }
}

/// The nearest points are on the two shapes, and along the line between them the shapes are as far
/// apart as the points are: nothing is nearer.
#[test]
fn distances_are_proved_by_their_own_normals() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(211);
    let mut apart = 0;
    for curved in Curved::all() {
        let shape = curved.shape();
        for vertices in [8, 30, 200] {
            let hull = rng.hull(vertices, 1.0);
            let scale = curved.diameter() + hull.solid.diameter();
            for _ in 0..20 {
                let pose = rng.pose(3.0);
                each_way(&hull, &shape, &pose, &mut |[a, b], pos12, swapped| {
                    let points = dispatcher.closest_points(pos12, &**a, &**b, Real::MAX);
                    let distance = dispatcher
                        .distance(pos12, &**a, &**b)
                        .expect("supported")
                        .distance;
                    let intersecting = dispatcher.intersection_test(pos12, &**a, &**b);
                    let intersecting = intersecting.expect("supported").intersecting;
                    let ClosestPoints::WithinMargin(p1, p2) = points.expect("supported") else {
                        assert!(intersecting && distance == 0.0, "{curved:?}");
                        return;
                    };
                    apart += 1;
                    assert!(!intersecting);
                    let [on_hull, on_curved] =
                        if swapped { [p2, p1] } else { [p1, p2] }.map(|p| p.as_dvec3());
                    let way = pose.apply(on_curved) - on_hull;
                    let normal = way.normalize();
                    let back = -(pose.rotation.inverse() * normal);
                    let separation = normal.dot(pose.translation)
                        - curved.support(back)
                        - hull.solid.support(normal);
                    let off = (way.length() - separation)
                        .abs()
                        .max((way.length() - f64::from(distance)).abs());
                    let off = off
                        .max(hull.solid.outside(on_hull))
                        .max(curved.outside(on_curved, &mut Rng::new(1)));
                    assert!(
                        off < DISTANCE * scale,
                        "{curved:?}, {vertices} vertices: {off} off"
                    );
                });
            }
        }
    }
    assert!(apart > 2000, "{apart} apart");
}

fn least(manifold: Option<&Manifold>) -> Real {
    let points = &manifold.expect("supported").points;
    points.iter().map(|p| p.dist).fold(Real::MAX, Real::min)
}

/// Whatever is remembered: the deepest contact is as deep as the pair, and none is there without need.
#[test]
fn no_contact_is_lost_along_trajectories() {
    let mut rng = Rng::new(212);
    let dispatcher = IsaGjkDispatcher::default();
    let before = dispatcher.stats();
    let (mut near, mut worst) = (0, 0.0_f64);
    for curved in Curved::all() {
        let shape = curved.shape();
        for vertices in [10, 60, 300] {
            let hull = rng.hull(vertices, 1.0);
            let size = curved.diameter().min(hull.solid.diameter());
            let prediction = (0.02 * size) as Real;
            let mut memories = [(); 4].map(|()| Memory::default());
            for pose in rng.trajectory(60, 0.5 * (curved.diameter() + hull.solid.diameter())) {
                let mut memories = memories.iter_mut();
                each_way(&hull, &shape, &pose, &mut |shapes, pos12, _| {
                    let memory = memories.next().expect("four ways");
                    let ours = memory.update(&dispatcher, pos12, shapes, prediction);
                    let depth = least(ours);
                    let [a, b] = shapes;
                    let distance = dispatcher.distance(pos12, &**a, &**b).expect("supported");
                    let true_distance = if distance.distance > 0.0 {
                        distance.distance
                    } else {
                        let contact = DefaultQueryDispatcher.contact(pos12, &**a, &**b, 0.0);
                        contact
                            .expect("supported")
                            .map_or(0.0, |contact| contact.dist)
                    };
                    if true_distance < 0.9 * prediction {
                        near += 1;
                        worst = worst.max(f64::from(depth - true_distance) / size);
                    } else if true_distance > 1.1 * prediction {
                        assert!(depth > 0.9 * prediction, "{curved:?}: {depth}, not apart");
                    }
                });
            }
        }
    }
    assert!(near > 2000, "{near} contacts");
    assert!(worst < DEPTH, "a contact is {worst} of the size too far");
    let stats = dispatcher.stats().since(&before);
    let proved =
        stats.answered[Stage::BoundingSpheres as usize] + stats.answered[Stage::Axis as usize];
    assert!(proved > 2000, "{proved} proved to be apart");
}

/// A cast ends where the distance does.
#[test]
fn casts_end_where_they_touch() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(213);
    let mut hits = 0;
    for curved in Curved::all() {
        let shape = curved.shape();
        let hull = rng.hull(60, 1.0);
        for _ in 0..30 {
            let mut pose = rng.pose(1.0);
            pose.translation = rng.direction() * 5.0;
            let aim = rng.direction() * rng.range(0.0, 0.8) - pose.translation;
            let pose = pose.rounded();
            each_way(&hull, &shape, &pose, &mut |[a, b], pos12, swapped| {
                // Of the second shape, in the frame of the first.
                let velocity = if swapped {
                    pose.rotation.inverse() * -aim
                } else {
                    aim
                };
                let velocity: Vector = velocity.as_vec3();
                let options = ShapeCastOptions::default();
                let hit = dispatcher
                    .cast_shapes(pos12, velocity, &**a, &**b, options)
                    .expect("supported");
                let at = |time: Real| {
                    let there =
                        Pose::from_parts(pos12.translation + velocity * time, pos12.rotation);
                    dispatcher
                        .distance(&there, &**a, &**b)
                        .expect("supported")
                        .distance
                };
                let Some(hit) = hit else {
                    let nearest = (0..400)
                        .map(|i| at(i as Real / 200.0))
                        .fold(Real::MAX, Real::min);
                    assert!(nearest > 0.0, "{curved:?} was missed");
                    return;
                };
                hits += 1;
                assert!(at(hit.time_of_impact) < 1e-4, "{curved:?}: too early");
                assert!(at(hit.time_of_impact - 1e-3) > 0.0, "{curved:?}: too late");
            });
        }
    }
    assert!(hits > 500, "{hits} hits");
}

/// The same hull and curved shape, `scale` times as large; a power of two, so that nothing is rounded.
fn scaled(hull: &Hull, curved: &Curved, scale: Real) -> [SharedShape; 2] {
    let polyhedron = hull.shape.as_convex_polyhedron().expect("a hull").clone();
    let polyhedron = polyhedron.scaled(Vector::splat(scale)).expect("a hull");
    let curved = Curved {
        half_height: curved.half_height * scale,
        radius: curved.radius * scale,
        border: curved.border * scale,
        ..*curved
    };
    [SharedShape::new(polyhedron), curved.shape()]
}

/// Parry's searches stop at absolute lengths: contacts below a millimetre were lost.
#[test]
fn a_pair_of_any_size_is_answered_as_one_of_metres() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(213);
    let mut near = 0;
    for curved in Curved::all() {
        let hull = rng.hull(30, 1.0);
        let poses = rng.trajectory(40, 0.5 * (curved.diameter() + hull.solid.diameter()));
        let answers = |scale: Real| {
            let [a, b] = scaled(&hull, &curved, scale);
            let mut memory = Memory::default();
            let answer = |pose: &ExactPose| {
                let mut pose = pose.to_f32();
                pose.translation *= scale;
                let depth = least(memory.update(&dispatcher, &pose, [&a, &b], 0.02 * scale));
                let contact = dispatcher.contact(&pose, &*a, &*b, 0.02 * scale);
                let contact = contact
                    .expect("supported")
                    .map(|contact| contact.dist / scale);
                let depth = if depth < Real::MAX {
                    depth / scale
                } else {
                    depth
                };
                (depth, contact)
            };
            poses.iter().map(answer).collect::<Vec<_>>()
        };
        let metres = answers(1.0);
        near += metres.iter().filter(|(depth, _)| *depth < 0.0).count();
        // From a micrometre to a thousand kilometres.
        for exponent in [-20, -13, -10, -7, -4, 4, 12, 20] {
            let here = answers((exponent as Real).exp2());
            assert_eq!(
                here, metres,
                "{curved:?} times two to the power of {exponent}"
            );
        }
    }
    assert!(near > 50, "{near} contacts");
}
