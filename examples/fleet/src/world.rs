//! The world that each job of learning would have: parts dropped into a bin.

use isa_gjk::{HullError, HullShape, IsaGjkDispatcher};
use oorandom::Rand32;
use rapier3d::prelude::*;

/// Different parts.
const SHAPES: u64 = 16;
/// Points of a part; most of them become vertices.
const POINTS: u32 = 24;
/// Metres from the middle of a part to its points.
const RADIUS: Real = 0.06;
/// Half of the bin's width, in metres, and half of its walls' thickness.
const HALF_WIDTH: Real = 0.4;
const WALL: Real = 0.1;

/// What all worlds share: the dispatcher and the prepared shapes.
pub struct Bin {
    shapes: Vec<SharedShape>,
    bodies: u32,
    dispatcher: Option<IsaGjkDispatcher>,
}

impl Bin {
    /// Prepares the shapes. Without a dispatcher, rapier's own narrow phase answers.
    pub fn new(bodies: u32, dispatcher: Option<IsaGjkDispatcher>) -> Result<Self, HullError> {
        let shapes = (0..SHAPES).map(|seed| {
            let mut random = Rand32::new(seed);
            let points: Vec<_> = (0..POINTS)
                .map(|_| RADIUS * direction(&mut random))
                .collect();
            Ok(SharedShape::new(HullShape::from_points(&points)?))
        });
        Ok(Self {
            shapes: shapes.collect::<Result<_, HullError>>()?,
            bodies,
            dispatcher,
        })
    }

    /// A world whose parts start above the bin.
    pub fn fill(&self, seed: u64) -> PhysicsWorld {
        let mut world = PhysicsWorld::default();
        if let Some(dispatcher) = &self.dispatcher {
            world.narrow_phase = NarrowPhase::with_query_dispatcher(dispatcher.clone());
        }
        add_walls(&mut world);
        let mut random = Rand32::new(seed);
        for index in 0..self.bodies {
            let shape = &self.shapes[random.rand_range(0..SHAPES as u32) as usize];
            let across = |random: &mut Rand32| (random.rand_float() - 0.5) * HALF_WIDTH;
            let place = Vector::new(
                across(&mut random),
                0.2 + 2.0 * RADIUS * index as Real,
                across(&mut random),
            );
            let body = RigidBodyBuilder::dynamic()
                .translation(place)
                .rotation(3.0 * direction(&mut random));
            world.insert(body, ColliderBuilder::new(shape.clone()).density(500.0));
        }
        world
    }
}

fn add_walls(world: &mut PhysicsWorld) {
    // High enough for what is dropped.
    let height = 100.0;
    let floor = ColliderBuilder::cuboid(HALF_WIDTH + WALL, WALL, HALF_WIDTH + WALL);
    world.insert_collider(floor.translation(Vector::Y * -WALL), None);
    for side in [-1.0, 1.0] {
        let beside = side * (HALF_WIDTH + WALL);
        let wall = ColliderBuilder::cuboid(WALL, height, HALF_WIDTH + WALL);
        world.insert_collider(wall.translation(Vector::X * beside), None);
        let wall = ColliderBuilder::cuboid(HALF_WIDTH + WALL, height, WALL);
        world.insert_collider(wall.translation(Vector::Z * beside), None);
    }
}

/// Evenly distributed over the sphere.
fn direction(random: &mut Rand32) -> Vector {
    let y = 2.0 * random.rand_float() - 1.0;
    let (sin, cos) = (std::f32::consts::TAU * random.rand_float()).sin_cos();
    let level = (1.0 - y * y).sqrt();
    Vector::new(level * cos, y, level * sin)
}

/// Bodies that sleep.
pub fn asleep(world: &PhysicsWorld) -> u32 {
    count(world, |body| body.is_sleeping())
}

/// Bodies that are no longer in the bin.
pub fn outside(world: &PhysicsWorld) -> u32 {
    count(world, |body| {
        let place = body.translation();
        let is_inside = place.x.abs().max(place.z.abs()) < HALF_WIDTH && place.y > 0.0;
        !is_inside
    })
}

fn count(world: &PhysicsWorld, is_counted: impl Fn(&RigidBody) -> bool) -> u32 {
    let dynamic = world.bodies.iter().filter(|(_, body)| body.is_dynamic());
    dynamic.filter(|(_, body)| is_counted(body)).count() as u32
}
