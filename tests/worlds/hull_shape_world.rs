//! Worlds of `HullShape`s live, rest and are saved as worlds of plain hulls are.

use isa_gjk::HullShape;
use rapier3d::prelude::*;
use testkit::generate::{Rng, prepared};
use testkit::world::ours;

const PILE: usize = 36;

/// `count` hulls dropped between four walls onto a floor.
fn pile(shapes: &[SharedShape], count: usize) -> PhysicsWorld {
    let mut world = PhysicsWorld {
        narrow_phase: ours(),
        ..PhysicsWorld::default()
    };
    let floor = ColliderBuilder::cuboid(4.0, 0.5, 4.0).translation(Vector::new(0.0, -0.5, 0.0));
    world.insert_collider(floor, None);
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let half = Vector::new(0.5 + 2.0 * f32::abs(z), 4.0, 0.5 + 2.0 * f32::abs(x));
        let wall = ColliderBuilder::cuboid(half.x, half.y, half.z);
        world.insert_collider(wall.translation(Vector::new(2.5 * x, 4.0, 2.5 * z)), None);
    }
    let mut rng = Rng::new(8);
    for i in 0..count {
        let cell = Vector::new(
            (i % 3) as Real - 1.0,
            0.6 + (i / 9) as Real,
            (i / 3 % 3) as Real - 1.0,
        );
        let turn = rng.direction().as_vec3();
        let body = RigidBodyBuilder::dynamic().pose(Pose::new(cell * 1.1, turn));
        world.insert(body, ColliderBuilder::new(shapes[i % shapes.len()].clone()));
    }
    world
}

fn plain_hulls() -> Vec<SharedShape> {
    let mut rng = Rng::new(9);
    [8, 16, 30, 250]
        .map(|corners| rng.hull(corners, 0.9).shape)
        .into()
}

fn hull_shapes() -> Vec<SharedShape> {
    plain_hulls().iter().map(prepared).collect()
}

fn heights(world: &PhysicsWorld) -> Vec<Real> {
    let bodies = world.bodies.iter().map(|(_, body)| body);
    bodies.map(|body| body.translation().y).collect()
}

fn mean(values: &[Real]) -> Real {
    values.iter().sum::<Real>() / values.len() as Real
}

fn deepest(world: &PhysicsWorld) -> Real {
    let manifolds = world
        .narrow_phase
        .contact_pairs()
        .flat_map(|pair| pair.manifolds());
    let points = manifolds.flat_map(|manifold| &manifold.points);
    points.map(|point| -point.dist).fold(0.0, Real::max)
}

#[test]
fn a_pile_rests_like_one_of_plain_hulls() {
    let mut worlds = [plain_hulls(), hull_shapes()].map(|shapes| pile(&shapes, PILE));
    for world in &mut worlds {
        for frame in 0..300 {
            world.step();
            for (_, body) in world.bodies.iter() {
                let place = body.translation();
                assert!(place.is_finite(), "not finite in frame {frame}");
                let inside = place.x.abs().max(place.z.abs()) < 2.0 && place.y > 0.0;
                assert!(inside, "escaped to {place} in frame {frame}");
            }
        }
        assert!(deepest(world) < 0.05, "overlap of {}", deepest(world));
    }
    let [plain, ours] = worlds.each_ref().map(|world| mean(&heights(world)));
    assert!((plain - ours).abs() < 0.1 * plain, "{plain} and {ours}");
    assert!(ours > 0.2, "the pile sank to {ours}");
}

#[test]
fn a_coin_lies_flat_on_a_half_space() {
    let rim = (0..64).flat_map(|i| {
        let (sin, cos) = (std::f32::consts::TAU * i as Real / 64.0).sin_cos();
        [-0.05, 0.05].map(|y| Vector::new(cos, y, sin))
    });
    let coin = HullShape::from_points(&rim.collect::<Vec<_>>()).expect("a solid");
    let mut world = PhysicsWorld::default();
    let ground = SharedShape::halfspace(Vector::Y);
    world.insert_collider(ColliderBuilder::new(ground), None);
    let tilted = Pose::new(Vector::new(0.0, 0.5, 0.0), Vector::new(0.3, 0.0, 0.1));
    let body = RigidBodyBuilder::dynamic().pose(tilted);
    world.insert(body, ColliderBuilder::new(SharedShape::new(coin)));
    (0..300).for_each(|_| world.step());
    for (_, body) in world.bodies.iter() {
        let up = body.rotation() * Vector::Y;
        let height = body.translation().y;
        assert!(up.y.abs() > 0.9999, "tilted to {up}");
        assert!((0.04..0.051).contains(&height), "at a height of {height}");
    }
}

#[test]
fn continuous_collision_detection_stops_a_fast_hull() {
    let mut world = PhysicsWorld {
        narrow_phase: ours(),
        ..PhysicsWorld::default()
    };
    let plate: Vec<Vector> = (0..8)
        .map(|i| {
            let side = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            Vector::new(3.0 * side(1), 0.01 * side(2), 3.0 * side(4))
        })
        .collect();
    let plate = SharedShape::new(HullShape::from_points(&plate).expect("a solid"));
    world.insert_collider(ColliderBuilder::new(plate), None);
    let bullet = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.0, 2.0, 0.0))
        .linvel(Vector::new(0.0, -200.0, 0.0))
        .ccd_enabled(true);
    let (bullet, _) = world.insert(bullet, ColliderBuilder::new(hull_shapes()[1].clone()));
    // Without it, one step would take the hull more than a metre below the plate.
    world.step();
    let height = world.bodies[bullet].translation().y;
    assert!((0.1..0.6).contains(&height), "at a height of {height}");
}

#[cfg(feature = "serde-serialize")]
mod snapshots {
    use isa_gjk::IsaGjkDispatcher;

    use super::*;

    fn save(world: &PhysicsWorld) -> Vec<u8> {
        bincode::serialize(world).expect("a world can be saved")
    }

    fn load(bytes: &[u8]) -> PhysicsWorld {
        bincode::deserialize(bytes).expect("a world can be loaded")
    }

    #[test]
    fn a_saved_world_loads_with_plain_hulls_without_our_help() {
        let mut world = pile(&hull_shapes(), PILE);
        (0..60).for_each(|_| world.step());
        let mut loaded = load(&save(&world));
        let mut hulls = 0;
        for (handle, collider) in loaded.colliders.iter() {
            let original = world.colliders[handle].shape();
            if let TypedShape::ConvexPolyhedron(polyhedron) = original.as_typed_shape() {
                assert_eq!(collider.shape().as_convex_polyhedron(), Some(polyhedron));
                hulls += 1;
            }
        }
        assert_eq!(hulls, PILE);
        // With rapier's own dispatcher.
        (0..240).for_each(|_| loaded.step());
        assert!(heights(&loaded).iter().all(|y| (0.0..8.0).contains(y)));
    }

    #[test]
    fn a_loaded_world_goes_on_as_the_saved_one() {
        let mut world = pile(&hull_shapes(), PILE);
        (0..60).for_each(|_| world.step());
        let mut loaded = load(&save(&world));
        loaded
            .narrow_phase
            .set_query_dispatcher(IsaGjkDispatcher::default());
        for frame in 0..120 {
            world.step();
            loaded.step();
            for (handle, body) in world.bodies.iter() {
                let [here, there] = [body, &loaded.bodies[handle]].map(|b| *b.position());
                assert_eq!(here, there, "frame {frame}");
            }
        }
    }

    #[test]
    fn plain_hulls_of_a_loaded_world_can_be_prepared_again() {
        let mut world = pile(&hull_shapes(), PILE);
        (0..60).for_each(|_| world.step());
        let mut loaded = load(&save(&world));
        loaded
            .narrow_phase
            .set_query_dispatcher(IsaGjkDispatcher::default());
        for (_, collider) in loaded.colliders.iter_mut() {
            if collider.shape().as_convex_polyhedron().is_some() {
                let shape = prepared(collider.shared_shape());
                collider.set_shape(shape);
            }
        }
        (0..240).for_each(|_| loaded.step());
        assert!(deepest(&loaded) < 0.05, "overlap of {}", deepest(&loaded));
    }
}
