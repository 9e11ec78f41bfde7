//! A running world changes its dispatcher, and its shapes.
//!
//! The pairs keep the manifolds that another dispatcher or another shape has filled. None of that
//! may be lost or believed: the contacts go on where they were, at the present distances.

use std::collections::HashSet;
use std::thread;

use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::query::{DefaultQueryDispatcher, QueryDispatcher};
use rapier3d::prelude::*;
use testkit::generate::Rng;
use testkit::world::{Ground, check_places, deepest, mixed, narrow_phase};

const BODIES: usize = 28;

/// The fastest body, in m/s.
fn fastest(world: &PhysicsWorld) -> Real {
    let speeds = world.bodies.iter().map(|(_, body)| body.linvel().length());
    speeds.fold(0.0, Real::max)
}

#[test]
fn a_running_world_changes_hands_and_back() {
    for ground in Ground::ALL {
        let mut world = mixed(ground, BODIES, NarrowPhase::new());
        for turn in 0..6 {
            let what = format!("turn {turn} on {ground:?}");
            for _ in 0..60 {
                world.step();
                check_places(&world, &what);
            }
            let touching = |world: &PhysicsWorld| {
                let pairs = world.narrow_phase.contact_pairs();
                pairs.filter(|pair| pair.has_any_active_contact()).count()
            };
            let (contacts, speed) = (touching(&world), fastest(&world));
            if turn % 2 == 0 {
                let ours = IsaGjkDispatcher::default();
                world.narrow_phase.set_query_dispatcher(ours);
            } else {
                let theirs = DefaultQueryDispatcher;
                world.narrow_phase.set_query_dispatcher(theirs);
            }
            world
                .bodies
                .iter_mut()
                .for_each(|(_, body)| body.wake_up(true));
            world.step();
            let after = touching(&world);
            assert!(
                4 * after > 3 * contacts,
                "{what}: {contacts} to {after} contacts"
            );
            let jump = fastest(&world) - speed;
            assert!(jump < 1.0, "{what}: thrown by {jump} m/s");
        }
        let depth = deepest(&world);
        assert!(depth < 0.1, "{depth} deep on {ground:?}");
    }
}

/// One hull on another, with contacts in every frame.
struct Two {
    world: PhysicsWorld,
    handles: [ColliderHandle; 2],
    dispatcher: IsaGjkDispatcher,
    steps: u32,
}

impl Two {
    fn new(shapes: [SharedShape; 2]) -> Self {
        let dispatcher = IsaGjkDispatcher::default();
        let mut world = PhysicsWorld {
            narrow_phase: narrow_phase(&dispatcher),
            ..PhysicsWorld::default()
        };
        world.integration_parameters.contact_recycling = false;
        world.gravity = Vector::ZERO;
        let handles = shapes.map(|shape| {
            let body = RigidBodyBuilder::dynamic();
            world.insert(body, ColliderBuilder::new(shape)).1
        });
        Self {
            world,
            handles,
            dispatcher,
            steps: 0,
        }
    }

    fn collider(&mut self, i: usize) -> &mut Collider {
        &mut self.world.colliders[self.handles[i % 2]]
    }

    /// Two of three steps with the promise that no shape changes within.
    fn step(&mut self) {
        self.steps += 1;
        if self.steps.is_multiple_of(3) {
            self.world.step();
        } else {
            self.dispatcher.with_unchanged_shapes(|| self.world.step());
        }
    }

    /// That the manifolds of this step say what a dispatcher without a past says.
    fn assert_present(&mut self, what: &str) -> bool {
        let handles = self.handles;
        let bodies = handles.map(|handle| self.world.colliders[handle].parent().expect("a body"));
        let places = [Pose::IDENTITY, Pose::translation(0.0, 0.5, 0.0)];
        for (body, place) in bodies.into_iter().zip(places) {
            let body = &mut self.world.bodies[body];
            body.set_position(place, true);
            body.set_linvel(Vector::ZERO, true);
            body.set_angvel(Vector::ZERO, true);
        }
        // Distances are those of the beginning of a step.
        self.step();
        let [g1, g2] = handles.map(|handle| self.world.colliders[handle].shape());
        // Another thread knows nothing of what this one has prepared and proved.
        let contact = thread::scope(|scope| {
            let fresh = IsaGjkDispatcher::default();
            let contact = scope.spawn(move || fresh.contact(&places[1], g1, g2, 0.0));
            contact.join().expect("an answer")
        });
        let exact = contact.expect("supported").map(|contact| contact.dist);
        let pairs = self.world.narrow_phase.contact_pairs();
        let manifolds = pairs.flat_map(|pair| pair.manifolds());
        let points = manifolds.flat_map(|manifold| &manifold.points);
        let found = points.map(|point| point.dist).reduce(Real::min);
        let error = match (exact, found) {
            (Some(exact), Some(found)) => (exact - found).abs(),
            (Some(exact), None) => -exact,
            // Only near.
            (None, found) => found.map_or(0.0, |dist| (-dist).max(0.0)),
        };
        assert!(error < 1.0e-5, "{what}: {found:?} for {exact:?}");
        exact.is_some()
    }
}

fn points_address(shape: &SharedShape) -> usize {
    shape
        .as_convex_polyhedron()
        .map_or(0, |hull| hull.points().as_ptr().addr())
}

/// New hulls take the places of old ones, with as many corners, at the addresses that those left.
#[test]
fn replaced_shapes_are_not_answered_for_the_dead() {
    let mut rng = Rng::new(71);
    let mut hull = || rng.hull(20, 1.0).shape;
    let mut two = Two::new([hull(), hull()]);
    let (mut seen, mut reused, mut touching) = (HashSet::new(), 0, 0);
    for turn in 0..200 {
        let collider = two.collider(turn);
        // The old shape dies first, and leaves its address to the new one.
        collider.set_shape(SharedShape::ball(0.1));
        let shape = hull();
        reused += usize::from(!seen.insert(points_address(&shape)));
        collider.set_shape(shape);
        touching += usize::from(two.assert_present(&format!("turn {turn}")));
    }
    assert!(reused > 20, "only {reused} addresses were used again");
    assert!(touching > 20, "only {touching} contacts");
}

/// A prepared hull in the place of a plain one, scaled, and shared with another collider.
#[test]
fn shapes_change_kind_and_size() {
    let mut rng = Rng::new(72);
    let mut two = Two::new([(); 2].map(|()| rng.hull(30, 1.0).shape));
    let mut touching = 0;
    for turn in 0..120 {
        let hull = rng.hull(30, 1.0).shape;
        let polyhedron = hull.as_convex_polyhedron().expect("a hull").clone();
        let prepared = HullShape::try_from(polyhedron.clone()).expect("a solid");
        let collider = two.collider(0);
        match turn % 4 {
            0 => collider.set_shape(SharedShape::new(prepared)),
            1 => {
                let scale = Vector::new(0.8, 1.2, 0.9);
                let scaled = collider.shape().scale_dyn(scale, 0).expect("a solid");
                collider.set_shape(SharedShape(scaled.into()));
            }
            2 => collider.set_shape(hull),
            _ => {
                let shape = collider.shape_mut().as_convex_polyhedron_mut();
                *shape.expect("a hull") = polyhedron;
            }
        }
        touching += usize::from(two.assert_present(&format!("turn {turn}")));
    }
    assert!(touching > 30, "only {touching} contacts");
}

/// A compound becomes a single hull, and back: the contacts of its parts go with it, and rapier's
/// solver graph (which checks itself in builds like this one) forgets them.
#[test]
fn parts_leave_no_contacts_behind() {
    let mut rng = Rng::new(73);
    let mut two = Two::new([(); 2].map(|()| rng.hull(30, 1.0).shape));
    for turn in 0..60 {
        let [whole, left, right] = [(); 3].map(|()| rng.hull(20, 1.0).shape);
        let aside = |x: Real| Pose::translation(x, 0.0, 0.0);
        let parts = vec![(aside(-0.4), left), (aside(0.4), right)];
        let shape = [whole, SharedShape::compound(parts)][turn % 2].clone();
        two.collider(turn / 2).set_shape(shape);
        two.assert_present(&format!("turn {turn}"));
    }
}

/// A platform shrinks under a body at rest, whose middle is no longer above it. Height and normal stay the same.
#[test]
fn what_rests_on_a_platform_falls_when_that_shrinks() {
    let block = |half: [Real; 3]| {
        let side = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let corner = |i| Vector::from(half) * Vector::new(side(i, 0), side(i, 1), side(i, 2));
        SharedShape::convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).expect("a block")
    };
    for body in [block([0.5; 3]), SharedShape::cylinder(0.5, 0.5)] {
        let mut world = PhysicsWorld {
            narrow_phase: narrow_phase(&IsaGjkDispatcher::default()),
            ..PhysicsWorld::default()
        };
        let platform = world.insert_collider(ColliderBuilder::new(block([2.0, 0.5, 2.0])), None);
        let place = RigidBodyBuilder::dynamic().translation(Vector::new(0.6, 1.001, 0.0));
        let body = world.insert(place, ColliderBuilder::new(body)).0;
        let mut height = |platform_half: Real| {
            let shape = block([platform_half, 0.5, platform_half]);
            world.colliders[platform].set_shape(shape);
            world.bodies[body].wake_up(true);
            (0..120).for_each(|_| world.step());
            world.bodies[body].translation().y
        };
        let (rests, falls) = (height(2.0), height(0.3));
        assert!(
            (rests - 1.0).abs() < 1e-3 && falls < 0.0,
            "{rests}, {falls}"
        );
    }
}
