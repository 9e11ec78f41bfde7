//! Plates that have sunk into a flagged mesh by up to some of their thicknesses, in random poses: what
//! rapier's default pushes out upwards, we push out upwards.

use glam::{DQuat, DVec3};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d::shape::{SharedShape, TriMeshFlags};
use testkit::generate::Rng;

const CELL: Real = 0.25;

/// A flat square in y = 0 of 8 x 8 cells of two triangles.
fn flat_mesh() -> SharedShape {
    let point = |i: u32| Vector::new((i % 9) as Real - 4.0, 0.0, (i / 9) as Real - 4.0) * CELL;
    let cell = |i: u32| {
        let v = i / 8 * 9 + i % 8;
        [[v, v + 9, v + 1], [v + 1, v + 9, v + 10]]
    };
    let points = (0..81).map(point).collect();
    let triangles = (0..64).flat_map(cell).collect();
    SharedShape::trimesh_with_flags(points, triangles, TriMeshFlags::FIX_INTERNAL_EDGES)
        .expect("a mesh")
}

/// Whether a contact pushes upwards what overlaps the mesh.
fn is_pushed_out(
    dispatcher: &impl PersistentQueryDispatcher<(), ()>,
    shapes: [&SharedShape; 2],
    pose: &Pose,
) -> bool {
    let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
    let [mesh, plate] = shapes;
    dispatcher
        .contact_manifolds(pose, &**mesh, &**plate, 0.002, &mut manifolds, &mut None)
        .expect("supported");
    let is_deep = |m: &ContactManifold<(), ()>| m.points.iter().any(|point| point.dist < 0.0);
    manifolds.iter().any(|m| m.local_n1.y > 0.99 && is_deep(m))
}

#[test]
fn plates_that_have_sunk_into_a_mesh_are_pushed_out() {
    let mesh = flat_mesh();
    let mut rng = Rng::new(13);
    let (us, default) = (IsaGjkDispatcher::default(), DefaultQueryDispatcher);
    let mut pushed = 0;
    for round in 0..1500 {
        let half = DVec3::new(
            0.25,
            rng.range(0.1, 0.25),
            0.5_f64.powi(rng.count(3, 6) as i32),
        );
        let corners: Vec<Vector> = (0..8)
            .map(|i: u32| {
                let side = |bit: u32| f64::from(i >> bit & 1) * 2.0 - 1.0;
                (half * DVec3::new(side(0), side(1), side(2))).as_vec3()
            })
            .collect();
        let plate = SharedShape::convex_hull(&corners).expect("a plate");
        let turn = DQuat::from_rotation_y(rng.range(0.0, 3.0));
        let depth = half.z * [0.25, 0.5, 1.0, 2.0, 4.0][rng.count(0, 4)];
        let place = DVec3::new(rng.range(-0.6, 0.6), half.y - depth, rng.range(-0.6, 0.6));
        let pose = Pose::from_parts(place.as_vec3(), turn.as_quat());
        let shapes = [&mesh, &plate];
        if is_pushed_out(&default, shapes, &pose) {
            pushed += 1;
            let is_out = is_pushed_out(&us, shapes, &pose);
            assert!(is_out, "{round}: {half} is stuck at {place}, {turn}");
        }
    }
    assert!(pushed > 1000, "only {pushed} are pushed out by anybody");
}
