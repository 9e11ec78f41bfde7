//! Scene queries of all convex shapes, against the oracle of curved bodies.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{ClosestPoints, QueryDispatcher};
use testkit::curved::{Body, Judge, Meeting};
use testkit::generate::Rng;

/// Of the smaller diameter.
const TOLERANCE: f64 = 1.0e-5;
const GAPS: [f64; 7] = [0.05, 0.005, 1.0e-6, -1.0e-6, -0.01, -0.05, -0.2];

/// Number of [`bodies`].
const KINDS: usize = 13;

/// One of each kind of body.
fn bodies(rng: &mut Rng) -> Vec<Body> {
    let mut size = || 10_f64.powf(rng.range(-1.2, 0.2)) as Real;
    let (h, r, border) = (size(), size(), 0.07);
    let [a, b, c] = [0; 3].map(|_| rng.direction().as_vec3() * 0.6);
    let points: Vec<Vector> = (0..20).map(|_| rng.direction().as_vec3() * 0.5).collect();
    let mut all = vec![
        Body::ball(r),
        Body::capsule([a, b], r),
        Body::half_space(rng.direction().as_vec3()),
    ];
    for border in [0.0, border] {
        all.extend([
            Body::cylinder(h, r, border),
            Body::cone(h, r, border),
            Body::cuboid(Vector::new(0.3, h, r), border),
            Body::triangle([a, b, c], border),
            Body::hull(&points, border).expect("a solid"),
        ]);
    }
    all
}

fn is_half_space(body: &Body) -> bool {
    body.name == "half-space"
}

struct Check<'a> {
    bodies: [&'a Body; 2],
    judge: Judge<'a>,
    pose: Pose,
    what: String,
}

impl Check<'_> {
    fn all(&self) {
        self.distance();
        self.closest_points();
        self.intersection();
        self.contact();
    }

    fn distance(&self) {
        let [a, b] = self.bodies.map(|body| &*body.shape);
        let found = IsaGjkDispatcher::default().distance(&self.pose, a, b);
        let distance = f64::from(found.expect("supported").distance);
        let exact = self.judge.exact;
        let error = if exact.upper < 0.0 {
            distance / self.judge.size
        } else {
            self.judge.distance_error(distance)
        };
        assert!(
            error <= TOLERANCE,
            "{}: {distance} for {exact:?}",
            self.what
        );
    }

    fn closest_points(&self) {
        let [a, b] = self.bodies.map(|body| &*body.shape);
        let found = IsaGjkDispatcher::default().closest_points(&self.pose, a, b, Real::MAX);
        let apart = self.judge.exact.lower.max(0.0);
        let error = match found.expect("supported") {
            ClosestPoints::Intersecting => apart,
            ClosestPoints::WithinMargin(on_1, on_2) => {
                let (on_1, on_2) = (on_1.as_dvec3(), on_2.as_dvec3());
                let distance = self.judge.apply(on_2).distance(on_1);
                let off = [self.bodies[0].outside(on_1), self.bodies[1].outside(on_2)];
                (distance - apart).abs().max(off[0].abs()).max(off[1].abs())
            }
            ClosestPoints::Disjoint => f64::INFINITY,
        };
        assert!(
            error <= TOLERANCE * self.judge.size,
            "{}: {error:e}",
            self.what
        );
    }

    fn intersection(&self) {
        let [a, b] = self.bodies.map(|body| &*body.shape);
        let found = IsaGjkDispatcher::default().intersection_test(&self.pose, a, b);
        let exact = self.judge.exact;
        let error = if found.expect("supported").intersecting {
            exact.lower
        } else {
            -exact.upper
        };
        assert!(
            error <= TOLERANCE * self.judge.size,
            "{}: {exact:?}",
            self.what
        );
    }

    fn contact(&self) {
        let [a, b] = self.bodies.map(|body| &*body.shape);
        let found = IsaGjkDispatcher::default().contact(&self.pose, a, b, Real::MAX);
        let contact = found.expect("supported").expect("within reach");
        let faults = self.judge.contact(&contact);
        assert!(faults.are_within(TOLERANCE), "{}: {faults:?}", self.what);
    }
}

#[test]
fn every_convex_pair_is_answered_exactly() {
    let mut rng = Rng::new(17);
    let mut checked = 0;
    for kind in 0..KINDS {
        // Bodies of other sizes for each kind.
        let all = bodies(&mut rng);
        let a = &all[kind];
        for (other, b) in all.iter().enumerate() {
            if is_half_space(a) && is_half_space(b) {
                continue;
            }
            for meeting in Meeting::ALL {
                // Two kinds meet in either order: in one at every other gap, in the other at the rest.
                let first = usize::from(kind < other);
                for gap in GAPS.into_iter().skip(first).step_by(2) {
                    let size = a.diameter().min(b.diameter());
                    let Some(pose) = meeting.pose(&mut rng, [a, b], gap * size) else {
                        continue;
                    };
                    let check = Check {
                        bodies: [a, b],
                        judge: Judge::new([a, b], pose),
                        pose: pose.to_f32(),
                        what: format!("{} and {}, {meeting:?}, {gap}", a.name, b.name),
                    };
                    check.all();
                    checked += 1;
                }
            }
        }
    }
    assert!(checked > 2000, "only {checked}");
}
