//! Worlds that show how cylinders, cones and capsules lie, stand and roll. What is measured of them is in
//! [`figures`](super::figures).

use std::f32::consts::{FRAC_PI_2, PI};

use isa_gjk::IsaGjkDispatcher;
use oorandom::Rand32;
use rapier3d::prelude::*;

use super::containers;
use super::filler::{GAP, square_cell};
use super::world::World;

/// Metres per second of what rolls.
const ROLL: Real = 2.0;
pub(super) const WHEEL_RADIUS: Real = 0.5;
/// The sine of the angle by which the thin floor leans.
const LEAN_SINE: Real = 0.1;

/// What happens in such a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvedScene {
    /// A pyramid of five rows of capsules between posts.
    CapsuleLogs,
    /// The same of cylinders.
    Logs,
    /// Cones that fall on their sides.
    Cones,
    /// Sixteen towers of sixteen coins.
    Coins,
    /// Sixteen towers of eight barrels.
    Barrels,
    /// The same of barrels three times as high as wide.
    TallBarrels,
    /// A wheel that rolls on a cuboid for five seconds.
    Roll,
    /// The same for twenty seconds.
    LongRoll,
    /// The same for five seconds on a level mesh.
    MeshRoll,
    /// A wheel that rolls over waves of a mesh.
    Waves,
    /// Cylinders and cones that slide down a thin floor without friction.
    ThinFloor,
    /// Cylinders and cones that fall between walls.
    Heap,
}

impl CurvedScene {
    pub const ALL: [Self; 12] = [
        Self::CapsuleLogs,
        Self::Logs,
        Self::Cones,
        Self::Coins,
        Self::Barrels,
        Self::TallBarrels,
        Self::Roll,
        Self::LongRoll,
        Self::MeshRoll,
        Self::Waves,
        Self::ThinFloor,
        Self::Heap,
    ];

    pub const fn name(self) -> &'static str {
        match self {
            Self::CapsuleLogs => "capsule-logs",
            Self::Logs => "logs",
            Self::Cones => "cones",
            Self::Coins => "coins",
            Self::Barrels => "barrels",
            Self::TallBarrels => "tall-barrels",
            Self::Roll => "roll",
            Self::LongRoll => "long-roll",
            Self::MeshRoll => "mesh-roll",
            Self::Waves => "waves",
            Self::ThinFloor => "thin-floor",
            Self::Heap => "heap",
        }
    }

    /// Of a sixtieth of a second.
    pub const fn steps(self) -> usize {
        match self {
            Self::CapsuleLogs | Self::Logs => 600,
            Self::Cones | Self::Heap => 900,
            Self::Coins | Self::Barrels | Self::TallBarrels => 480,
            Self::Roll | Self::MeshRoll | Self::Waves => 300,
            Self::LongRoll => 1200,
            Self::ThinFloor => 420,
        }
    }

    /// Without a dispatcher, rapier's own narrow phase answers.
    pub fn build(self, seed: u64, dispatcher: Option<IsaGjkDispatcher>) -> World {
        let mut world = World::new(dispatcher, false);
        let random = &mut Rand32::new(seed);
        match self {
            Self::CapsuleLogs => logs(&mut world, &SharedShape::capsule_y(1.0, 0.25)),
            Self::Logs => logs(&mut world, &SharedShape::cylinder(1.0, 0.25)),
            Self::Cones => cones(&mut world, random),
            Self::Coins => towers(&mut world, random, 16, [0.03, 0.5]),
            Self::Barrels => towers(&mut world, random, 8, [0.4, 0.3]),
            Self::TallBarrels => towers(&mut world, random, 8, [0.75, 0.25]),
            Self::Roll | Self::LongRoll => {
                containers::floor(&mut world, 60.0);
                wheel(&mut world, GAP);
            }
            Self::MeshRoll => {
                mesh(&mut world, |_| 0.0);
                wheel(&mut world, GAP);
            }
            Self::Waves => {
                mesh(&mut world, |x| 0.1 * (0.5 * PI * x).cos());
                wheel(&mut world, 0.1 + GAP);
            }
            Self::ThinFloor => thin_floor(&mut world),
            Self::Heap => heap(&mut world, random, 300),
        }
        world
    }
}

fn insert(world: &mut World, shape: SharedShape, pose: Pose) -> (RigidBodyHandle, ColliderHandle) {
    let body = RigidBodyBuilder::dynamic().pose(pose);
    world.physics.insert(body, ColliderBuilder::new(shape))
}

/// From `-limit` to `limit`.
fn within(random: &mut Rand32, limit: Real) -> Real {
    limit * (2.0 * random.rand_float() - 1.0)
}

/// A pyramid of logs along z.
fn logs(world: &mut World, log: &SharedShape) {
    const ROWS: usize = 5;
    let radius = log.compute_local_aabb().half_extents().x;
    containers::floor(world, 10.0);
    let post = Vector::new(0.1, 0.8 * radius, 0.1);
    for (x, z) in [(-1.0, -0.7), (-1.0, 0.7), (1.0, -0.7), (1.0, 0.7)] {
        let away = ROWS as Real * radius + post.x + GAP;
        let post = ColliderBuilder::cuboid(post.x, post.y, post.z);
        let place = Vector::new(x * away, 0.8 * radius, z);
        world.physics.insert_collider(post.translation(place), None);
    }
    let lying = Rotation::from_rotation_x(FRAC_PI_2);
    for row in 0..ROWS {
        for i in 0..ROWS - row {
            let x = (2 * i + row) as Real - (ROWS - 1) as Real;
            let y = 1.0 + row as Real * Real::sqrt(3.0);
            let place = Vector::new(x, y, 0.0) * (radius + 0.5 * GAP);
            insert(world, log.clone(), Pose::from_parts(place, lying));
        }
    }
}

fn cones(world: &mut World, random: &mut Rand32) {
    let (half_height, radius) = (0.25, 0.25);
    containers::floor(world, 10.0);
    for i in 0..16 {
        let (x, z) = square_cell(i, 4, 1.5);
        // The slant down.
        let tilt = Real::atan2(radius, 2.0 * half_height);
        let lying = Rotation::from_rotation_z(-FRAC_PI_2 - tilt);
        let turn = Rotation::from_rotation_y(within(random, PI)) * lying;
        let height = half_height * tilt.sin() + 0.1;
        insert(
            world,
            SharedShape::cone(half_height, radius),
            Pose::from_parts(Vector::new(x, height, z), turn),
        );
    }
}

/// Sixteen towers of cylinders.
fn towers(world: &mut World, random: &mut Rand32, high: usize, [half_height, radius]: [Real; 2]) {
    containers::floor(world, 20.0);
    for tower in 0..16 {
        let (x, z) = square_cell(tower, 4, 4.0 * radius);
        for i in 0..high {
            let shake = 0.02 * radius;
            let (x, z) = (x + within(random, shake), z + within(random, shake));
            let y = half_height + GAP + (2.0 * half_height + GAP) * i as Real;
            let turn = Rotation::from_rotation_y(within(random, PI));
            let pose = Pose::from_parts(Vector::new(x, y, z), turn);
            insert(world, SharedShape::cylinder(half_height, radius), pose);
        }
    }
}

/// A wheel above the origin that rolls along x.
fn wheel(world: &mut World, height: Real) {
    let lying = Rotation::from_rotation_x(FRAC_PI_2);
    let place = Vector::Y * (height + WHEEL_RADIUS);
    let wheel = SharedShape::cylinder(0.25, WHEEL_RADIUS);
    let (body, _) = insert(world, wheel, Pose::from_parts(place, lying));
    let body = &mut world.physics.bodies[body];
    body.set_linvel(Vector::X * ROLL, true);
    body.set_angvel(Vector::Z * (-ROLL / WHEEL_RADIUS), true);
}

/// A strip along x, whose inner edges are no obstacles.
fn mesh(world: &mut World, height: impl Fn(Real) -> Real) {
    const CELL: Real = 0.25;
    let columns = 160_u32;
    let x = |column: u32| CELL * (column as Real - 16.0);
    let points =
        (0..=columns).flat_map(|i| [-1.0, 0.0, 1.0].map(|z| Vector::new(x(i), height(x(i)), z)));
    let mut triangles = Vec::new();
    for i in 0..columns {
        for k in 0..2 {
            let corner = 3 * i + k;
            triangles.push([corner, corner + 1, corner + 3]);
            triangles.push([corner + 1, corner + 4, corner + 3]);
        }
    }
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    let mesh = ColliderBuilder::trimesh_with_flags(points.collect(), triangles, flags);
    let mesh = mesh.expect("a strip is a mesh");
    world.physics.insert_collider(mesh, None);
}

/// Down which bodies slide along x.
fn thin_floor(world: &mut World) {
    let half = Vector::new(20.0, 0.01, 5.0);
    let lean = Rotation::from_rotation_z(-LEAN_SINE.asin());
    let slippery = |shape: SharedShape| {
        ColliderBuilder::new(shape)
            .friction(0.0)
            .friction_combine_rule(CoefficientCombineRule::Min)
    };
    let floor =
        slippery(SharedShape::cuboid(half.x, half.y, half.z)).rotation(lean.to_scaled_axis());
    world.physics.insert_collider(floor, None);
    let shapes = [
        SharedShape::cylinder(0.25, 0.25),
        SharedShape::cylinder(0.05, 0.3),
        SharedShape::cone(0.25, 0.25),
        SharedShape::cone(0.1, 0.3),
    ];
    for i in 0..8 {
        let shape = shapes[i % shapes.len()].clone();
        let height = half.y + shape.compute_local_aabb().half_extents().y + GAP;
        let place = lean * Vector::new(-15.0, height, i as Real - 3.5);
        let body = RigidBodyBuilder::dynamic().pose(Pose::from_parts(place, lean));
        world.physics.insert(body, slippery(shape));
    }
}

fn heap(world: &mut World, random: &mut Rand32, bodies: usize) {
    let side = 6;
    let spacing = 1.2;
    let half_width = 0.5 * spacing * side as Real;
    containers::floor(world, half_width + 1.0);
    let layers = bodies.div_ceil(side * side) as Real;
    containers::walls(world, half_width, spacing * layers);
    for i in 0..bodies {
        let mut size = || 0.15 + 0.2 * random.rand_float();
        let (half_height, radius) = (size(), size());
        let shape = if i % 2 == 0 {
            SharedShape::cylinder(half_height, radius)
        } else {
            SharedShape::cone(half_height, radius)
        };
        let (x, z) = square_cell(i % (side * side), side, spacing);
        let y = spacing * ((i / (side * side)) as Real + 0.5);
        let turn = [0; 3].map(|_| within(random, 2.0));
        let shake = [0; 2].map(|_| within(random, 0.05));
        let place = Vector::new(x + shake[0], y, z + shake[1]);
        insert(world, shape, Pose::new(place, turn.into()));
    }
}
