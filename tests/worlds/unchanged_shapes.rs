//! The promise that shapes are unchanged within a step saves proofs, and nothing else: it changes no
//! answer, and ends with the step, however that ends. (`tests/worlds/mid_run.rs` replaces shapes between
//! steps with and without it.)

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::*;
use testkit::generate::Rng;
use testkit::memory::cold_manifold;
use testkit::world::{Ground, mixed, narrow_phase, state};

/// Compounds, meshes and single hulls.
#[test]
fn worlds_go_the_same_way() {
    for ground in Ground::ALL {
        let dispatchers = [(); 2].map(|()| IsaGjkDispatcher::default());
        let mut worlds = dispatchers.each_ref().map(|dispatcher| {
            let narrow_phase = narrow_phase(dispatcher);
            mixed(ground, 28, narrow_phase)
        });
        for step in 0..200 {
            let [alone, promised] = &mut worlds;
            alone.step();
            dispatchers[1].with_unchanged_shapes(|| promised.step());
            let [a, b] = worlds.each_ref().map(state);
            assert!(a == b, "another state after {step} steps on {ground:?}");
        }
        let [a, b] = dispatchers.map(|dispatcher| dispatcher.stats().queries());
        assert_eq!(a, b, "other queries on {ground:?}");
        assert!(a > 1000, "hardly a contact on {ground:?}");
    }
}

/// A pair whose first shape changes in place, with its memory.
struct Changing {
    dispatcher: IsaGjkDispatcher,
    shapes: [SharedShape; 2],
}

impl Changing {
    fn new(rng: &mut Rng) -> Self {
        let dispatcher = IsaGjkDispatcher::default();
        let shapes = [(); 2].map(|()| rng.hull(24, 1.0).shape);
        Self { dispatcher, shapes }
    }

    /// Doubles the first shape; its points stay at their address.
    fn grow(&mut self) {
        let [shape, other] = &mut self.shapes;
        let other = other.as_convex_polyhedron().expect("a hull");
        let shape = shape.make_mut().as_convex_polyhedron_mut();
        let shape = shape.expect("a hull");
        let address = shape.points().as_ptr();
        let grown = std::mem::replace(shape, other.clone()).scaled(Vector::splat(2.0));
        *shape = grown.expect("a scaled hull");
        assert_eq!(address, shape.points().as_ptr(), "the points have moved");
    }

    /// How far apart the pair is at a place, by the manifold of a dispatcher.
    fn distance(&self, dispatcher: &IsaGjkDispatcher) -> Option<Real> {
        let pose = Pose::translation(0.3, 0.4, 0.5);
        let manifold = cold_manifold(dispatcher, &pose, self.shapes.each_ref(), 0.1);
        let points = manifold.expect("supported").points;
        points.iter().map(|point| point.dist).reduce(Real::min)
    }

    /// That the pair is answered as it is.
    fn check(&self) {
        let answer = self.distance(&self.dispatcher);
        // Another thread knows nothing of what this one has prepared and proved.
        let now = thread::scope(|scope| {
            let fresh = scope.spawn(|| self.distance(&IsaGjkDispatcher::default()));
            fresh.join().expect("an answer")
        });
        assert!(now.is_some(), "out of reach");
        assert_eq!(answer, now);
    }
}

#[test]
fn the_promise_ends_with_its_step() {
    let mut pair = Changing::new(&mut Rng::new(91));
    let promised = |pair: &Changing| pair.dispatcher.with_unchanged_shapes(|| pair.check());
    promised(&pair);
    pair.grow();
    pair.check();
    promised(&pair);
    pair.grow();
    promised(&pair);
}

#[test]
fn a_panic_ends_the_promise() {
    let mut pair = Changing::new(&mut Rng::new(92));
    let dispatcher = pair.dispatcher.clone();
    let end = catch_unwind(AssertUnwindSafe(|| {
        dispatcher.with_unchanged_shapes(|| {
            pair.check();
            panic!("of the step");
        });
    }));
    assert!(end.is_err());
    pair.grow();
    pair.check();
}

/// A promise within another ends both: later queries verify again.
#[test]
fn promises_do_not_outlive_each_other() {
    let mut pair = Changing::new(&mut Rng::new(93));
    let clone = pair.dispatcher.clone();
    pair.dispatcher.clone().with_unchanged_shapes(|| {
        pair.check();
        clone.with_unchanged_shapes(|| pair.check());
        pair.grow();
        pair.check();
    });
}
