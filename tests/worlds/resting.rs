//! Bodies rest on their whole faces: towers stand and fall asleep, contact patches stay where they
//! belong, piles settle, and what rolls or slides does so smoothly.

use std::collections::HashSet;
use std::f32::consts::TAU;

use isa_gjk::{IsaGjkDispatcher, Stage};
use oorandom::Rand32;
use rapier3d::prelude::*;
use testkit::memory::kept;
use testkit::quality::{Observer, Quality};
use testkit::scanned::noisy_box;
use testkit::scenes::hulls::{RADIUS, cuboid, prism, upturned_table};
use testkit::scenes::{self, HullSource, Scene, SceneParams, World};
use testkit::world;

fn params(hulls: HullSource, bodies: u32) -> SceneParams {
    SceneParams {
        distinct: 8,
        ..SceneParams::new(hulls, bodies)
    }
}

/// All of the real hulls.
fn real_params(bodies: u32) -> SceneParams {
    SceneParams {
        distinct: u32::MAX,
        ..params(HullSource::Real, bodies)
    }
}

/// Steps a scene; drift and patches are those of the second half.
fn observe(scene: Scene, params: &SceneParams, steps: usize) -> (World, Quality) {
    let dispatcher = IsaGjkDispatcher::default();
    let mut world = scenes::build(scene, params, Some(dispatcher)).expect("a valid scene");
    let mut observer = Observer::new(&world);
    for step in 0..steps {
        if step == steps / 2 {
            observer.mark(&world);
        }
        world.step();
        observer.step(&world);
    }
    let quality = observer.finish(&world);
    (world, quality)
}

#[test]
fn towers_of_prisms_stand_and_fall_asleep() {
    for sides in [4, 6, 12, 32] {
        let (_, seen) = observe(Scene::Stack, &params(HullSource::Prism { sides }, 128), 400);
        assert!(seen.tilt < 2.0, "{sides} sides: tilt of {}°", seen.tilt);
        assert!(seen.asleep_after.is_some(), "{sides} sides: awake");
    }
}

/// Cans, loaves, mugs, motors and whatever else of the real hulls is flat below and above, mixed.
#[test]
fn towers_of_real_hulls_stand_and_fall_asleep() {
    let (world, seen) = observe(Scene::Stack, &real_params(128), 400);
    let masses = world.dynamic_bodies().map(|body| body.mass().to_bits());
    let kinds = masses.collect::<HashSet<_>>().len();
    assert!(kinds >= 10, "only {kinds} different hulls");
    assert!(seen.tilt < 2.0, "tilt of {}°", seen.tilt);
    assert!(seen.asleep_after.is_some(), "awake");
}

#[test]
fn towers_of_coins_stand_and_fall_asleep() {
    let (_, seen) = observe(
        Scene::Coins,
        &params(HullSource::Prism { sides: 64 }, 128),
        400,
    );
    assert!(seen.tilt < 2.0, "tilt of {}°", seen.tilt);
    assert!(seen.asleep_after.is_some(), "awake");
}

/// rapier's solver takes four contacts of all parts that stand on one plane. Chosen without regard to their
/// height, most of these do not touch, and such heaps never rest.
#[test]
fn heaps_of_compounds_fall_asleep() {
    for seed in 1..=4 {
        let params = SceneParams {
            seed,
            size: Some(0.12),
            ..SceneParams::new(HullSource::Random { vertices: 12 }, 30)
        };
        let (_, seen) = observe(Scene::Compound, &params, 200);
        assert!(seen.asleep_after.is_some(), "seed {seed}: awake");
    }
}

/// Tables that fall on their tops. With one contact for the top and one for each leg, which ends above the floor,
/// a third of them rattled for ever.
#[test]
fn tables_upside_down_fall_asleep() {
    const TABLES: i16 = 16;
    let mut world = PhysicsWorld {
        narrow_phase: narrow_phase(true),
        ..PhysicsWorld::default()
    };
    let floor = ColliderBuilder::cuboid(9.0, 0.5, 9.0).translation(-0.5 * Vector::Y);
    world.insert_collider(floor, None);
    let table = upturned_table(4).expect("a table");
    let mut random = Rand32::new(1);
    for i in 0..TABLES {
        let mut within = |limit: Real| limit * (2.0 * random.rand_float() - 1.0);
        let turn = Vector::new(within(0.4), within(0.4), within(0.4));
        let start = Pose::new(Vector::new(0.4 * Real::from(i), 0.1, 0.0), turn);
        let table = ColliderBuilder::new(table.clone());
        world.insert(RigidBodyBuilder::dynamic().pose(start), table);
    }
    assert!(frames_until_asleep(&mut world, 150).is_some(), "awake");
}

/// With every pair updated in every step, an impulse lost with its contact would shake a tower.
#[test]
fn towers_are_calm_when_every_contact_is_renewed() {
    for sides in [4, 12, 64] {
        let params = SceneParams {
            recycling: false,
            can_sleep: false,
            ..params(HullSource::Prism { sides }, 32)
        };
        let (world, seen) = observe(Scene::Stack, &params, 400);
        let energy = world.kinetic_energy();
        assert!(energy < 3e-4, "{sides} sides: {energy} J");
        assert!(seen.drift < 8e-3, "{sides} sides: {} m", seen.drift);
    }
}

/// Flat on each other, all corners of two bodies are about equally deep. Trembling decides which is the
/// deepest, and the features of the previous frame still prove nearly every contact.
#[test]
fn what_rests_is_proved_by_the_contacts_that_it_has() {
    for (scene, hulls, bodies) in [
        (Scene::Wall, HullSource::Box, 36),
        (Scene::Stack, HullSource::Prism { sides: 4 }, 16),
        (Scene::Stack, HullSource::Prism { sides: 32 }, 16),
        (Scene::Coins, HullSource::Prism { sides: 64 }, 32),
    ] {
        let params = SceneParams {
            recycling: false,
            can_sleep: false,
            ..params(hulls, bodies)
        };
        let dispatcher = IsaGjkDispatcher::default();
        let world = scenes::build(scene, &params, Some(dispatcher.clone()));
        let mut world = world.expect("a valid scene");
        (0..200).for_each(|_| world.step());
        let before = dispatcher.stats();
        (0..50).for_each(|_| world.step());
        let stats = dispatcher.stats().since(&before);
        let kept = kept(&stats);
        let contacts: u64 = stats.answered[Stage::Still as usize..].iter().sum();
        assert!(
            10 * kept > 9 * contacts,
            "{scene}: {kept} of {contacts} updates: {stats:?}"
        );
    }
}

#[test]
fn walls_and_rows_of_boxes_come_to_rest() {
    let (_, wall) = observe(Scene::Wall, &params(HullSource::Box, 66), 300);
    assert!(wall.tilt < 1.0, "tilt of {}°", wall.tilt);
    assert!(wall.asleep_after.is_some(), "the wall is awake");
    let (_, row) = observe(Scene::Dominoes, &params(HullSource::Box, 16), 500);
    assert!(row.tilt > 45.0, "the row did not fall");
    assert!(row.asleep_after.is_some(), "the row is awake");
}

#[test]
fn slowly_turning_prisms_stand_on_their_middle() {
    for sides in [16, 64] {
        let params = SceneParams {
            can_sleep: false,
            ..params(HullSource::Prism { sides }, 16)
        };
        let (_, seen) = observe(Scene::Spin, &params, 400);
        let offset = seen.patch_offset;
        assert!(offset < 0.1, "{sides} sides: {offset} radii off");
        let step = seen.worst_patch_step;
        assert!(step < 0.05, "{sides} sides: moves by {step} radii");
    }
}

#[test]
fn spun_coins_lie_down() {
    let (_, seen) = observe(
        Scene::Top,
        &params(HullSource::Prism { sides: 64 }, 16),
        400,
    );
    assert!(seen.asleep_after.is_some(), "awake");
}

#[test]
fn a_pile_of_many_sided_prisms_settles() {
    let (world, seen) = observe(
        Scene::Pile,
        &params(HullSource::Prism { sides: 20 }, 216),
        500,
    );
    let energy = world.kinetic_energy();
    assert!(energy < 0.1, "{energy} J");
    assert!(seen.overlap < 0.02, "overlap of {} m", seen.overlap);
}

/// Hulls of real objects, thin ones with triangulated flat sides among them.
#[test]
fn a_pile_of_real_hulls_settles() {
    let (world, seen) = observe(Scene::Pile, &real_params(200), 700);
    let energy = world.kinetic_energy();
    assert!(energy < 1e-3, "{energy} J");
    assert!(seen.median_speed < 1e-3, "{} m/s", seen.median_speed);
}

/// A world with one dynamic body on fixed ground.
struct Track {
    world: PhysicsWorld,
    body: RigidBodyHandle,
}

impl Track {
    fn new(
        narrow_phase: NarrowPhase,
        ground: ColliderBuilder,
        body: RigidBodyBuilder,
        shape: SharedShape,
        friction: Real,
    ) -> Self {
        let mut world = PhysicsWorld {
            narrow_phase,
            ..PhysicsWorld::default()
        };
        world.insert_collider(ground.friction(friction), None);
        let collider = ColliderBuilder::new(shape).friction(friction);
        let (body, _) = world.insert(body.can_sleep(false), collider);
        Self { world, body }
    }

    /// Steps, and returns where the body was after each step.
    fn run(&mut self, steps: usize) -> Vec<Vector> {
        (0..steps)
            .map(|_| {
                self.world.step();
                self.world.bodies[self.body].translation()
            })
            .collect()
    }
}

/// A flat square floor of small triangles at height zero.
fn triangulated_floor(flags: TriMeshFlags) -> ColliderBuilder {
    let along = |i: u32| (i as Real - 20.0) * 0.37;
    let points = (0..41 * 41).map(|i| Vector::new(along(i / 41), 0.0, along(i % 41)));
    let cells = (0..40 * 40).map(|i| i / 40 * 41 + i % 40);
    let triangles = cells.flat_map(|c| [[c, c + 1, c + 41], [c + 1, c + 42, c + 41]]);
    ColliderBuilder::trimesh_with_flags(points.collect(), triangles.collect(), flags)
        .expect("a valid mesh")
}

/// Rapier's own narrow phase, or ours.
fn narrow_phase(ours: bool) -> NarrowPhase {
    if ours {
        world::ours()
    } else {
        NarrowPhase::new()
    }
}

/// How far a body that is pushed over a triangulated floor without friction leaves its straight
/// line, and how much its speed changes. A ghost collision with an inner edge would lift it, turn
/// it aside or slow it down.
fn slide(narrow_phase: NarrowPhase, shape: &SharedShape, flags: TriMeshFlags) -> [Real; 2] {
    let height = shape.compute_local_aabb().half_extents().y;
    let start = Vector::new(-4.0, height, -2.0);
    let velocity = Vector::new(2.0, 0.0, 0.7);
    let body = RigidBodyBuilder::dynamic()
        .translation(start)
        .linvel(velocity);
    let ground = triangulated_floor(flags);
    let mut track = Track::new(narrow_phase, ground, body, shape.clone(), 0.0);
    let way = track.run(180);
    let aside = way
        .iter()
        .map(|p| (*p - start).cross(velocity.normalize()).length());
    let speed = track.world.bodies[track.body].linvel().length();
    let slower = (speed - velocity.length()).abs();
    [aside.fold(0.0, Real::max), slower]
}

#[test]
fn hulls_slide_over_the_inner_edges_of_a_mesh() {
    let hulls = [
        ("cube", cuboid(Vector::splat(0.3))),
        ("12 sides", prism(12, RADIUS, 0.2)),
        ("64 sides", prism(64, RADIUS, 0.2)),
    ];
    for (name, shape) in hulls {
        let shape = shape.expect("a solid");
        // Of a mesh that is not prepared for it, the inner edges stop ours and the default's alike.
        let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
        let [default, ours] = [false, true].map(|ours| slide(narrow_phase(ours), &shape, flags));
        println!("{name}: off the line, slower: default {default:?}, ours {ours:?}");
        assert!(ours[0] <= default[0].max(1e-3), "{name}: {} m off", ours[0]);
        assert!(ours[1] <= default[1].max(1e-3), "{name}: {} m/s", ours[1]);
    }
}

/// How far a finely faceted sphere that rolls over a flat floor leaves its line, hops, and gets:
/// means over eight directions. Its facets turn it aside a little, whoever finds the contacts.
fn roll(ours: bool) -> [Real; 3] {
    let mut sums = [0.0; 3];
    for turn in 0..8 {
        let heading = Rotation::from_rotation_y(TAU * turn as Real / 8.0);
        let way = rolling_way(narrow_phase(ours), heading);
        let aside = way.iter().map(|p| p.z.abs()).fold(0.0, Real::max);
        let hop = way.iter().map(|p| p.y - 0.5).fold(0.0, Real::max);
        for (sum, value) in sums.iter_mut().zip([aside, hop, way[119].x]) {
            *sum += value / 8.0;
        }
    }
    sums
}

/// The way of a sphere whose points are turned by `heading` before it rolls along x.
fn rolling_way(narrow_phase: NarrowPhase, heading: Rotation) -> Vec<Vector> {
    let golden = 2.399_963_f32;
    let points: Vec<Vector> = (0..642)
        .map(|i| {
            let y = 1.0 - 2.0 * (i as Real + 0.5) / 642.0;
            let (sin, cos) = (golden * i as Real % TAU).sin_cos();
            let ring = (1.0 - y * y).sqrt();
            heading * (0.5 * Vector::new(ring * cos, y, ring * sin))
        })
        .collect();
    let shape = SharedShape::convex_hull(&points).expect("a solid");
    let ground = cuboid(Vector::new(20.0, 0.5, 20.0)).expect("a solid");
    let ground = ColliderBuilder::new(ground).translation(Vector::new(0.0, -0.5, 0.0));
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.0, 0.5, 0.0))
        .linvel(Vector::new(2.0, 0.0, 0.0))
        .angvel(Vector::new(0.0, 0.0, -4.0));
    Track::new(narrow_phase, ground, body, shape, 0.5).run(120)
}

#[test]
fn a_faceted_sphere_rolls_straight_on() {
    let [default, ours] = [false, true].map(roll);
    println!("aside, hop, way: default {default:?}, ours {ours:?}");
    let [aside, hop, way] = ours;
    assert!(aside <= 1.2 * default[0], "{aside} m aside");
    assert!(hop <= 1.2 * default[1], "{hop} m high");
    assert!((way - default[2]).abs() < 0.05, "{way} m far");
}

/// They stood on one facet of that side, tipped over its edges, and sank in.
#[test]
fn boxes_with_a_noisy_side_come_to_rest_on_it() {
    let mut rng = Rand32::new(1);
    for i in 0..72 {
        let (count, noise) = ([10, 30, 100][i % 3], [1e-4, 1e-3, 3e-3][i / 3 % 3]);
        let points = noisy_box(count, noise, &mut rng);
        let shape = SharedShape::convex_hull(&points).expect("a solid");
        let ground = cuboid(Vector::new(3.0, 0.5, 3.0)).expect("a solid");
        let ground = ColliderBuilder::new(ground).translation(Vector::Y * -0.5);
        let turn = Rotation::from_scaled_axis(Vector::new(0.01, 0.4, 0.02));
        let start = Pose::from_parts(Vector::new(0.02, 0.23, 0.03), turn);
        let body = RigidBodyBuilder::dynamic().pose(start);
        let way = Track::new(narrow_phase(true), ground, body, shape, 0.5).run(240);
        let [sunk, drift] = [0.2 - way[239].y, way[239].distance(way[90])];
        assert!(sunk < noise + 1e-3, "box {i}: sunk by {sunk} m");
        assert!(drift < 1e-3, "box {i}: went {drift} m");
    }
}

/// Heaps of stones of hand size, each one island, sleep as soon as all of their stones lie still. Single
/// heaps are chaotic, so those of several seeds count together.
#[test]
fn heaps_of_small_hulls_sleep() {
    const SEEDS: u64 = 4;
    const FRAMES: u32 = 500;
    for vertices in [10, 20] {
        for size in [0.05, 0.12] {
            let frames = |narrow_phase: fn() -> NarrowPhase| -> u32 {
                let heaps = (0..SEEDS).map(|seed| heap(seed, vertices, size, narrow_phase()));
                heaps
                    .map(|mut heap| frames_until_asleep(&mut heap, FRAMES).unwrap_or(FRAMES))
                    .sum()
            };
            let default = frames(NarrowPhase::new);
            let ours = frames(|| narrow_phase(true));
            assert!(
                ours <= default * 5 / 4 + 30 * SEEDS as u32,
                "{vertices} vertices, {size} m: {ours} for {default}"
            );
        }
    }
}

/// A needle lies on two edges that are a millimetre apart, and rocks by two degrees in each step. With contacts
/// chosen anew in each step, one or two of a heap rocked for ever.
#[test]
fn heaps_of_needles_sleep() {
    for seed in [100, 104, 109] {
        let params = SceneParams {
            seed,
            size: Some(0.12),
            friction: Some(0.2),
            ..SceneParams::new(HullSource::Own, 100)
        };
        let dispatcher = Some(IsaGjkDispatcher::default());
        let heap = scenes::build(Scene::Needles, &params, dispatcher);
        let mut heap = heap.expect("a valid scene");
        let frames = frames_until_asleep(&mut heap.physics, 300);
        assert!(frames.is_some(), "seed {seed}: awake");
    }
}

/// 150 stones above a floor, between four walls.
fn heap(seed: u64, vertices: u32, size: Real, narrow_phase: NarrowPhase) -> PhysicsWorld {
    let mut world = PhysicsWorld {
        narrow_phase,
        ..PhysicsWorld::default()
    };
    let mut random = Rand32::new(seed);
    let mut inside = |from: Real, to: Real| from + (to - from) * random.rand_float();
    let half = 3.0 * size;
    world.insert_collider(
        ColliderBuilder::cuboid(9.0, 0.5, 9.0).translation(-0.5 * Vector::Y),
        None,
    );
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let at = Vector::new(x, 0.0, z) * (half + 0.5);
        world.insert_collider(
            ColliderBuilder::cuboid(0.5 + half * f32::abs(z), 9.0, 0.5 + half * f32::abs(x))
                .translation(at),
            None,
        );
    }
    for i in 0..150 {
        let points: Vec<Vector> = (0..vertices)
            .map(|_| {
                let turn = inside(0.0, TAU);
                let y = inside(-1.0, 1.0);
                let flat = (1.0 - y * y).sqrt();
                Vector::new(flat * turn.cos(), 0.8 * y, flat * turn.sin()) * (0.5 * size)
            })
            .collect();
        let shape = SharedShape::convex_hull(&points).expect("a solid");
        let cell = Vector::new(
            (i % 5) as Real - 2.0,
            (i / 25) as Real + 0.7,
            (i / 5 % 5) as Real - 2.0,
        );
        let turn = Vector::new(inside(-2.0, 2.0), inside(-2.0, 2.0), inside(-2.0, 2.0));
        let body = RigidBodyBuilder::dynamic().pose(Pose::new(cell * (1.1 * size), turn));
        world.insert(body, ColliderBuilder::new(shape));
    }
    world
}

/// The first step after which 19 of 20 bodies sleep for good.
fn frames_until_asleep(world: &mut PhysicsWorld, frames: u32) -> Option<u32> {
    let mut since = None;
    for frame in 0..frames {
        world.step();
        let dynamic = world.bodies.iter().filter(|(_, body)| body.is_dynamic());
        let (all, asleep) = dynamic.fold((0, 0), |(all, asleep), (_, body)| {
            (all + 1, asleep + u32::from(body.is_sleeping()))
        });
        if asleep * 20 < all * 19 {
            since = None;
        } else if since.is_none() {
            since = Some(frame);
        }
        if asleep == all {
            break;
        }
    }
    since
}
