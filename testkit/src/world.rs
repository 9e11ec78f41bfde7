//! Worlds in which every way of meeting a hull happens.

use isa_gjk::IsaGjkDispatcher;
use parry3d::utils::Array2;
use rapier3d::prelude::*;

use super::generate::{Rng, prepared};

/// What the bodies fall on.
#[derive(Clone, Copy, Debug)]
pub enum Ground {
    /// A hull.
    Slab,
    Mesh,
    HeightField,
    Voxels,
}

impl Ground {
    pub const ALL: [Self; 4] = [Self::Slab, Self::Mesh, Self::HeightField, Self::Voxels];

    /// About 12 m wide, at a height around zero.
    fn shape(self) -> SharedShape {
        const CELLS: usize = 8;
        let bumps = |i: usize| 0.2 * (i as Real * 1.3).sin();
        let heights: Vec<Real> = (0..(CELLS + 1) * (CELLS + 1)).map(bumps).collect();
        let field = Array2::new(CELLS + 1, CELLS + 1, heights);
        let size = Vector::new(12.0, 1.0, 12.0);
        match self {
            Self::Slab => {
                let corner = |i: u32| {
                    let side = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
                    Vector::new(6.0 * side(0), 0.5 * side(1) - 0.5, 6.0 * side(2))
                };
                let corners: Vec<Vector> = (0..8).map(corner).collect();
                SharedShape::convex_hull(&corners).expect("a slab")
            }
            Self::Mesh => {
                let (points, triangles) =
                    parry3d::shape::HeightField::new(field, size).to_trimesh();
                let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
                SharedShape::trimesh_with_flags(points, triangles, flags).expect("a mesh")
            }
            Self::HeightField => SharedShape::heightfield(field, size),
            Self::Voxels => {
                let cells = (-6..6).flat_map(|x| (-6..6).map(move |z| IVector::new(x, -1, z)));
                SharedShape::voxels(Vector::ONE, &cells.collect::<Vec<_>>())
            }
        }
    }
}

/// Plain hulls, compounds of hulls, prepared hulls, rounded hulls, and shapes without any.
pub fn shapes(rng: &mut Rng) -> Vec<SharedShape> {
    let [small, medium, large] = [8, 24, 80].map(|corners| rng.hull(corners, 0.8).shape);
    let polyhedron = medium.as_convex_polyhedron().expect("a hull");
    let aside = |x: Real| Pose::translation(x, 0.0, 0.1 * x);
    let ends = vec![(aside(-0.3), small.clone()), (aside(0.3), large.clone())];
    let round = SharedShape::round_convex_hull(polyhedron.points(), 0.05).expect("a solid");
    vec![
        small,
        SharedShape::compound(ends),
        large,
        SharedShape::cuboid(0.3, 0.25, 0.35),
        prepared(&medium),
        round,
        SharedShape::ball(0.35),
    ]
}

/// `count` bodies above the ground, in a pen.
pub fn mixed(ground: Ground, count: usize, narrow_phase: NarrowPhase) -> PhysicsWorld {
    let mut world = PhysicsWorld {
        narrow_phase,
        ..PhysicsWorld::default()
    };
    world.insert_collider(ColliderBuilder::new(ground.shape()), None);
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let half = Vector::new(0.5 + 3.0 * f32::abs(z), 6.0, 0.5 + 3.0 * f32::abs(x));
        let wall = ColliderBuilder::cuboid(half.x, half.y, half.z);
        world.insert_collider(wall.translation(Vector::new(3.0 * x, 4.0, 3.0 * z)), None);
    }
    let mut rng = Rng::new(61);
    let mut shapes = shapes(&mut rng);
    if matches!(ground, Ground::Voxels) {
        // With rapier's own dispatcher a ball on voxels fails an assertion in the solver graph: the
        // pair has many manifolds, but no workspace by which rapier could tell.
        shapes.retain(|shape| shape.shape_type() != ShapeType::Ball);
    }
    for i in 0..count {
        let shape = shapes[i % shapes.len()].clone();
        let body = RigidBodyBuilder::dynamic().pose(start(i, &mut rng));
        world.insert(body, ColliderBuilder::new(shape));
    }
    world
}

/// Places in layers of nine, turned at random.
pub fn start(i: usize, rng: &mut Rng) -> Pose {
    let cell = Vector::new(
        (i % 3) as Real - 1.0,
        0.8 + (i / 9) as Real,
        (i / 3 % 3) as Real - 1.0,
    );
    Pose::new(cell * 1.2, rng.direction().as_vec3())
}

/// A narrow phase with a dispatcher of ours. The update of its manifolds is compiled here, and not in each program.
pub fn narrow_phase(dispatcher: &IsaGjkDispatcher) -> NarrowPhase {
    NarrowPhase::with_query_dispatcher(dispatcher.clone())
}

/// A narrow phase with our dispatcher.
pub fn ours() -> NarrowPhase {
    narrow_phase(&IsaGjkDispatcher::default())
}

/// The bits of all poses and velocities.
pub fn state(world: &PhysicsWorld) -> Vec<u32> {
    let bodies = world.bodies.iter().map(|(_, body)| body);
    let numbers = bodies.flat_map(|body| {
        let place = body.translation().to_array();
        let vectors = [body.linvel().to_array(), body.angvel().to_array()];
        let turn = body.rotation().to_array();
        place
            .into_iter()
            .chain(turn)
            .chain(vectors.into_iter().flatten())
    });
    numbers.map(f32::to_bits).collect()
}

/// The deepest overlap of any pair, by a new query.
pub fn deepest(world: &PhysicsWorld) -> Real {
    use parry3d::query::QueryDispatcher;
    let depths = world.narrow_phase.contact_pairs().map(|pair| {
        let [a, b] = [pair.collider1, pair.collider2].map(|handle| &world.colliders[handle]);
        let pos12 = a.position().inv_mul(b.position());
        let contact = IsaGjkDispatcher::default().contact(&pos12, a.shape(), b.shape(), 0.0);
        contact.ok().flatten().map_or(0.0, |contact| -contact.dist)
    });
    depths.fold(0.0, Real::max)
}

/// That everything is somewhere in the pen.
pub fn check_places(world: &PhysicsWorld, what: &str) {
    for (_, body) in world.bodies.iter() {
        let place = body.translation();
        let inside = place.x.abs().max(place.z.abs()) < 3.0 && place.y > -0.3;
        assert!(place.is_finite() && inside, "{what}: a body at {place}");
    }
}
