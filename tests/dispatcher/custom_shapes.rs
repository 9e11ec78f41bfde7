//! Convex shapes of a user's own, which implement parry's traits: against the oracle, in worlds, and left to a
//! fallback that is not parry's.

use isa_gjk::{IsaGjkDispatcher, Left};
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::query::{DefaultQueryDispatcher, QueryDispatcher, ShapeCastOptions};
use parry3d::shape::{SharedShape, TriMeshFlags};
use rapier3d::prelude::*;
use testkit::curved::{Body, Faults, Judge, Meeting};
use testkit::generate::Rng;
use testkit::memory::cold_manifold;
use testkit::own_shape::Ellipsoid;
use testkit::world::narrow_phase;

use crate::tally::Tally;

/// Of distances and normals, as a share of the smaller diameter.
const PROMISE: f64 = 1e-5;
/// Of the places of contacts: support points in f32 tell them less exactly.
const PLACES: f64 = 5e-5;

fn solids(rng: &mut Rng, border: f32) -> Vec<Body> {
    let points: Vec<Vector> = (0..20).map(|_| rng.direction().as_vec3() * 0.7).collect();
    let wedge = [
        [-0.5, -0.3, -0.4],
        [0.5, -0.3, -0.4],
        [0.0, 0.4, -0.4],
        [-0.5, -0.3, 0.4],
        [0.5, -0.3, 0.4],
        [0.0, 0.4, 0.4],
    ];
    vec![
        Body::cuboid(Vector::new(0.4, 0.3, 0.8), border),
        Body::hull(&wedge.map(Vector::from_array), border).expect("a solid"),
        Body::hull(&points, border).expect("a solid"),
        Body::cylinder(0.5, 0.4, border),
        Body::cone(0.4, 0.5, border),
    ]
}

/// Of shapes of a user's own.
fn own(rng: &mut Rng, border: f32) -> Vec<Body> {
    let mut own: Vec<Body> = (solids(rng, border).into_iter())
        .map(|body| body.as_own(true))
        .collect();
    own.extend(
        solids(rng, border)
            .into_iter()
            .map(|body| body.as_own(false)),
    );
    own.push(Body::ellipsoid(Vector::new(0.3, 0.5, 0.8)));
    own.push(Body::ellipsoid(Vector::new(0.05, 0.5, 0.6)));
    own
}

fn partners(rng: &mut Rng) -> Vec<Body> {
    let corners = [0; 3].map(|_| rng.direction().as_vec3() * 0.8);
    let ends = [0; 2].map(|_| rng.direction().as_vec3() * 0.6);
    let mut partners = solids(rng, 0.0);
    partners.extend([
        Body::triangle(corners, 0.0),
        Body::capsule(ends, 0.2),
        Body::ball(0.25),
        Body::half_space(Vector::Y),
        Body::cuboid(Vector::new(0.5, 0.2, 0.3), 0.0).as_own(true),
        Body::ellipsoid(Vector::new(0.7, 0.4, 0.2)),
    ]);
    partners
}

#[test]
fn manifolds_are_right() {
    let mut rng = Rng::new(3400);
    let meetings = [Meeting::Random, Meeting::Square, Meeting::Flat];
    let gaps = [0.05, 1e-6, -0.01, -0.2];
    let mut tally = Tally::new(|faults| {
        let in_place = Faults {
            gap: 0.0,
            ..*faults
        };
        faults.gap <= PLACES && in_place.are_within(PROMISE)
    });
    for border in [0.0, 0.07] {
        for first in own(&mut rng, border) {
            for second in partners(&mut rng) {
                tally.add(&mut rng, [&second, &first], &meetings, &gaps);
            }
        }
    }
    tally.check();
}

#[test]
fn scene_queries_are_right() {
    let mut rng = Rng::new(3401);
    let dispatcher = IsaGjkDispatcher::default();
    let mut casts = 0;
    for first in own(&mut rng, 0.0) {
        for second in partners(&mut rng) {
            if second.name == "half-space" {
                continue;
            }
            let size = first.diameter().min(second.diameter());
            for gap in [0.3, 0.01, -0.05] {
                let bodies = [&second, &first];
                let [a, b] = bodies.map(|body| &*body.shape);
                let Some(pose) = Meeting::Random.pose(&mut rng, bodies, gap * size) else {
                    continue;
                };
                let judge = Judge::new(bodies, pose);
                let at = pose.to_f32();
                let names = (&second.name, &first.name, gap);
                let contact = dispatcher.contact(&at, a, b, 1.0).expect("supported");
                let contact = contact.expect("near");
                let mut faults = judge.contact(&contact);
                assert!(faults.gap <= PLACES, "{names:?}: {faults:?}");
                faults.gap = 0.0;
                assert!(faults.are_within(PROMISE), "{names:?}: {faults:?}");
                let distance = dispatcher.distance(&at, a, b).expect("supported").distance;
                let off = distance - judge.exact.lower.max(0.0) as f32;
                assert!(off.abs() <= 1e-5 * size as f32, "{names:?}: {off:e}");
                if gap < 0.1 {
                    continue;
                }
                // The shortest way.
                let options = ShapeCastOptions::with_max_time_of_impact(1.0);
                let hit = dispatcher.cast_shapes(&at, -contact.normal1, a, b, options);
                let time = hit.expect("supported").expect("a hit").time_of_impact;
                let off = time - contact.dist;
                assert!(off.abs() <= 1e-4 * size as f32, "{names:?}: {off:e} late");
                casts += 1;
            }
        }
    }
    assert!(casts > 80, "{casts}");
}

fn bumpy_ground() -> SharedShape {
    let height = |i: u32, k: u32| 0.02 * ((i * 7 + k * 3) % 5) as f32;
    let points = (0..49).map(|i| {
        let (i, k) = (i / 7, i % 7);
        Vector::new(i as f32 - 3.0, height(i, k) - 0.1, k as f32 - 3.0)
    });
    let cells = (0..36).flat_map(|i| {
        let at = i / 6 * 7 + i % 6;
        [[at, at + 1, at + 7], [at + 1, at + 8, at + 7]]
    });
    let (points, flags) = (points.collect(), TriMeshFlags::FIX_INTERNAL_EDGES);
    SharedShape::trimesh_with_flags(points, cells.collect(), flags).expect("a mesh")
}

/// Bodies of a user's own shapes fall on grounds of each kind, and lie there.
#[test]
fn own_bodies_rest() {
    let slab = SharedShape::cuboid(4.0, 0.2, 4.0);
    let corners: Vec<Vector> = (0..8)
        .map(|i| {
            Vector::new(
                [-4.0, 4.0][i & 1],
                [-0.4, 0.0][i >> 1 & 1],
                [-4.0, 4.0][i >> 2],
            )
        })
        .collect();
    let grounds = [
        (slab.clone(), -0.2),
        (SharedShape::convex_hull(&corners).expect("a solid"), 0.0),
        (SharedShape::halfspace(Vector::Y), 0.0),
        (bumpy_ground(), 0.0),
        (SharedShape::compound(vec![(Pose::IDENTITY, slab)]), -0.2),
    ];
    for (ground, height) in grounds {
        let kind = format!("{:?}", ground.shape_type());
        let mut world = PhysicsWorld {
            narrow_phase: narrow_phase(&IsaGjkDispatcher::default()),
            ..PhysicsWorld::default()
        };
        let ground = ColliderBuilder::new(ground).translation(Vector::Y * height);
        world.insert_collider(ground, None);
        let shapes = [
            Body::ellipsoid(Vector::new(0.3, 0.15, 0.2)),
            Body::cuboid(Vector::new(0.3, 0.15, 0.2), 0.0).as_own(true),
            Body::cuboid(Vector::new(0.2, 0.1, 0.2), 0.05).as_own(true),
        ];
        let mut bodies = Vec::new();
        for (i, body) in shapes.into_iter().enumerate() {
            let at = Vector::new(1.5 * i as f32 - 1.5, 0.4, 0.3);
            let builder = RigidBodyBuilder::dynamic()
                .translation(at)
                .angular_damping(5.0);
            bodies.push(world.insert(builder, ColliderBuilder::new(body.shape)).0);
        }
        for _ in 0..600 {
            world.step();
        }
        for body in bodies {
            let body = &world.bodies[body];
            let height = body.translation().y;
            assert!((0.0..0.3).contains(&height), "{kind}: at {height}");
            assert!(body.linvel().length() < 0.05, "{kind}: {}", body.linvel());
        }
    }
}

/// A rounded box that leans on an edge of it stands on both ends of this edge.
#[test]
fn rounded_edges_bear_at_both_ends() {
    let ground = SharedShape::cuboid(4.0, 0.5, 4.0);
    let rounded = Body::cuboid(Vector::new(0.3, 0.15, 0.2), 0.05).as_own(true);
    let dispatcher = IsaGjkDispatcher::default();
    for degrees in [3.0_f32, 20.0, 45.0] {
        let turn = Rotation::from_axis_angle(Vector::Z, degrees.to_radians());
        let (sin, cos) = degrees.to_radians().sin_cos();
        let lowest = 0.3 * sin + 0.15 * cos;
        let pose = Pose::from_parts(Vector::Y * (0.5 + lowest + 0.05 - 1e-3), turn);
        let manifold = cold_manifold(&dispatcher, &pose, [&ground, &rounded.shape], 0.02);
        let mut points = manifold.expect("a contact").points;
        points.sort_by(|a, b| a.dist.total_cmp(&b.dist));
        let [first, second] = [points[0], points[1]];
        assert!(
            (first.dist + 1e-3).abs() < 1e-5,
            "{degrees}: {}",
            first.dist
        );
        assert!(
            (second.dist - first.dist).abs() < 1e-5,
            "{degrees}: {}",
            second.dist
        );
        assert!(
            (first.local_p2.z - second.local_p2.z).abs() > 0.39,
            "{degrees}"
        );
    }
}

/// Heaps of hulls in disguise, rounded or not, rest about as soon as the default's.
#[test]
fn heaps_of_own_bodies_rest() {
    for border in [0.0, 0.008] {
        let (mut ours, mut default) = (0, 0);
        for seed in 1..4 {
            ours += frames_until_rest(narrow_phase(&IsaGjkDispatcher::default()), border, seed);
            default += frames_until_rest(NarrowPhase::new(), border, seed);
        }
        let limit = default + default / 4 + 3 * 30;
        assert!(ours <= limit, "border {border}: {ours}, default {default}");
    }
}

/// How many steps pass until 19 of 20 bodies in a pen sleep.
fn frames_until_rest(narrow_phase: NarrowPhase, border: f32, seed: u128) -> usize {
    let mut rng = Rng::new(seed);
    let mut world = PhysicsWorld {
        narrow_phase,
        ..PhysicsWorld::default()
    };
    let half = 0.42;
    let floor = ColliderBuilder::cuboid(2.0, 0.5, 2.0).translation(Vector::Y * -0.5);
    world.insert_collider(floor, None);
    for (side, thickness) in [Vector::X, -Vector::X, Vector::Z, -Vector::Z]
        .map(|side| (side, side.abs() * 0.5 + (Vector::ONE - side.abs()) * 2.0))
    {
        let wall = ColliderBuilder::cuboid(thickness.x, thickness.y, thickness.z);
        world.insert_collider(
            wall.translation(side * (half + 0.5) + Vector::Y * 2.0),
            None,
        );
    }
    let bodies: Vec<_> = (0..80)
        .map(|i| {
            let points: Vec<Vector> = (0..16).map(|_| rng.direction().as_vec3() * 0.05).collect();
            let body = Body::hull(&points, border).expect("a solid").as_own(true);
            let cell = Vector::new((i % 5) as f32, (i / 25) as f32, (i / 5 % 5) as f32);
            let at = (cell - Vector::new(2.0, -0.8, 2.0)) * 0.14;
            let turn = rng.direction().as_vec3() * 2.0;
            let builder = RigidBodyBuilder::dynamic().translation(at).rotation(turn);
            world.insert(builder, ColliderBuilder::new(body.shape)).0
        })
        .collect();
    let sleeping = |world: &PhysicsWorld| {
        let asleep = bodies
            .iter()
            .filter(|&&body| world.bodies[body].is_sleeping());
        asleep.count() * 20 >= bodies.len() * 19
    };
    (0..600)
        .find(|_| {
            world.step();
            sleeping(&world)
        })
        .unwrap_or(600)
}

/// Another dispatcher than parry's may have its own answer about such shapes.
#[test]
fn a_users_own_fallback_gets_them() {
    let own = SharedShape::new(Ellipsoid(Vector::new(0.3, 0.5, 0.8)));
    let hull = Rng::new(3402).hull(20, 0.5).shape;
    let pose = Pose::translation(0.9, 0.1, 0.0);
    let given = IsaGjkDispatcher::with_fallback(DefaultQueryDispatcher);
    let ours = IsaGjkDispatcher::default();
    let [left, answered] =
        [&given, &ours].map(|dispatcher| cold_manifold(dispatcher, &pose, [&own, &hull], 0.5));
    assert!(left.is_none(), "parry knows no manifold of it");
    assert!(answered.is_some_and(|manifold| !manifold.points.is_empty()));
    assert_eq!(ours.stats().left_to_fallback, [0; Left::COUNT]);
    let parrys = DefaultQueryDispatcher.distance(&pose, &*own, &*hull);
    let distances = [parrys, given.distance(&pose, &*own, &*hull)];
    let [parrys, left] = distances.map(|found| found.expect("supported").distance);
    assert_eq!(parrys, left);
}

/// Shapes without volume, and those that are no numbers, are left to the fallback.
#[test]
fn degenerate_shapes_do_no_harm() {
    let dispatcher = IsaGjkDispatcher::default();
    let cuboid = SharedShape::cuboid(0.5, 0.5, 0.5);
    let hull = Rng::new(3403).hull(20, 0.5).shape;
    let lengths = [0.0, f32::NAN, f32::INFINITY, 1e30, 1e-30];
    for length in lengths {
        let own = SharedShape::new(Ellipsoid(Vector::new(0.3, length, 0.8)));
        for other in [&cuboid, &hull, &own] {
            for pose in [Pose::IDENTITY, Pose::translation(0.7, 0.0, 0.2)] {
                for shapes in [[&own, other], [other, &own]] {
                    let manifold = cold_manifold(&dispatcher, &pose, shapes, 0.1);
                    let points = manifold.map_or(Vec::new(), |manifold| manifold.points);
                    assert!(
                        points.iter().all(|point| point.dist.is_finite()),
                        "{length}"
                    );
                }
            }
        }
    }
}
