//! Hulls on meshes and compounds whose inner edges are corrected: nothing that has sunk in is lost, and
//! cuts through a flat floor do not matter to what slides or rolls over them.

use std::f32::consts::{PI, TAU};

use isa_gjk::PreparedShapes;
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::shape::{Compound, CompoundFlags};
use rapier3d::prelude::*;
use testkit::memory::{Manifold, UpdateManifolds};
use testkit::world::ours;

/// A flat square in y = 0 of `cells` by `cells` squares of two triangles each.
fn flat_mesh(corner: Vector, side: Real, cells: u32) -> SharedShape {
    let row = cells + 1;
    let point = |i: u32| {
        let place = Vector::new((i % row) as Real, 0.0, (i / row) as Real);
        corner + place * (side / cells as Real)
    };
    let cell = |i: u32| {
        let a = i / cells * row + i % cells;
        [[a, a + row, a + 1], [a + 1, a + row, a + row + 1]]
    };
    let points = (0..row * row).map(point).collect();
    let triangles = (0..cells * cells).flat_map(cell).collect();
    SharedShape::trimesh_with_flags(points, triangles, TriMeshFlags::FIX_INTERNAL_EDGES)
        .expect("a mesh")
}

fn cuboid_hull(half: Vector) -> SharedShape {
    let side = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i: u32| half * Vector::new(side(i, 0), side(i, 1), side(i, 2));
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    SharedShape::convex_hull(&corners).expect("a cuboid")
}

/// A wheel that rolls along x, on one of its sides.
fn wheel(sides: usize, radius: Real, half_width: Real) -> SharedShape {
    let corner = |i: usize| {
        let (sin, cos) = (TAU * (i as Real + 0.5) / sides as Real - 0.5 * PI).sin_cos();
        [-half_width, half_width].map(|z| Vector::new(radius * cos, radius * sin, z))
    };
    let corners: Vec<Vector> = (0..sides).flat_map(corner).collect();
    SharedShape::convex_hull(&corners).expect("a prism")
}

/// The depth of the deepest contact of a mesh and a hull whose normal is upwards.
fn depth_upwards(mesh: &SharedShape, hull: &SharedShape, pose: Pose) -> Option<Real> {
    let mut manifolds: Vec<Manifold> = Vec::new();
    IsaGjkDispatcher::default()
        .update_manifolds(&pose, [&**mesh, &**hull], 0.002, &mut manifolds, &mut None)
        .expect("supported");
    let upwards = manifolds.iter().filter(|m| m.local_n1.y > 0.999);
    let depths = upwards.flat_map(|m| m.points.iter().map(|point| -point.dist));
    depths.reduce(Real::max)
}

/// The least depth of each triangle is sideways, and the side of the plate is edge-on to the floor.
#[test]
fn a_plate_that_has_sunk_into_a_mesh_is_pushed_out() {
    let mesh = flat_mesh(Vector::new(-1.0, 0.0, -1.0), 2.0, 8);
    let plate = cuboid_hull(Vector::new(0.25, 0.25, 0.03125));
    let standing = Pose::from_parts(
        Vector::new(0.157_631_56, 0.125, -0.629_118_7),
        Rotation::from_xyzw(0.0, 0.149_438_14, 0.0, 0.988_771_1),
    );
    let depth = depth_upwards(&mesh, &plate, standing).expect("contacts");
    assert!((depth - 0.125).abs() < 1e-5, "{depth}");

    let mesh = flat_mesh(Vector::ZERO, 0.125, 1);
    let plate = cuboid_hull(Vector::new(0.25, 0.25, 0.0625));
    let standing = Pose::translation(-0.0215, 0.156_25, -0.0473);
    let depth = depth_upwards(&mesh, &plate, standing).expect("contacts");
    assert!((depth - 0.093_75).abs() < 1e-5, "{depth}");
}

struct Ride {
    hop: Real,
    /// The share of the speed that is left.
    left: Real,
    aside: Real,
    /// Along both horizontal axes.
    moved: Real,
}

/// How a body fares that starts with `speed` along x, rolling by `spin`.
fn ride(
    ground: &SharedShape,
    mover: &SharedShape,
    (start, speed, spin): (Vector, Real, Real),
    friction: Real,
    steps: usize,
) -> Ride {
    let mut world = PhysicsWorld {
        narrow_phase: ours(),
        ..PhysicsWorld::default()
    };
    let collider = |shape: &SharedShape| ColliderBuilder::new(shape.clone()).friction(friction);
    world.insert_collider(collider(ground), None);
    let body = RigidBodyBuilder::dynamic()
        .translation(start)
        .linvel(Vector::new(speed, 0.0, 0.0))
        .angvel(Vector::new(0.0, 0.0, spin))
        .can_sleep(false);
    let (body, _) = world.insert(body, collider(mover));
    let mut hop: Real = 0.0;
    for _ in 0..steps {
        world.step();
        hop = hop.max(world.bodies[body].translation().y - start.y);
    }
    let body = &world.bodies[body];
    let way = body.translation() - start;
    Ride {
        moved: way.x.hypot(way.z),
        hop,
        left: body.linvel().x / speed,
        aside: (body.translation().z - start.z).abs(),
    }
}

#[test]
fn a_wheel_rolls_over_a_fine_mesh_as_over_a_floor() {
    let fine = flat_mesh(Vector::new(-1.0, 0.0, -1.5), 6.0, 20);
    let whole = flat_mesh(Vector::new(-1.0, 0.0, -1.5), 6.0, 1);
    let (sides, radius) = (64, 0.3);
    let wheel = wheel(sides, radius, 0.1);
    let height = radius * (PI / sides as Real).cos();
    let mut means = [[0.0; 3]; 2];
    let speeds = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0];
    for speed in speeds {
        let start = (Vector::new(0.0, height, 0.013), speed, -speed / radius);
        let steps = (180.0 / speed) as usize;
        for (mean, ground) in means.iter_mut().zip([&fine, &whole]) {
            let Ride {
                hop, left, aside, ..
            } = ride(ground, &wheel, start, 0.8, steps);
            for (mean, value) in mean.iter_mut().zip([hop, left, aside]) {
                *mean += value / speeds.len() as Real;
            }
        }
    }
    let [[hop, left, aside], [floor_hop, floor_left, _]] = means;
    assert!(hop < floor_hop + 0.003, "hop {hop}, on a floor {floor_hop}");
    assert!(
        left > floor_left - 0.03,
        "speed {left}, on a floor {floor_left}"
    );
    assert!(aside < 0.02, "aside {aside}");
}

#[test]
fn seams_of_a_compound_do_not_stop_what_slides() {
    let cube = cuboid_hull(Vector::splat(0.5));
    let at = |i: usize| Pose::translation(i as Real, 0.0, 0.0);
    let row = |part: &SharedShape| {
        let parts = (0..10).map(|i| (at(i), part.clone())).collect();
        let flags = CompoundFlags::FIX_INTERNAL_EDGES;
        SharedShape::new(Compound::with_flags(parts, flags, None))
    };
    let plain = cube.as_convex_polyhedron().expect("a hull").clone();
    let prepared = SharedShape::new(HullShape::try_from(plain).expect("a solid"));
    slide_over(&row(&cube));
    slide_over(&row(&prepared));
    slide_over(&PreparedShapes::default().prepare(&row(&prepared)));
}

fn block(low: Vector, high: Vector) -> (Pose, SharedShape) {
    let centre = Pose::from_translation((low + high) * 0.5);
    (centre, cuboid_hull((high - low) * 0.5))
}

/// Parts that parry's pseudo-normals know no seams between: none of their faces are equal.
fn decomposed() -> [(&'static str, SharedShape); 4] {
    let row = |overlap: Real| {
        let part = |i: usize| {
            let x = i as Real - 0.5;
            let low = Vector::new(x - overlap, -0.5, -0.5);
            block(low, Vector::new(x + 1.0 + overlap, 0.5, 0.5))
        };
        (0..10).map(part).collect()
    };
    let part = |i: usize| {
        let x = i as Real - 0.5;
        let [depth, middle] = [[0.2, 0.1], [0.5, -0.1]][i % 2];
        [[-0.5, middle], [middle, 0.5]]
            .map(|[z1, z2]| block(Vector::new(x, -depth, z1), Vector::new(x + 1.0, 0.5, z2)))
    };
    let flags = CompoundFlags::FIX_INTERNAL_EDGES;
    [
        ("gaps", row(-2e-4)),
        ("overlaps of a millimetre", row(5e-4)),
        ("overlaps of two centimetres", row(0.01)),
        ("joints like a T", (0..10).flat_map(part).collect()),
    ]
    .map(|(name, parts)| {
        (
            name,
            SharedShape::new(Compound::with_flags(parts, flags, None)),
        )
    })
}

#[test]
fn parts_that_overlap_a_little_do_not_stop_what_slides() {
    for (_, ground) in decomposed() {
        slide_over(&ground);
    }
}

/// Out of the whole, and not from part to part.
#[test]
fn what_is_pressed_in_over_a_seam_comes_out_where_it_is() {
    for (name, ground) in decomposed() {
        for half in [[0.3, 0.02, 0.3], [0.5, 0.03, 0.03], [0.1, 0.1, 0.1]].map(Vector::from) {
            for i in -3i8..=3 {
                let x = 2.5 + half.x * Real::from(i) * 0.32;
                let start = Vector::new(x, 0.45 + half.y, 0.013);
                let pressed = ride(&ground, &cuboid_hull(half), (start, 0.0, 0.0), 0.5, 60);
                let what = format!("{half} at {x} on {name}");
                assert!((pressed.hop - 0.05).abs() < 0.01, "{what}: {}", pressed.hop);
                assert!(pressed.moved < 0.01, "{what}: {}", pressed.moved);
            }
        }
    }
}

/// Slides shapes over a row of cubes whose seams must not stop them.
fn slide_over(row: &SharedShape) {
    let hull = |half| (cuboid_hull(half), half);
    for (mover, half) in [
        hull(Vector::splat(0.1)),
        hull(Vector::new(0.15, 0.025, 0.1)),
        (SharedShape::ball(0.1), Vector::splat(0.1)),
        (SharedShape::capsule_x(0.1, 0.1), Vector::splat(0.1)),
    ] {
        for i in 0..20 {
            let x = 0.2 + 0.0137 * i as Real;
            for speed in [3.0, 5.0] {
                let start = (Vector::new(x, 0.5 + half.y, 0.013), speed, 0.0);
                let Ride {
                    hop, left, aside, ..
                } = ride(row, &mover, start, 0.0, 90);
                let what = format!("{:?} of {half} at {x}, {speed} m/s", mover.shape_type());
                assert!(hop < 1e-3, "{what}: hop {hop}");
                assert!(left > 0.98, "{what}: speed left {left}");
                assert!(aside < 1e-3, "{what}: aside {aside}");
            }
        }
    }
}
