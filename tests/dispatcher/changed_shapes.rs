//! Shapes come and go, are mutated in place, and are given the addresses of shapes that died: no
//! answer may come from the dead.

use std::thread;

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::shape::{ConvexPolyhedron, SharedShape};
use testkit::cases::Hull;
use testkit::generate::{Rng, hull_of, prepared};
use testkit::memory::{Manifold, Memory, cold_manifold};
use testkit::report::Report;
use testkit::scene::random_scene;

/// Small and large hulls are known again in different ways.
const SIZES: [usize; 2] = [30, 200];

/// New hulls with the same number of corners, so that the allocator hands out old addresses.
#[test]
fn replaced_shapes_are_answered_as_they_are() {
    SIZES.into_iter().for_each(check_replaced_shapes);
}

fn check_replaced_shapes(corners: usize) {
    let mut report = Report::new(format!("replaced shapes of {corners} corners"));
    let mut rng = Rng::new(6);
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let mut addresses = Vec::new();
    for turn in 0..200 {
        let [a, b] = [(); 2].map(|()| rng.hull(corners, 1.0));
        addresses.push(std::ptr::from_ref(&*a.shape).addr());
        let scene = random_scene(&mut rng, &a, &b, 0.9);
        let id = format!("turn {turn}");
        let manifold = scene.update(&dispatcher, &mut memory);
        report.add("manifold", &id, scene.judge(manifold));
        report.add("stateless", &id, scene.judge_stateless(&dispatcher));
        memory.workspace = None;
    }
    report.conclude();
    let turns = addresses.len();
    addresses.sort_unstable();
    addresses.dedup();
    assert!(addresses.len() < turns, "the allocator reused no address");
}

/// Changes the polyhedron inside `shape` where it lies.
fn mutate(shape: &mut SharedShape, change: impl FnOnce(&mut ConvexPolyhedron)) {
    let before = std::ptr::from_ref(&**shape).addr();
    let polyhedron = shape
        .make_mut()
        .as_convex_polyhedron_mut()
        .expect("a convex polyhedron");
    change(polyhedron);
    let after = std::ptr::from_ref(&**shape).addr();
    assert_eq!(before, after, "the shape did not stay in place");
}

/// A hull put in the place of another.
fn replace_in_place(hull: &mut Hull, other: Hull) {
    let new = other
        .shape
        .as_convex_polyhedron()
        .expect("a convex polyhedron")
        .clone();
    mutate(&mut hull.shape, |polyhedron| *polyhedron = new);
    hull.solid = other.solid;
}

/// A hull scaled without moving even its list of points.
fn scale_in_place(hull: &mut Hull, scale: Vector) {
    let stand_in = hull_of(&[Vector::ZERO, Vector::X, Vector::Y, Vector::Z]);
    let stand_in = stand_in
        .expect("a tetrahedron is convex")
        .shape
        .as_convex_polyhedron()
        .expect("a convex polyhedron")
        .clone();
    let mut points = Vec::new();
    mutate(&mut hull.shape, |polyhedron| {
        let scaled = std::mem::replace(polyhedron, stand_in)
            .scaled(scale)
            .expect("a scaled hull");
        points = scaled.points().to_vec();
        *polyhedron = scaled;
    });
    hull.solid = hull.solid.with_points(points.iter().map(|p| p.as_dvec3()));
}

#[test]
fn shapes_mutated_in_place_are_answered_as_they_are() {
    SIZES.into_iter().for_each(check_shapes_mutated_in_place);
}

fn check_shapes_mutated_in_place(corners: usize) {
    let mut report = Report::new(format!("shapes of {corners} corners mutated in place"));
    let mut rng = Rng::new(7);
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let [mut a, b] = [(); 2].map(|()| rng.hull(corners, 1.0));
    for turn in 0..150 {
        let route = if turn % 3 == 0 {
            replace_in_place(&mut a, rng.hull(corners, 1.0));
            "replaced"
        } else {
            let scale = Vector::splat(if turn % 3 == 1 { 1.5 } else { 0.5 });
            scale_in_place(&mut a, scale * Vector::new(1.0, 0.9, 1.1));
            "scaled"
        };
        let reach = 0.5 * (a.solid.diameter() + b.solid.diameter());
        let scene = random_scene(&mut rng, &a, &b, reach);
        let id = format!("turn {turn}");
        let manifold = scene.update(&dispatcher, &mut memory);
        report.add(&format!("{route}, manifold"), &id, scene.judge(manifold));
        report.add(
            &format!("{route}, stateless"),
            &id,
            scene.judge_stateless(&dispatcher),
        );
        memory.workspace = None;
    }
    report.conclude();
}

/// A square pyramid, over either diagonal of its base, with its points in this list.
fn pyramid(mut points: Vec<Vector>, other_diagonal: bool) -> SharedShape {
    let base = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    points.extend(base.map(|[x, z]| Vector::new(x, 0.0, z)));
    points.push(Vector::new(0.0, 1.0, 0.0));
    let mut triangles = vec![[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]];
    triangles.extend(if other_diagonal {
        [[0, 1, 3], [1, 2, 3]]
    } else {
        [[0, 1, 2], [0, 2, 3]]
    });
    SharedShape::convex_mesh(points, &triangles).expect("parry takes it")
}

/// The names of features, and with them the order of points, may depend on the edges.
#[test]
fn the_same_points_with_other_edges_are_another_shape() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(8);
    let cuboid = SharedShape::cuboid(0.7, 0.2, 0.7);
    let mut shape = pyramid(Vec::with_capacity(5), false);
    let (mut came_again, mut in_contact) = (0, 0);
    for turn in 0..60 {
        let address = |shape: &SharedShape| {
            let polyhedron = shape.as_convex_polyhedron().expect("a polyhedron");
            polyhedron.points().as_ptr().addr()
        };
        let before = address(&shape);
        drop(shape);
        let mut lists: Vec<Vec<Vector>> = (0..20).map(|_| Vec::with_capacity(5)).collect();
        let again = lists.iter().position(|list| list.as_ptr().addr() == before);
        let points = lists.swap_remove(again.unwrap_or(0));
        shape = pyramid(points, turn % 2 == 0);
        came_again += usize::from(address(&shape) == before);
        let mut small = || rng.range(-0.1, 0.1) as f32;
        let turned = Vector::new(small(), 0.3 + small(), small());
        let pose = Pose::new(Vector::new(small(), -0.19 + 0.1 * small(), small()), turned);
        let manifold = || {
            let dispatcher = IsaGjkDispatcher::default();
            format!(
                "{:?}",
                cold_manifold(&dispatcher, &pose, [&shape, &cuboid], 0.02)
            )
        };
        let here = format!(
            "{:?}",
            cold_manifold(&dispatcher, &pose, [&shape, &cuboid], 0.02)
        );
        in_contact += usize::from(here.contains("dist"));
        let fresh = thread::scope(|scope| scope.spawn(manifold).join().expect("an answer"));
        assert_eq!(here, fresh, "turn {turn}");
    }
    assert!(came_again > 10, "the allocator reused no address");
    assert!(in_contact > 30, "only {in_contact} contacts");
}

/// A block of a plain hull, of a prepared one, or a cuboid.
fn block(kind: usize, [x, y, z]: [f32; 3]) -> SharedShape {
    let side = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i: u32| Vector::new(x * side(i, 0), y * side(i, 1), z * side(i, 2));
    let plain = hull_of(&(0..8).map(corner).collect::<Vec<_>>())
        .expect("a block is convex")
        .shape;
    match kind {
        0 => plain,
        1 => prepared(&plain),
        _ => SharedShape::cuboid(x, y, z),
    }
}

/// The contacts of a body that rests on one ground, which then becomes another one.
fn after_exchange(body: &SharedShape, grounds: [&SharedShape; 2], pose: &Pose) -> Manifold {
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let [before, after] = grounds;
    for _ in 0..3 {
        let held = memory.update(&dispatcher, pose, [before, body], 0.02);
        assert!(held.is_some_and(|manifold| !manifold.points.is_empty()));
    }
    let warm = memory.update(&dispatcher, pose, [after, body], 0.02);
    warm.expect("supported").clone()
}

/// Depth and normal stay the same, but the contacts would be in the air.
#[test]
fn nothing_rests_beside_a_ground_that_has_shrunk() {
    for kind in 0..3 {
        let bodies = [
            ("hull", block(0, [0.5; 3])),
            ("hull shape", block(1, [0.5; 3])),
            ("cylinder", SharedShape::cylinder(0.5, 0.5)),
            ("cone", SharedShape::cone(0.5, 0.5)),
        ];
        for (name, body) in bodies {
            let grounds = [2.0, 0.3].map(|half| block(kind, [half, 0.5, half]));
            let pose = Pose::translation(0.6, 0.999, 0.0);
            let warm = after_exchange(&body, grounds.each_ref(), &pose);
            for point in &warm.points {
                let place = point.local_p1;
                let outside = place.x.abs().max(place.z.abs()) - 0.3;
                assert!(outside < 1e-5, "{name} on ground {kind}: {outside} outside");
            }
            assert!(warm.points.len() > 2, "{name} on ground {kind}");
        }
    }
}

/// The plane turns about the only vertex in contact, so that its depth stays the same.
#[test]
fn a_ground_that_is_tilted_under_a_tip_has_its_own_normal() {
    let tip = [
        Vector::ZERO,
        Vector::new(-0.5, 1.0, -0.5),
        Vector::new(0.5, 1.0, -0.5),
        Vector::new(0.0, 1.0, 0.5),
    ];
    let body = hull_of(&tip).expect("a tetrahedron is convex").shape;
    let tilted = Vector::new(0.1, 1.0, 0.2).normalize();
    let planes = [Vector::Y, tilted].map(SharedShape::halfspace);
    let warm = after_exchange(&body, planes.each_ref(), &Pose::IDENTITY);
    assert!(warm.local_n1.distance(tilted) < 1e-6, "{}", warm.local_n1);
    // Blocks whose upper sides meet where the tip is.
    let turn = Rotation::from_rotation_arc(Vector::Y, tilted);
    let lowered = |turn: Rotation| {
        let upright = block(0, [1.0, 0.5, 1.0]);
        let polyhedron = upright.as_convex_polyhedron().expect("a hull");
        let points = polyhedron.points().iter();
        let points: Vec<Vector> = points.map(|p| turn * (*p - Vector::Y * 0.5)).collect();
        hull_of(&points).expect("a block is convex").shape
    };
    let blocks = [Rotation::IDENTITY, turn].map(lowered);
    let warm = after_exchange(&body, blocks.each_ref(), &Pose::IDENTITY);
    assert!(warm.local_n1.distance(tilted) < 1e-5, "{}", warm.local_n1);
}

/// How far the contacts of a manifold are outside of a block of this width and depth, on which the others lie.
fn outside(manifold: &Manifold, [x, z]: [f32; 2]) -> f32 {
    let places = manifold.points.iter().map(|point| point.local_p1);
    let beyond = places.map(|place| (place.x.abs() - x).max(place.z.abs() - z));
    beyond.fold(f32::NEG_INFINITY, f32::max)
}

/// Bodies whose feet reach at least half a unit from their axis, and which are as high.
fn standing_bodies() -> [(&'static str, SharedShape); 5] {
    [
        ("hull", block(0, [0.5; 3])),
        ("hull shape", block(1, [0.5; 3])),
        ("cuboid", block(2, [0.5; 3])),
        ("cylinder", SharedShape::cylinder(0.5, 0.5)),
        ("cone", SharedShape::cone(0.5, 0.5)),
    ]
}

/// The ground is another one for a single update. A proof from before is still there, but not the contacts.
#[test]
fn a_ground_that_comes_back_has_contacts_of_its_own() {
    let sides = [[2.0, 0.3], [0.3, 2.0]];
    for kind in 0..2 {
        let grounds = sides.map(|[x, z]| block(kind, [x, 0.5, z]));
        for (name, body) in standing_bodies() {
            let dispatcher = IsaGjkDispatcher::default();
            let mut memory = Memory::default();
            let pose = Pose::translation(0.0, 0.999, 0.0);
            for ground in [0, 0, 0, 0, 1, 0, 1, 1, 1, 1, 0, 1] {
                let shapes = [&grounds[ground], &body];
                let warm = memory.update(&dispatcher, &pose, shapes, 0.02);
                let outside = outside(warm.expect("supported"), sides[ground]);
                assert!(outside < 1e-5, "{name} on {ground} of {kind}: {outside}");
            }
        }
    }
}

/// The body tilts a little from one update to the next, so that no contact is left as it is.
#[test]
fn nothing_moves_beside_a_ground_that_has_shrunk() {
    for kind in 0..2 {
        let grounds = [2.0, 0.3].map(|half| block(kind, [half, 0.5, half]));
        for (name, body) in standing_bodies() {
            let dispatcher = IsaGjkDispatcher::default();
            let mut memory = Memory::default();
            for turn in 0..8 {
                let tilt = Vector::new(0.0, 0.0, 5e-6 + 1e-5 * (turn % 2) as f32);
                let pose = Pose::new(Vector::new(0.2, 0.999, 0.0), tilt);
                let ground = turn / 4;
                let shapes = [&grounds[ground], &body];
                let warm = memory.update(&dispatcher, &pose, shapes, 0.02);
                let warm = warm.expect("supported");
                let half = [2.0, 0.3][ground];
                let outside = outside(warm, [half; 2]);
                assert!(outside < 1e-5, "{name} on {ground} of {kind}: {outside}");
                assert!(!warm.points.is_empty(), "{name} on {ground} of {kind}");
            }
        }
    }
}

/// On a half-space, a body's own foot may shrink while it stands or tilts.
#[test]
fn a_foot_that_has_shrunk_bears_only_on_itself() {
    let plane = SharedShape::halfspace(Vector::Y);
    type Foot = fn(f32) -> SharedShape;
    let feet: [(&str, Foot); 4] = [
        ("hull", |half| block(0, [half, 0.5, half])),
        ("hull shape", |half| block(1, [half, 0.5, half])),
        ("round cylinder", |half| {
            SharedShape::round_cylinder(0.4, half - 0.1, 0.1)
        }),
        ("round cone", |half| {
            SharedShape::round_cone(0.4, half - 0.1, 0.1)
        }),
    ];
    for (name, foot) in feet {
        for tilt in [0.0, 1e-5] {
            let dispatcher = IsaGjkDispatcher::default();
            let mut memory = Memory::default();
            for turn in 0..8 {
                let half = if turn < 4 { 0.8 } else { 0.3 };
                let tilt = Vector::new(0.0, 0.0, tilt * (turn % 2) as f32);
                let pose = Pose::new(Vector::new(0.0, 0.499, 0.0), tilt);
                let warm = memory.update(&dispatcher, &pose, [&plane, &foot(half)], 0.02);
                let outside = outside(warm.expect("supported"), [half; 2]);
                assert!(outside < 1e-4, "{name}, turn {turn}: {outside}");
            }
        }
    }
}
