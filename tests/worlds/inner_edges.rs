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

fn manifolds(mesh: &SharedShape, mover: &SharedShape, pose: Pose) -> Vec<Manifold> {
    let mut manifolds: Vec<Manifold> = Vec::new();
    IsaGjkDispatcher::default()
        .update_manifolds(&pose, [&**mesh, &**mover], 0.002, &mut manifolds, &mut None)
        .expect("supported");
    manifolds
}

/// The depth of the deepest contact of a mesh and a hull whose normal is upwards.
fn depth_upwards(mesh: &SharedShape, hull: &SharedShape, pose: Pose) -> Option<Real> {
    let manifolds = manifolds(mesh, hull, pose);
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

/// The lowest line is beyond the border, so nothing is over a triangle along the mesh's normal.
#[test]
fn what_rolls_over_the_border_of_a_mesh_is_not_lost() {
    let mesh = flat_mesh(Vector::new(-1.0, 0.0, -1.0), 2.0, 8);
    let lying = Rotation::from_rotation_x(0.5 * PI);
    let cylinder = SharedShape::cylinder(0.1, 0.3);
    for (mover, turn) in [(cylinder, lying), (wheel(64, 0.3, 0.1), Rotation::IDENTITY)] {
        let height = Real::sqrt(0.3 * 0.3 - 0.1 * 0.1) - 2e-3;
        let place = Vector::new(1.1, height, 0.013);
        let manifolds = manifolds(&mesh, &mover, Pose::from_parts(place, turn));
        let points = manifolds.iter().flat_map(|manifold| &manifold.points);
        let depth = points.map(|point| -point.dist).fold(0.0, Real::max);
        assert!(
            (1e-3..2e-3).contains(&depth),
            "{:?}: {depth}",
            mover.shape_type()
        );
    }
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
    start: (Vector, Real, Real),
    friction: Real,
    steps: usize,
) -> Ride {
    ride_turned(ground, (mover, Vector::ZERO), start, friction, steps)
}

/// The same for a body whose shape is turned in it.
fn ride_turned(
    ground: &SharedShape,
    (mover, turn): (&SharedShape, Vector),
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
    let (body, _) = world.insert(body, collider(mover).rotation(turn));
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

/// A triangle beside the lowest line is nearest to the side of the cylinder, and all corners of a triangle are as
/// low as each other.
#[test]
fn round_bodies_roll_over_a_fine_mesh_as_over_a_floor() {
    let fine = flat_mesh(Vector::new(-1.0, 0.0, -1.5), 6.0, 30);
    let lying = Vector::X * (0.5 * PI);
    for (wheel, least) in [
        (SharedShape::cylinder(0.1, 0.3), 0.97),
        (SharedShape::capsule_y(0.1, 0.3), 0.99),
    ] {
        let kind = wheel.shape_type();
        for place in [0.0, 0.05, 0.13] {
            let start = (Vector::new(place, 0.3, 0.013), 2.0, -2.0 / 0.3);
            let Ride {
                hop, left, aside, ..
            } = ride_turned(&fine, (&wheel, lying), start, 0.8, 120);
            assert!(hop < 2e-3, "{kind:?} from {place}: hop {hop}");
            assert!(left > least, "{kind:?} from {place}: speed {left}");
            assert!(aside < 0.1, "{kind:?} from {place}: aside {aside}");
        }
    }
}

/// Boxes on both sides of a convex crease, which overlap beneath it. The side of the first one on the slope leans.
#[test]
fn a_crease_between_overlapping_parts_does_not_stop_what_slides() {
    let slope = Rotation::from_rotation_z(-PI / 6.0);
    let part = |x: Real, turn: Rotation| {
        let centre = turn * Vector::new(x + 0.25, -0.5, 0.0);
        (
            Pose::from_parts(centre, turn),
            SharedShape::cuboid(0.25, 0.5, 0.5),
        )
    };
    let before = (-4..0).map(|i| part(0.5 * i as Real, Rotation::IDENTITY));
    let after = (0..8).map(|i| part(0.5 * i as Real, slope));
    let flags = CompoundFlags::FIX_INTERNAL_EDGES;
    let ground = SharedShape::new(Compound::with_flags(
        before.chain(after).collect(),
        flags,
        None,
    ));
    let half = Vector::new(0.2, 0.1, 0.15);
    for (name, mover, height) in [
        ("cuboid hull", cuboid_hull(half), half.y),
        ("cylinder", SharedShape::cylinder(0.1, 0.15), 0.1),
        ("cone", SharedShape::cone(0.2, 0.15), 0.2),
    ] {
        for i in 0..8 {
            let start = Vector::new(-1.0 - 0.0137 * i as Real, height, 0.013);
            let over = ride(&ground, &mover, (start, 2.0, 0.0), 0.05, 60);
            assert!(over.left > 1.0, "{name} {i}: speed {}", over.left);
            assert!(over.aside < 0.05, "{name} {i}: aside {}", over.aside);
        }
    }
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
            let cylinder = SharedShape::cylinder(half.y, half.x);
            for (i, mover) in
                (-3i8..=3).flat_map(|i| [(i, cuboid_hull(half)), (i, cylinder.clone())])
            {
                let x = 2.5 + half.x * Real::from(i) * 0.32;
                let start = Vector::new(x, 0.45 + half.y, 0.013);
                let pressed = ride(&ground, &mover, (start, 0.0, 0.0), 0.5, 60);
                let what = format!("{:?} of {half} at {x} on {name}", mover.shape_type());
                assert!((pressed.hop - 0.05).abs() < 0.01, "{what}: {}", pressed.hop);
                assert!(pressed.moved < 0.01, "{what}: {}", pressed.moved);
            }
        }
    }
}

/// Its way out is longer than the slab is thick, but does not lead through it.
#[test]
fn what_is_pressed_in_deeper_than_a_slab_comes_out_where_it_is() {
    let slab = |x: Real| block(Vector::new(x, 0.46, -2.0), Vector::new(x + 2.5, 0.5, 2.0));
    let flags = CompoundFlags::FIX_INTERNAL_EDGES;
    let ground = SharedShape::new(Compound::with_flags(
        vec![slab(0.0), slab(2.5)],
        flags,
        None,
    ));
    let half = Vector::splat(0.1);
    for mover in [cuboid_hull(half), SharedShape::cylinder(half.y, half.x)] {
        for i in -3i8..=3 {
            let start = Vector::new(2.5 + 0.032 * Real::from(i), 0.45 + half.y, 0.013);
            let pressed = ride(&ground, &mover, (start, 0.0, 0.0), 0.5, 60);
            let what = format!("{:?} at {}", mover.shape_type(), start.x);
            assert!((pressed.hop - 0.05).abs() < 0.01, "{what}: {}", pressed.hop);
            assert!(pressed.moved < 0.01, "{what}: {}", pressed.moved);
        }
    }
}

/// A ring about y, taken apart into wedges.
fn ring(wedges: usize, [inner, outer]: [Real; 2], half_height: Real) -> SharedShape {
    let wedge = |i: usize| {
        let corner = |i: usize| {
            let (sin, cos) = (TAU * i as Real / wedges as Real).sin_cos();
            let at = move |r: Real, y: Real| Vector::new(r * cos, y, r * sin);
            [inner, outer].map(|r| [at(r, -half_height), at(r, half_height)])
        };
        let corners: Vec<Vector> = [i, i + 1].into_iter().flat_map(corner).flatten().collect();
        let wedge = SharedShape::convex_hull(&corners).expect("a wedge");
        (Pose::IDENTITY, wedge)
    };
    let parts = (0..wedges).map(wedge).collect();
    let flags = CompoundFlags::FIX_INTERNAL_EDGES;
    SharedShape::new(Compound::with_flags(parts, flags, None))
}

/// The way from a rod out of a wedge that is the least may lead through the wedge.
#[test]
fn beads_stay_on_a_rod() {
    for wedges in [8, 16] {
        let bead = ring(wedges, [0.04, 0.08], 0.02);
        let mut world = PhysicsWorld {
            narrow_phase: ours(),
            ..PhysicsWorld::default()
        };
        let tilt = Vector::Z * 1.2;
        let axis = Rotation::from_scaled_axis(tilt) * Vector::Y;
        let rod = ColliderBuilder::cylinder(1.0, 0.03).rotation(tilt);
        world.insert_collider(rod.friction(0.2), None);
        let mut bodies = Vec::new();
        for i in 0..4 {
            let place = axis * (0.8 - 0.12 * i as Real);
            let body = RigidBodyBuilder::dynamic().translation(place);
            let body = body.rotation(tilt + Vector::new(0.02, 0.0, 0.03 * i as Real));
            let collider = ColliderBuilder::new(bead.clone()).friction(0.2);
            bodies.push(world.insert(body, collider).0);
        }
        for step in 0..60 {
            world.step();
            for body in &bodies {
                let place = world.bodies[*body].translation();
                let aside = place.reject_from_normalized(axis).length();
                let is_beside = place.dot(axis) > -0.95;
                assert!(!is_beside || aside < 0.03, "{wedges}, {step}: {aside}");
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
        (SharedShape::cylinder(0.1, 0.15), Vector::splat(0.1)),
        (SharedShape::cone(0.1, 0.15), Vector::splat(0.1)),
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
