//! Queries from where nobody expects them: within another query, while a thread ends, and with shapes
//! that are not what they show.

use std::cell::RefCell;
use std::thread;

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{ContactManifold, QueryDispatcher};
use parry3d::shape::{Ball, Cuboid, SharedShape};
use testkit::generate::Rng;
use testkit::memory::{UpdateManifolds, cold_manifold};
use testkit::own_shape::OwnShape;

/// Asks the dispatcher about its shapes before it lets a normal pass.
struct Asks {
    dispatcher: IsaGjkDispatcher,
    shapes: [SharedShape; 2],
    answers: RefCell<Vec<Option<Real>>>,
}

impl Asks {
    fn ask(&self) -> Option<Real> {
        let pose = Pose::translation(0.3, 0.2, 0.1);
        let manifold = cold_manifold(&self.dispatcher, &pose, self.shapes.each_ref(), 0.1);
        Some(manifold?.find_deepest_contact()?.dist)
    }
}

impl NormalConstraints for Asks {
    fn project_local_normal_mut(&self, _: &mut Vector) -> bool {
        self.answers.borrow_mut().push(self.ask());
        true
    }
}

#[test]
fn a_query_within_a_query_is_answered() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(141);
    let mut hull = || rng.hull(30, 1.0).shape;
    let asks = Asks {
        dispatcher: dispatcher.clone(),
        shapes: [hull(), hull()],
        answers: RefCell::default(),
    };
    let outer = [hull(), hull()];
    let pose = Pose::translation(0.4, 0.3, 0.2);
    let mut manifold = ContactManifold::new();
    for _ in 0..3 {
        let [a, b] = &outer;
        dispatcher
            .update_manifold(&pose, [&**a, &**b], [Some(&asks), None], 0.1, &mut manifold)
            .expect("supported");
    }
    let alone = cold_manifold(&dispatcher, &pose, outer.each_ref(), 0.1).expect("supported");
    let [within, alone] = [&manifold, &alone].map(|m| m.find_deepest_contact().map(|p| p.dist));
    let (within, alone) = (within.expect("a contact"), alone.expect("a contact"));
    assert!((within - alone).abs() < 1e-5);
    let answers = asks.answers.borrow();
    assert!(answers.len() >= 3 && answers[0].is_some());
    assert!(answers.iter().all(|&answer| answer == asks.ask()));
}

#[test]
fn a_thread_that_ends_may_ask() {
    struct AsksAtTheEnd(Option<(Asks, Option<Real>)>);
    impl Drop for AsksAtTheEnd {
        fn drop(&mut self) {
            let (asks, expected) = self.0.take().expect("set");
            let answer = asks.ask();
            assert!(answer == expected && answer.is_some());
            asks.answers.borrow_mut().push(answer);
            DONE.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    }
    static DONE: std::sync::atomic::AtomicBool = std::sync::atomic::AtomicBool::new(false);
    thread_local! {
        static LAST: RefCell<AsksAtTheEnd> = const { RefCell::new(AsksAtTheEnd(None)) };
    }
    let asking = thread::spawn(|| {
        let mut rng = Rng::new(142);
        let asks = Asks {
            dispatcher: IsaGjkDispatcher::default(),
            shapes: [(); 2].map(|()| rng.hull(30, 1.0).shape),
            answers: RefCell::default(),
        };
        // On most systems, the first thread-local used is dropped last; ours must be dropped before.
        LAST.with(|_| ());
        let expected = asks.ask();
        LAST.with(|last| last.borrow_mut().0 = Some((asks, expected)));
    });
    asking.join().expect("no panic");
    assert!(DONE.load(std::sync::atomic::Ordering::Relaxed));
}

/// To rapier it may show itself as whatever it likes: what it is its own methods say.
#[test]
fn a_shape_is_not_taken_for_what_it_shows() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(143);
    let hull = rng.hull(30, 1.0).shape;
    let shown = [
        rng.hull(30, 4.0).shape,
        SharedShape::round_cuboid(1.5, 1.5, 1.5, 0.5),
        SharedShape::new(Cuboid::new(Vector::splat(2.0))),
        SharedShape::ball(2.0),
        SharedShape::cylinder(2.0, 2.0),
    ];
    for shown in shown {
        let (ball, name) = (Ball::new(0.1), format!("{:?}", shown.shape_type()));
        let shape = SharedShape::new(OwnShape {
            inner: SharedShape::new(ball),
            tells_features: false,
            shown: Some(shown),
        });
        let cuboid = SharedShape::cuboid(0.5, 0.5, 0.5);
        for other in [&hull, &cuboid] {
            for pose in [1.5, 0.9].map(|x| Pose::translation(x, 0.0, 0.0)) {
                let shown = dispatcher.distance(&pose, &**other, &*shape);
                let plain = dispatcher.distance(&pose, &**other, &ball);
                let [shown, plain] = [shown, plain].map(|d| d.expect("supported").distance);
                let off = (shown - plain).abs();
                assert!(off < 1e-6, "{off:e}: a ball that shows itself as {name}");
            }
        }
    }
}

/// A cone of normals around an axis.
struct Cone {
    axis: Vector,
    cos: Real,
}

impl NormalConstraints for Cone {
    fn project_local_normal_mut(&self, normal: &mut Vector) -> bool {
        let along = normal.dot(self.axis);
        if along < self.cos {
            let aside = (*normal - self.axis * along).normalize_or_zero();
            *normal =
                (self.axis * self.cos + aside * (1.0 - self.cos * self.cos).sqrt()).normalize();
        }
        true
    }
}

/// Nothing beside the pair has a contact if it has none, and no other normal is allowed.
#[test]
fn the_constraints_of_a_caller_are_obeyed_and_leave_a_contact() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(144);
    let mut overlaps = 0;
    for _ in 0..300 {
        let shapes = [
            rng.hull(12, 1.0).shape,
            SharedShape::cuboid(0.5, 0.4, 0.6),
            SharedShape::cylinder(0.4, 0.5),
            SharedShape::cone(0.4, 0.5),
            rng.hull(40, 0.8).shape,
            SharedShape::round_cylinder(0.3, 0.4, 0.1),
        ];
        let first = &*shapes[rng.count(0, 5)];
        let second = &*shapes[[0, 2, 3][rng.count(0, 2)]];
        let pose = rng.pose(0.8).to_f32();
        let Ok(Some(deepest)) = dispatcher.contact(&pose, first, second, 0.0) else {
            continue;
        };
        // Up to 75 degrees away from the normal of the query.
        let cone = Cone {
            axis: (deepest.normal1 + rng.direction().as_vec3() * 0.9).normalize(),
            cos: 0.98,
        };
        let mut manifold = ContactManifold::new();
        dispatcher
            .update_manifold(
                &pose,
                [first, second],
                [Some(&cone), None],
                0.02,
                &mut manifold,
            )
            .expect("supported");
        let along = manifold.local_n1.dot(cone.axis);
        let what = || format!("{:?} and {:?}", first.shape_type(), second.shape_type());
        assert!(!manifold.points.is_empty(), "{} {deepest:?}", what());
        assert!(along > cone.cos - 1e-5, "{}: {along}", what());
        overlaps += 1;
    }
    assert!(overlaps > 100, "only {overlaps}");
}

/// A normal that is none allows no contact.
#[test]
fn constraints_that_give_no_direction_allow_no_contact() {
    struct Nothing(Real);
    impl NormalConstraints for Nothing {
        fn project_local_normal_mut(&self, normal: &mut Vector) -> bool {
            *normal = Vector::splat(self.0);
            true
        }
    }
    let dispatcher = IsaGjkDispatcher::default();
    let hull = Rng::new(145).hull(20, 1.0).shape;
    let pose = Pose::translation(0.3, 0.2, 0.1);
    for (nothing, other) in [0.0, Real::NAN].into_iter().flat_map(|none| {
        [SharedShape::cylinder(0.5, 0.5), hull.clone()].map(|other| (Nothing(none), other))
    }) {
        let mut manifold = ContactManifold::new();
        let constraints: [Option<&dyn NormalConstraints>; 2] = [Some(&nothing), None];
        dispatcher
            .update_manifold(&pose, [&*hull, &*other], constraints, 0.02, &mut manifold)
            .expect("supported");
        assert!(manifold.points.is_empty() && manifold.local_n1.is_finite());
    }
}
