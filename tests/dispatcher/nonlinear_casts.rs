//! Casts of shapes that turn, against dense sampling of their motions in f64.

use glam::{DQuat, DVec3};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher, ShapeCastHit, ShapeCastStatus,
};
use parry3d::shape::SharedShape;
use testkit::curved::{Body, Difference};
use testkit::generate::Rng;
use testkit::pose::ExactPose;

/// Of the smaller diameter: how near bodies are at their impact, and how deep before.
const TOUCHING: f64 = 2.0e-5;

/// A body and its motion.
struct Mover<'a> {
    body: &'a Body,
    motion: NonlinearRigidMotion,
}

impl Mover<'_> {
    /// Where f64 has it.
    fn pose_at(&self, time: f64) -> ExactPose {
        let motion = &self.motion;
        let start = motion.start.rotation.as_dquat().normalize();
        let rotation = DQuat::from_scaled_axis(motion.angvel.as_dvec3() * time) * start;
        let local_center = motion.local_center.as_dvec3();
        let center = start * local_center + motion.start.translation.as_dvec3();
        let center = center + motion.linvel.as_dvec3() * time;
        ExactPose {
            rotation,
            translation: center - rotation * local_center,
        }
    }
}

struct Course<'a> {
    movers: [Mover<'a>; 2],
    times: [Real; 2],
}

impl Course<'_> {
    fn cast(&self, stop_at_penetration: bool) -> Option<ShapeCastHit> {
        self.cast_by(&IsaGjkDispatcher::default(), stop_at_penetration)
    }

    fn cast_by(&self, dispatcher: &dyn QueryDispatcher, stop: bool) -> Option<ShapeCastHit> {
        let [a, b] = &self.movers;
        let [start, end] = self.times;
        let shapes = [a, b].map(|mover| &*mover.body.shape);
        dispatcher
            .cast_shapes_nonlinear(&a.motion, shapes[0], &b.motion, shapes[1], start, end, stop)
            .expect("supported")
    }

    fn distance_at(&self, time: f64) -> f64 {
        let [a, b] = &self.movers;
        let (to_world, other) = (a.pose_at(time), b.pose_at(time));
        let inverse = to_world.inverse();
        let pose = ExactPose {
            rotation: inverse.rotation * other.rotation,
            translation: inverse.apply(other.translation),
        };
        Difference::new([a.body, b.body], pose)
            .signed_distance()
            .lower
    }

    fn size(&self) -> f64 {
        let [a, b] = &self.movers;
        a.body.diameter().min(b.body.diameter())
    }

    /// The bodies touch at the impact and never before, or never. Returns whether they do.
    fn judge(&self, samples: usize, what: &str) -> bool {
        let hit = self.cast(true);
        let [start, end] = self.times.map(f64::from);
        let until = hit.map_or(end, |hit| hit.time_of_impact.into());
        for i in 0..samples {
            let time = start + (until - start) * i as f64 / samples as f64;
            let distance = self.distance_at(time);
            let is_apart = distance > -1.0e-6 * self.size();
            assert!(
                is_apart || time == until,
                "{what}: {distance:e} at {time} before {hit:?}"
            );
        }
        let Some(hit) = hit else {
            return false;
        };
        if hit.status != ShapeCastStatus::PenetratingOrWithinTargetDist {
            assert_eq!(hit.status, ShapeCastStatus::Converged, "{what}");
            let distance = self.distance_at(until) / self.size();
            // The time is rounded down to f32, on the way of which the bodies are still apart.
            let speed: f64 = self
                .movers
                .iter()
                .map(|mover| speed(&mover.motion, mover.body))
                .sum();
            let rounding = speed * until * f64::from(Real::EPSILON) / self.size();
            assert!(distance > -1.0e-6, "{what}: {distance:e} at {hit:?}");
            assert!(
                distance < TOUCHING + rounding,
                "{what}: {distance:e} at {hit:?}"
            );
        }
        true
    }
}

fn speed(motion: &NonlinearRigidMotion, body: &Body) -> f64 {
    f64::from(motion.linvel.length() + motion.angvel.length()) * (1.0 + body.diameter())
}

fn still(body: &Body) -> Mover<'_> {
    Mover {
        body,
        motion: NonlinearRigidMotion::identity(),
    }
}

fn moving<'a>(body: &'a Body, at: Vector, velocity: Vector, spin: Vector) -> Mover<'a> {
    Mover {
        body,
        motion: NonlinearRigidMotion::new(Pose::from_translation(at), Vector::ZERO, velocity, spin),
    }
}

fn bodies(rng: &mut Rng) -> Vec<Body> {
    let [a, b, c] = [0; 3].map(|_| rng.direction().as_vec3() * 0.6);
    let points: Vec<Vector> = (0..20).map(|_| rng.direction().as_vec3() * 0.5).collect();
    vec![
        Body::ball(0.3),
        Body::capsule([a, b], 0.2),
        Body::cylinder(0.6, 0.2, 0.0),
        Body::cylinder(0.05, 0.5, 0.05),
        Body::cone(0.4, 0.3, 0.0),
        Body::cuboid(Vector::new(0.5, 0.02, 0.4), 0.0),
        Body::cuboid(Vector::new(0.2, 0.4, 0.3), 0.1),
        Body::triangle([a, b, c], 0.0),
        Body::hull(&points, 0.0).expect("a solid"),
        Body::hull(&points, 0.1).expect("a solid"),
    ]
}

#[test]
fn whatever_meets_meets_at_the_impact_and_not_before() {
    let mut rng = Rng::new(31);
    let all = bodies(&mut rng);
    let (mut hits, mut misses) = (0, 0);
    for a in &all {
        for b in &all {
            for turns in [0.0, 0.5, 5.0] {
                let mut mover = |body, reach: f64| {
                    let start = Pose::from_parts(
                        (rng.direction() * reach).as_vec3(),
                        rng.rotation().as_quat(),
                    );
                    let velocity = rng.direction() * 0.5 - start.translation.as_dvec3();
                    let center = rng.direction() * rng.range(0.0, 0.5);
                    let spin = rng.direction() * (turns * 6.0);
                    let motion = NonlinearRigidMotion::new(
                        start,
                        center.as_vec3(),
                        velocity.as_vec3(),
                        spin.as_vec3(),
                    );
                    Mover { body, motion }
                };
                let course = Course {
                    movers: [mover(a, 0.3), mover(b, 2.5)],
                    times: [0.0, 1.2],
                };
                let what = format!("{} and {}, {turns} turns", a.name, b.name);
                if course.judge(60, &what) {
                    hits += 1
                } else {
                    misses += 1
                }
            }
        }
    }
    assert!(hits > 100 && misses > 20, "{hits} hits, {misses} misses");
}

#[test]
fn thin_plates_that_turn_fast_miss_nothing() {
    let mut rng = Rng::new(32);
    let plate = Body::cuboid(Vector::new(0.5, 0.001, 0.5), 0.0);
    let needle = Body::cylinder(0.5, 0.001, 0.0);
    let grain = Body::ball(0.002);
    let mut hits = 0;
    for i in 0..60 {
        let other = [&plate, &needle, &grain][i % 3];
        // It would pass within the sweep of the plate.
        let at = rng.direction() * 1.5;
        let aim = rng.direction() * rng.range(0.0, 0.4) - at;
        let spin = rng.direction() * rng.range(30.0, 120.0);
        let course = Course {
            movers: [
                moving(&plate, Vector::ZERO, Vector::ZERO, spin.as_vec3()),
                moving(other, at.as_vec3(), aim.as_vec3() * 2.0, Vector::ZERO),
            ],
            times: [0.0, 1.0],
        };
        hits += usize::from(course.judge(600, &format!("plate and {} {i}", other.name)));
    }
    assert!(hits > 20, "{hits} hits");
}

#[test]
fn a_rolling_wheel_grazes_nothing() {
    // A hair above the floor; then it comes down on it.
    let wheel = Body::cylinder(0.1, 0.5, 0.0);
    let floor = Body::cuboid(Vector::new(10.0, 1.0, 10.0), 0.0);
    let lying = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2).as_quat();
    for (fall, is_hit) in [(0.0, false), (-0.0011, true), (-0.0009, false)] {
        let start = Pose::from_parts(Vector::new(-5.0, 1.501, 0.0), lying);
        let velocity = Vector::new(10.0, fall, 0.0);
        let motion = NonlinearRigidMotion::new(start, Vector::ZERO, velocity, Vector::Z * -20.0);
        let course = Course {
            movers: [
                still(&floor),
                Mover {
                    body: &wheel,
                    motion,
                },
            ],
            times: [0.0, 1.0],
        };
        assert_eq!(course.judge(50, "wheel"), is_hit, "fall {fall}");
    }
}

#[test]
fn both_ends_of_the_time_are_honoured() {
    let [hull, cone] = [
        Body::cuboid(Vector::splat(0.5), 0.1),
        Body::cone(0.5, 0.3, 0.0),
    ];
    let spin = Vector::new(0.3, 2.0, 1.0);
    let course = |times| Course {
        movers: [
            still(&hull),
            moving(&cone, Vector::X * 4.0, Vector::X * -2.0, spin),
        ],
        times,
    };
    let hit = course([0.0, 10.0]).cast(true).expect("a hit");
    let time = hit.time_of_impact;
    assert!(course([0.0, 0.999 * time]).cast(true).is_none());
    assert!(course([0.0, 1.001 * time]).cast(true).is_some());
    let later = course([0.9 * time, 10.0]).cast(true).expect("a hit");
    assert!((later.time_of_impact - time).abs() < 1.0e-4);
    assert!(course([6.0, 10.0]).cast(true).is_none(), "it has passed");
    let inside = course([2.0, 10.0]).cast(true).expect("a hit");
    assert_eq!(inside.time_of_impact, 2.0, "they overlap at the start");
    assert_eq!(
        inside.status,
        ShapeCastStatus::PenetratingOrWithinTargetDist
    );
}

#[test]
fn what_overlaps_at_the_start_is_met_as_by_parry() {
    let mut rng = Rng::new(33);
    let all = bodies(&mut rng);
    for (i, a) in all.iter().enumerate() {
        let b = &all[(i + 3) % all.len()];
        for velocity in [Vector::X, -Vector::X, Vector::ZERO] {
            let course = Course {
                movers: [
                    still(a),
                    moving(b, Vector::X * 0.05 - velocity * 0.5, velocity, Vector::ZERO),
                ],
                times: [0.5, 1.0],
            };
            if course.distance_at(0.5) > -0.01 {
                continue;
            }
            let hit = course.cast(true).expect("a hit");
            assert_eq!(hit.time_of_impact, 0.5, "{} and {}", a.name, b.name);
            assert_eq!(hit.status, ShapeCastStatus::PenetratingOrWithinTargetDist);
            if velocity == Vector::ZERO {
                let theirs = course.cast_by(&DefaultQueryDispatcher, false);
                assert_eq!(course.cast(false).is_some(), theirs.is_some());
            }
        }
    }
}

#[test]
fn what_does_not_move_meets_nothing_new() {
    let [a, b] = [
        Body::cylinder(0.5, 0.3, 0.0),
        Body::capsule([-Vector::X, Vector::X], 0.1),
    ];
    let course = |at| Course {
        movers: [still(&a), moving(&b, at, Vector::ZERO, Vector::ZERO)],
        times: [0.0, Real::MAX],
    };
    assert!(course(Vector::X * 3.0).cast(true).is_none());
    assert!(course(Vector::X * 3.0).cast(false).is_none());
    assert_eq!(
        course(Vector::ZERO)
            .cast(true)
            .expect("a hit")
            .time_of_impact,
        0.0
    );
}

#[test]
fn nothing_is_too_fast() {
    let wall = Body::cuboid(Vector::new(0.005, 5.0, 5.0), 0.0);
    let cylinder = Body::cylinder(0.02, 0.01, 0.0);
    for speed in [1.0e2, 1.0e4, 1.0e6, 1.0e9] {
        for spin in [0.0, 1.0e2, 1.0e4, 1.0e9] {
            let course = Course {
                movers: [
                    still(&wall),
                    moving(
                        &cylinder,
                        Vector::X * -100.0,
                        Vector::X * speed,
                        Vector::ONE * spin,
                    ),
                ],
                times: [0.0, 1.0],
            };
            let hit = course.cast(true);
            let hit = hit.unwrap_or_else(|| panic!("{speed} m/s, {spin} rad/s"));
            // Wherever it turns, its surface is within its sphere.
            let way = f64::from(hit.time_of_impact * speed);
            let reach = 0.02_f64.hypot(0.01);
            let slack = 1.0e-3;
            let is_before = way <= 99.995 + slack && way >= 99.995 - reach - slack;
            assert!(is_before, "{speed} m/s, {spin} rad/s: {way} of {hit:?}");
        }
    }
}

#[test]
fn impossible_motions_meet_nothing() {
    let [a, b] = [Body::cylinder(0.5, 0.3, 0.0), Body::ball(0.1)];
    for bad in [Real::NAN, Real::INFINITY] {
        let vectors = [Vector::new(bad, 0.0, 0.0), Vector::ZERO];
        for (velocity, spin) in [(vectors[0], vectors[1]), (vectors[1], vectors[0])] {
            let course = Course {
                movers: [still(&a), moving(&b, Vector::X * 2.0, velocity, spin)],
                times: [0.0, 1.0],
            };
            assert!(course.cast(true).is_none());
        }
    }
    let course = Course {
        movers: [
            still(&a),
            moving(&b, Vector::X * 2.0, -Vector::X, DVec3::ZERO.as_vec3()),
        ],
        times: [Real::NAN, Real::NAN],
    };
    assert!(course.cast(true).is_none());
}

/// A body of two parts, and what it meets on its way: the first of what its parts meet alone.
#[test]
fn each_part_of_a_body_is_met_as_soon_as_alone() {
    let mut rng = Rng::new(34);
    let all = bodies(&mut rng);
    let dispatcher = IsaGjkDispatcher::default();
    let (mut hits, mut misses) = (0, 0);
    for turn in 0..400 {
        let [first, second, other] = [0; 3].map(|_| &all[rng.count(0, all.len() - 1)].shape);
        let mut motion = |reach: f64| {
            let at = rng.direction() * reach;
            let start = Pose::from_parts(at.as_vec3(), rng.rotation().as_quat());
            let center = (rng.direction() * rng.range(0.0, 0.5)).as_vec3();
            let velocity = (rng.direction() * 0.5 - at).as_vec3();
            let spin = (rng.direction() * rng.range(0.0, 12.0)).as_vec3();
            NonlinearRigidMotion::new(start, center, velocity, spin)
        };
        let [whole, toward] = [motion(0.3), motion(2.5)];
        let places = [-0.8, 0.8].map(|x| Pose::new(Vector::X * x, Vector::Y * x));
        let parts = [first, second].into_iter().zip(places);
        let compound = SharedShape::compound(parts.clone().map(|(s, p)| (p, s.clone())).collect());
        let cast = |motion: &NonlinearRigidMotion, shape: &SharedShape| {
            dispatcher
                .cast_shapes_nonlinear(motion, &**shape, &toward, &**other, 0.0, 1.5, true)
                .expect("supported")
                .map(|hit| hit.time_of_impact)
        };
        let alone = parts.filter_map(|(shape, place)| cast(&whole.prepend(place), shape));
        let alone = alone.reduce(Real::min);
        assert_eq!(cast(&whole, &compound), alone, "turn {turn}");
        let swapped = dispatcher
            .cast_shapes_nonlinear(&toward, &**other, &whole, &*compound, 0.0, 1.5, true)
            .expect("supported");
        assert_eq!(
            swapped.map(|hit| hit.time_of_impact).is_some(),
            alone.is_some()
        );
        hits += usize::from(alone.is_some());
        misses += usize::from(alone.is_none());
    }
    assert!(hits > 100 && misses > 20, "{hits} hits, {misses} misses");
}
