//! Bodies as entities: what is spawned, changed and removed in a Bevy world happens in rapier's.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::message::MessageCursor;
use bevy_ecs::prelude::*;
use isa_gjk::HullShape;
use isa_gjk::bevy::{
    Collider, CollisionEvent, NarrowPhaseStats, PhysicsContext, PhysicsSystems, PhysicsTransform,
    RigidBody, Velocity, install,
};
use rapier3d::prelude::{
    ActiveHooks, ColliderBuilder, PairFilterContext, PhysicsHooks, Real, RigidBodyBuilder,
    SharedShape, SolverFlags, Vector,
};

/// Half the side of the cubes that fall, in metres.
const HALF: Real = 0.25;

struct Simulation {
    world: World,
    schedule: Schedule,
    collisions: MessageCursor<CollisionEvent>,
}

impl Simulation {
    fn new(context: PhysicsContext) -> Self {
        let (mut world, mut schedule) = (World::new(), Schedule::default());
        world.insert_resource(context);
        install(&mut world, &mut schedule);
        Self {
            world,
            schedule,
            collisions: MessageCursor::default(),
        }
    }

    /// A floor at height zero, and nothing else.
    fn with_floor(context: PhysicsContext) -> (Self, Entity) {
        let mut simulation = Self::new(context);
        let floor = simulation.spawn((
            Collider(ColliderBuilder::cuboid(5.0, 0.5, 5.0)),
            RigidBody::fixed(),
            PhysicsTransform::from_xyz(0.0, -0.5, 0.0),
        ));
        (simulation, floor)
    }

    fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.world.spawn(bundle).id()
    }

    /// A cube at rest whose centre is at `height`.
    fn spawn_cube(&mut self, height: Real) -> Entity {
        let shape = Collider::from(cube(HALF));
        self.spawn((shape, PhysicsTransform::from_xyz(0.0, height, 0.0)))
    }

    fn run(&mut self, steps: usize) {
        (0..steps).for_each(|_| self.schedule.run(&mut self.world));
    }

    /// All collisions of `steps` steps.
    fn collisions(&mut self, steps: usize) -> Vec<CollisionEvent> {
        let mut seen = Vec::new();
        for _ in 0..steps {
            self.run(1);
            let messages = self.world.resource::<Messages<CollisionEvent>>();
            seen.extend(self.collisions.read(messages));
        }
        seen
    }

    fn get<C: Component>(&self, entity: Entity) -> &C {
        self.world.get(entity).expect("the entity has it")
    }

    fn change<C: Component<Mutability = bevy_ecs::component::Mutable>>(
        &mut self,
        entity: Entity,
        change: impl FnOnce(&mut C),
    ) {
        change(&mut self.world.get_mut(entity).expect("the entity has it"));
    }

    fn height(&self, entity: Entity) -> Real {
        self.get::<PhysicsTransform>(entity).translation.y
    }

    fn context(&self) -> &PhysicsContext {
        self.world.resource()
    }

    /// How many bodies and colliders rapier has.
    fn sizes(&self) -> (usize, usize) {
        let rapier = &self.context().world;
        (rapier.bodies.len(), rapier.colliders.len())
    }

    fn stats(&self) -> NarrowPhaseStats {
        *self.world.resource()
    }
}

fn cube(half: Real) -> SharedShape {
    let corners = (0..8).map(|i| Vector::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32));
    let corners: Vec<_> = corners.map(|c| (c * 2.0 - 1.0) * half).collect();
    SharedShape::new(HullShape::from_points(&corners).expect("a cube is solid"))
}

#[track_caller]
fn assert_near(found: Real, expected: Real) {
    assert!(
        (found - expected).abs() < 5e-3,
        "{found} m instead of {expected} m"
    );
}

#[test]
fn a_collider_alone_makes_a_body_that_falls_and_lands() {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    let cube = simulation.spawn_cube(2.0);
    simulation.run(10);
    assert!(simulation.height(cube) < 2.0);
    assert!(simulation.get::<Velocity>(cube).linear.y < -1.0);
    simulation.run(110);
    assert_near(simulation.height(cube), HALF);
}

#[test]
fn a_despawned_entity_leaves_rapier_and_what_lay_on_it_falls() {
    let (mut simulation, floor) = Simulation::with_floor(PhysicsContext::default());
    let cube = simulation.spawn_cube(HALF);
    simulation.run(300);
    let handle = simulation.context().body(cube).expect("a body");
    let asleep = |s: &Simulation| s.context().world.bodies[handle].is_sleeping();
    assert!(asleep(&simulation), "a cube at rest for five seconds");

    simulation.world.despawn(floor);
    assert_eq!(simulation.sizes(), (1, 1), "gone before the next step");
    assert_eq!(simulation.context().body(floor), None);
    simulation.run(30);
    assert!(simulation.height(cube) < 0.0);
}

#[test]
fn without_collider_there_is_a_body_and_without_body_nothing() {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    // Gravity needs a mass, which is the collider's unless the body has some of its own.
    let heavy = RigidBodyBuilder::dynamic().additional_mass(1.0);
    let cube = simulation.spawn((
        Collider::from(cube(HALF)),
        RigidBody(heavy.clone()),
        PhysicsTransform::from_xyz(0.0, 2.0, 0.0),
    ));
    simulation.run(1);
    assert_eq!(simulation.sizes(), (2, 2));

    let shape = simulation.world.entity_mut(cube).take::<Collider>();
    assert_eq!(simulation.sizes(), (2, 1));
    simulation.run(60);
    let height = simulation.height(cube);
    assert!(height < -HALF, "through the floor, to {height} m");

    simulation.world.entity_mut(cube).insert(shape.unwrap());
    simulation.run(1);
    assert_eq!(simulation.sizes(), (2, 2));

    simulation.world.entity_mut(cube).remove::<RigidBody>();
    assert_eq!(
        simulation.sizes(),
        (1, 1),
        "the body takes its collider along"
    );
    let height = simulation.height(cube);
    simulation.run(10);
    assert_eq!(simulation.height(cube), height, "nothing moves it");

    simulation.world.entity_mut(cube).insert(RigidBody(heavy));
    simulation.run(1);
    assert_eq!(simulation.sizes(), (2, 2), "both are back");
    assert!(simulation.height(cube) < height);
}

#[test]
fn a_changed_pose_is_a_teleport_and_a_changed_velocity_a_push() {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    let cube = simulation.spawn_cube(HALF);
    simulation.run(300);

    simulation.change(cube, |t: &mut PhysicsTransform| t.translation.y = 3.0);
    simulation.run(1);
    let height = simulation.height(cube);
    assert!(
        (2.9..3.0).contains(&height),
        "asleep no more, at {height} m"
    );

    simulation.change(cube, |v: &mut Velocity| v.linear = Vector::Y * 5.0);
    simulation.run(1);
    assert!(simulation.height(cube) > height + 0.07);
}

#[test]
fn a_kinematic_body_moves_to_its_pose_with_a_velocity() {
    let mut simulation = Simulation::new(PhysicsContext::default());
    let lift = simulation.spawn((
        Collider::from(cube(HALF)),
        RigidBody(RigidBodyBuilder::kinematic_position_based()),
    ));
    simulation.run(1);
    simulation.change(lift, |t: &mut PhysicsTransform| t.translation.y = 0.5);
    simulation.run(1);
    assert_eq!(simulation.height(lift), 0.5);
    assert_near(simulation.get::<Velocity>(lift).linear.y, 30.0);
}

/// The components of an awake body change in every step. They must not be taken for the wishes
/// of a user, whose impulse would be undone by them.
#[test]
fn what_was_written_back_does_not_undo_an_impulse_given_to_rapier() {
    let mut simulation = Simulation::new(PhysicsContext::default());
    let cube = simulation.spawn_cube(0.0);
    simulation.run(10);
    let mut context = simulation.world.resource_mut::<PhysicsContext>();
    let handle = context.body(cube).expect("a body");
    let body = &mut context.world.bodies[handle];
    body.apply_impulse(Vector::Y * 20.0 * body.mass(), true);
    body.set_translation(Vector::X * 7.0, true);
    simulation.run(1);
    assert!(simulation.get::<Velocity>(cube).linear.y > 15.0);
    assert_eq!(simulation.get::<PhysicsTransform>(cube).translation.x, 7.0);
}

#[test]
fn a_changed_body_keeps_its_motion() {
    let mut simulation = Simulation::new(PhysicsContext::default());
    let cube = simulation.spawn_cube(0.0);
    simulation.run(30);
    let handles = |s: &Simulation| (s.context().body(cube), s.context().collider(cube));
    let before = handles(&simulation);
    let falling = *simulation.get::<Velocity>(cube);

    simulation.change(cube, |body: &mut RigidBody| body.0.gravity_scale = 0.0);
    simulation.run(10);
    assert_eq!(handles(&simulation), before);
    assert_eq!(*simulation.get::<Velocity>(cube), falling, "weightless now");
    assert!(falling.linear.y < -4.0);
}

#[test]
fn a_changed_body_wakes() {
    let (mut simulation, floor) = Simulation::with_floor(PhysicsContext::default());
    let cube = simulation.spawn_cube(HALF);
    simulation.run(300);
    simulation.change(cube, |body: &mut RigidBody| body.0.gravity_scale = -1.0);
    simulation.run(30);
    assert!(simulation.height(cube) > 1.0, "it rises");

    simulation.change(floor, |body: &mut RigidBody| *body = RigidBody::default());
    simulation.run(30);
    assert!(simulation.height(floor) < -1.0, "no longer fixed, it falls");
}

#[test]
fn a_changed_collider_changes_the_shape_in_place() {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    let body = simulation.spawn_cube(HALF);
    simulation.run(300);
    let collider = simulation.context().collider(body);

    simulation.change(body, |c: &mut Collider| c.0.shape = cube(0.1));
    simulation.run(60);
    assert_eq!(simulation.context().collider(body), collider);
    assert_near(simulation.height(body), 0.1);
    let mass = simulation.context().world.bodies[simulation.context().body(body).unwrap()].mass();
    assert_near(mass, 0.008);
}

#[test]
fn each_collision_starts_and_stops_once_between_its_entities() {
    let (mut simulation, floor) = Simulation::with_floor(PhysicsContext::default());
    let cube = simulation.spawn_cube(1.0);
    let other = simulation.spawn((
        Collider::from(self::cube(HALF)),
        PhysicsTransform::from_xyz(2.0, 1.0, 0.0),
    ));
    let is_pair = |entity, a, b| (a, b) == (entity, floor) || (a, b) == (floor, entity);
    let started = |entity, event: &CollisionEvent| matches!(*event, CollisionEvent::Started(a, b) if is_pair(entity, a, b));
    let stopped = |entity, event: &CollisionEvent| matches!(*event, CollisionEvent::Stopped(a, b) if is_pair(entity, a, b));

    let landing = simulation.collisions(120);
    for entity in [cube, other] {
        let of =
            |what: &dyn Fn(&CollisionEvent) -> bool| landing.iter().filter(|e| what(e)).count();
        let starts = of(&|event| started(entity, event));
        let stops = of(&|event| stopped(entity, event));
        assert_eq!(starts, stops + 1, "it touches the floor at the end");
    }

    simulation.change(cube, |t: &mut PhysicsTransform| t.translation.y = 5.0);
    let lifted = simulation.collisions(2);
    assert!(lifted.len() == 1 && stopped(cube, &lifted[0]), "{lifted:?}");

    simulation.world.despawn(other);
    let despawned = simulation.collisions(2);
    assert!(
        despawned.len() == 1 && stopped(other, &despawned[0]),
        "{despawned:?}"
    );
}

/// Where the cubes of a pile lie after two seconds, in the middle of which one was taken away.
fn pile() -> Vec<PhysicsTransform> {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    let cubes: Vec<_> = (0..20)
        .map(|i| {
            let i = i as Real;
            let place = PhysicsTransform::from_xyz(0.1 * i.sin(), 0.5 + 0.6 * i, 0.1 * i.cos());
            simulation.spawn((Collider::from(cube(HALF)), place))
        })
        .collect();
    simulation.run(60);
    simulation.world.despawn(cubes[3]);
    simulation.run(60);
    let rest = cubes.iter().filter(|&&cube| cube != cubes[3]);
    rest.map(|&cube| *simulation.get(cube)).collect()
}

#[test]
fn equal_runs_end_in_equal_bits() {
    let bits = || -> Vec<_> {
        let numbers = pile().into_iter().flat_map(|t| {
            let [x, y, z] = t.translation.to_array();
            let [i, j, k, w] = t.rotation.to_array();
            [x, y, z, i, j, k, w]
        });
        numbers.map(Real::to_bits).collect()
    };
    assert_eq!(bits(), bits());
}

#[test]
fn statistics_count_the_dispatchers_queries_and_none_of_rapiers_own() {
    let landing = |context| {
        let (mut simulation, _) = Simulation::with_floor(context);
        let cube = simulation.spawn_cube(1.0);
        let steps = (0..120).map(|_| {
            simulation.run(1);
            simulation.stats().last_step.queries()
        });
        let sum: u64 = steps.sum();
        assert_near(simulation.height(cube), HALF);
        assert_eq!(simulation.stats().total.queries(), sum);
        sum
    };
    assert!(landing(PhysicsContext::default()) > 0);
    assert_eq!(landing(PhysicsContext::with_default_narrow_phase()), 0);
}

#[test]
fn installed_twice_a_run_is_still_one_step() {
    let mut simulation = Simulation::new(PhysicsContext::default());
    install(&mut simulation.world, &mut simulation.schedule);
    let cube = simulation.spawn_cube(0.0);
    simulation.run(1);
    let dt = simulation.context().world.integration_parameters.dt;
    assert_near(simulation.get::<Velocity>(cube).linear.y, -9.81 * dt);
}

/// Messages that somebody has registered before, and forgets himself.
#[test]
fn messages_that_are_there_already_are_no_obstacle() {
    let mut world = World::new();
    world.init_resource::<Messages<CollisionEvent>>();
    let mut schedule = Schedule::default();
    install(&mut world, &mut schedule);
    let cube = world.spawn(Collider::from(cube(HALF))).id();
    schedule.run(&mut world);
    assert!(world.get::<Velocity>(cube).expect("a body").linear.y < 0.0);
}

/// A system before the sets takes part in their step, one after them sees its outcome.
#[test]
fn the_systems_of_a_user_run_before_or_after_the_step() {
    #[derive(Resource, Default)]
    struct Seen(Vec<Real>);

    let mut simulation = Simulation::new(PhysicsContext::default());
    simulation.world.init_resource::<Seen>();
    simulation.schedule.add_systems((
        (|transforms: Query<&PhysicsTransform>, mut seen: ResMut<Seen>| {
            seen.0.extend(transforms.iter().map(|t| t.translation.x));
        })
        .after(PhysicsSystems::Writeback),
        (|mut transforms: Query<&mut PhysicsTransform>| {
            transforms
                .iter_mut()
                .for_each(|mut t| t.translation.x += 1.0);
        })
        .before(PhysicsSystems::SyncBackend),
    ));
    simulation.spawn_cube(0.0);
    simulation.run(3);
    assert_eq!(simulation.world.resource::<Seen>().0, [1.0, 2.0, 3.0]);
}

/// A hook can let bodies through, and take that back.
#[test]
fn the_hooks_of_a_context_are_called_in_its_steps() {
    struct LetsPass(AtomicBool);
    impl PhysicsHooks for &'static LetsPass {
        fn filter_contact_pair(&self, _: &PairFilterContext) -> Option<SolverFlags> {
            (!self.0.load(Ordering::Relaxed)).then(SolverFlags::default)
        }
    }
    static LETS_PASS: LetsPass = LetsPass(AtomicBool::new(false));

    let mut context = PhysicsContext::default();
    context.hooks = Box::new(&LETS_PASS);
    let (mut simulation, _) = Simulation::with_floor(context);
    let hooked = ColliderBuilder::new(cube(HALF)).active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
    let place = PhysicsTransform::from_xyz(0.0, HALF, 0.0);
    let light = RigidBody(RigidBodyBuilder::dynamic().can_sleep(false));
    let cube = simulation.spawn((Collider(hooked), light, place));
    simulation.run(30);
    assert_near(simulation.height(cube), HALF);
    LETS_PASS.0.store(true, Ordering::Relaxed);
    simulation.run(60);
    assert!(simulation.height(cube) < -1.0, "it falls through the floor");
}

/// As a prefab is: nothing of it is there before it is enabled.
#[test]
fn an_entity_that_is_spawned_disabled_gets_its_body_when_it_is_enabled() {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    let start = PhysicsTransform::from_xyz(0.0, 2.0, 0.0);
    let cube = simulation.spawn((Collider::from(cube(HALF)), start, Disabled));
    simulation.run(30);
    assert_eq!(simulation.sizes(), (1, 1));
    simulation.world.entity_mut(cube).remove::<Disabled>();
    simulation.run(120);
    assert_eq!(simulation.sizes(), (2, 2));
    assert_near(simulation.height(cube), HALF);
}

/// What lay on it falls, and it returns where it was, as fast as it was.
#[test]
fn a_disabled_entity_takes_no_part() {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    let lower = simulation.spawn_cube(HALF);
    let upper = simulation.spawn_cube(3.0 * HALF);
    simulation.run(300);
    simulation.world.entity_mut(lower).insert(Disabled);
    let before = *simulation.get::<PhysicsTransform>(lower);
    let heard = simulation.collisions(60);
    assert_near(simulation.height(upper), HALF);
    let stops = |entity: Entity| move |event: &&CollisionEvent| matches!(**event, CollisionEvent::Stopped(a, b) if a == entity || b == entity);
    assert_eq!(heard.iter().filter(stops(lower)).count(), 2, "{heard:?}");
    assert_eq!(*simulation.get::<PhysicsTransform>(lower), before);

    simulation.world.despawn(upper);
    simulation.world.entity_mut(lower).remove::<Disabled>();
    simulation.run(60);
    assert_near(simulation.height(lower), HALF);
}

#[test]
fn changes_of_a_disabled_entity_hold_when_it_is_enabled() {
    let (mut simulation, _) = Simulation::with_floor(PhysicsContext::default());
    let cube = simulation.spawn_cube(HALF);
    simulation.run(300);
    simulation.world.entity_mut(cube).insert(Disabled);
    simulation.run(10);
    simulation.change(cube, |t: &mut PhysicsTransform| t.translation.y = 4.0);
    simulation.change(cube, |c: &mut Collider| c.0.shape = self::cube(0.1));
    simulation.run(10);
    let handle = simulation.context().body(cube);
    simulation.world.entity_mut(cube).remove::<Disabled>();
    simulation.run(1);
    assert_eq!(simulation.context().body(cube), handle, "still the same");
    let height = simulation.height(cube);
    assert!((3.9..4.0).contains(&height), "it falls from {height} m");
    simulation.run(120);
    assert_near(simulation.height(cube), 0.1);

    simulation.world.entity_mut(cube).insert(Disabled);
    simulation.run(1);
    simulation.world.despawn(cube);
    simulation.run(1);
    assert_eq!(
        simulation.sizes(),
        (1, 1),
        "despawned while it was disabled"
    );
}
