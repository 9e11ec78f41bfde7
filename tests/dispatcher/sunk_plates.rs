//! Plates that have sunk into a flagged mesh by up to some of their thicknesses, in random poses: what
//! rapier's default pushes out upwards, we push out upwards.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::Pose;
use parry3d::query::DefaultQueryDispatcher;
use parry3d::shape::SharedShape;
use testkit::budget;
use testkit::families;
use testkit::generate::Rng;
use testkit::memory::{Manifold, UpdateManifolds};

/// Whether a contact pushes upwards what overlaps the mesh.
fn is_pushed_out(
    dispatcher: &impl UpdateManifolds,
    shapes: [&SharedShape; 2],
    pose: &Pose,
) -> bool {
    let mut manifolds: Vec<Manifold> = Vec::new();
    let [mesh, plate] = shapes;
    dispatcher
        .update_manifolds(pose, [&**mesh, &**plate], 0.002, &mut manifolds, &mut None)
        .expect("supported");
    let is_deep = |m: &Manifold| m.points.iter().any(|point| point.dist < 0.0);
    manifolds.iter().any(|m| m.local_n1.y > 0.99 && is_deep(m))
}

#[test]
fn plates_that_have_sunk_into_a_mesh_are_pushed_out() {
    let mesh = families::flat_mesh();
    let mut rng = Rng::new(12 + u128::from(budget::seed()));
    let (us, default) = (IsaGjkDispatcher::default(), DefaultQueryDispatcher);
    let (mut rounds, mut pushed) = (0, 0);
    for round in budget::turns(1500) {
        rounds += 1;
        let (plate, pose) = families::sunk_plate(&mut rng);
        let shapes = [&mesh, &plate];
        if is_pushed_out(&default, shapes, &pose) {
            pushed += 1;
            let is_out = is_pushed_out(&us, shapes, &pose);
            assert!(is_out, "{round}: stuck at {pose:?}");
        }
    }
    assert!(
        3 * pushed > 2 * rounds,
        "only {pushed} of {rounds} are pushed out by anybody"
    );
}
