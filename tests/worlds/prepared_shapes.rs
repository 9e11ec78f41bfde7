//! `PreparedShapes`: the plain hulls of a whole world become `HullShape`s, and nothing else changes.

use std::sync::Arc;

use isa_gjk::PreparedShapes;
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::query::QueryDispatcher;
use parry3d::shape::{Compound, CompoundFlags, ConvexPolyhedron};
use rapier3d::prelude::*;
use testkit::generate::Rng;
use testkit::world::{Ground, check_places, deepest, mixed, ours};

fn is_prepared(shape: &SharedShape) -> bool {
    shape.as_shape::<HullShape>().is_some()
}

fn same(a: &SharedShape, b: &SharedShape) -> bool {
    Arc::ptr_eq(&a.0, &b.0)
}

fn aside(x: Real) -> Pose {
    Pose::translation(x, 0.0, 0.0)
}

/// What a prepared shape says of distance and mass is what the plain one says.
fn assert_alike(plain: &SharedShape, prepared: &SharedShape) {
    let dispatcher = IsaGjkDispatcher::default();
    let probe = SharedShape::cuboid(0.3, 0.2, 0.1);
    for i in 0..20 {
        let angle = 0.3 * i as Real;
        let pose = Pose::new(
            Vector::new(angle.cos(), angle.sin(), 0.3) * 4.0,
            Vector::splat(angle),
        );
        let [a, b] = [plain, prepared].map(|shape| {
            let distance = dispatcher.distance(&pose, &**shape, &*probe);
            distance.expect("supported").distance
        });
        assert!((a - b).abs() < 1e-5, "{a} and {b} apart");
    }
    let [a, b] = [plain, prepared].map(|shape| shape.mass_properties(1.0).mass());
    // Parry joins faces that are nearly coplanar.
    assert!((a - b).abs() < 1e-3 * a, "masses of {a} and {b}");
    let [a, b] = [plain, prepared].map(|shape| shape.compute_local_aabb());
    assert!(a.mins.distance(b.mins).max(a.maxs.distance(b.maxs)) < 1e-5);
}

#[test]
fn hulls_are_prepared_once() {
    let mut rng = Rng::new(101);
    let [hull, other] = [(); 2].map(|()| rng.hull(40, 1.0).shape);
    let mut shapes = PreparedShapes::default();
    let prepared = shapes.prepare(&hull);
    assert!(is_prepared(&prepared));
    assert_alike(&hull, &prepared);
    assert!(same(&prepared, &shapes.prepare(&hull.clone())));
    assert!(!same(&prepared, &shapes.prepare(&other)));
    // Prepared shapes stay.
    assert!(same(&prepared, &shapes.prepare(&prepared)));
}

/// As the hulls of a loaded world are, in which no collider shares its shape.
#[test]
fn equal_hulls_are_prepared_once() {
    let mut rng = Rng::new(105);
    let hull = rng.hull(40, 1.0).shape;
    let polyhedron = hull.as_convex_polyhedron().expect("a hull");
    let mut shapes = PreparedShapes::default();
    let prepared = shapes.prepare(&hull);
    let copy = SharedShape::new(polyhedron.clone());
    assert!(!same(&hull, &copy));
    assert!(same(&prepared, &shapes.prepare(&copy)));
    let larger = polyhedron.clone().scaled(Vector::splat(1.001));
    let larger = SharedShape::new(larger.expect("still a hull"));
    let prepared_larger = shapes.prepare(&larger);
    assert!(!same(&prepared, &prepared_larger));
    assert_alike(&larger, &prepared_larger);
}

/// A shape that is dropped leaves its address to none that would be taken for it.
#[test]
fn dropped_shapes_are_not_mistaken() {
    let mut rng = Rng::new(102);
    let mut shapes = PreparedShapes::default();
    for _ in 0..50 {
        let hull = rng.hull(20, 1.0).shape;
        let prepared = shapes.prepare(&hull);
        let points = |shape: &SharedShape| {
            let hull = shape.as_shape::<HullShape>().expect("prepared").hull();
            hull.points().to_vec()
        };
        let polyhedron = hull.as_convex_polyhedron().expect("a hull");
        assert_eq!(points(&prepared), polyhedron.points());
    }
}

#[test]
fn compounds_are_prepared_part_by_part() {
    let mut rng = Rng::new(103);
    let hull = rng.hull(30, 1.0).shape;
    let parts = vec![
        (aside(-1.0), hull.clone()),
        (aside(0.0), SharedShape::ball(0.5)),
        (aside(1.0), hull.clone()),
    ];
    let compound = SharedShape::compound(parts.clone());
    let mut shapes = PreparedShapes::default();
    let prepared = shapes.prepare(&compound);
    let new_parts = prepared.as_compound().expect("a compound").shapes();
    for ((old_pose, old), (pose, new)) in parts.iter().zip(new_parts) {
        assert_eq!(old_pose, pose);
        assert_eq!(is_prepared(new), old.as_convex_polyhedron().is_some());
    }
    assert!(same(&new_parts[0].1, &shapes.prepare(&hull)));
    assert!(same(&new_parts[1].1, &parts[1].1));
    assert_alike(&compound, &prepared);
}

#[test]
fn what_cannot_be_prepared_is_left_alone() {
    let mut rng = Rng::new(104);
    let hull = rng.hull(30, 1.0).shape;
    let ball = SharedShape::ball(0.5);
    let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let round = SharedShape::round_convex_hull(&corners, 0.1).expect("a solid");
    let thin = corners.map(|corner| corner * Vector::new(1.0, 1.0, 1e-8));
    let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let thin = ConvexPolyhedron::from_convex_mesh(thin.to_vec(), &triangles);
    let edges = CompoundFlags::FIX_INTERNAL_EDGES;
    let smoothed = Compound::with_flags(vec![(aside(0.0), hull.clone())], edges, None);
    let untouched = [
        SharedShape::compound(vec![(aside(0.0), ball.clone())]),
        SharedShape::new(smoothed),
        ball,
        round,
        SharedShape::new(thin.expect("parry takes it")),
    ];
    let mut shapes = PreparedShapes::default();
    for shape in untouched {
        let what = shape.shape_type();
        assert!(same(&shape, &shapes.prepare(&shape)), "{what:?}");
    }
    assert_eq!(shapes.refused().len(), 1, "the thin hull");
}

/// A running world is prepared: no contact is lost, nothing is thrown.
#[test]
fn a_running_world_is_prepared() {
    for ground in Ground::ALL {
        let mut world = mixed(ground, 28, ours());
        let step = |world: &mut PhysicsWorld, count| {
            for _ in 0..count {
                world.step();
                check_places(world, &format!("{ground:?}"));
            }
        };
        step(&mut world, 150);
        let mut shapes = PreparedShapes::default();
        let mut count = 0;
        for (_, collider) in world.colliders.iter_mut() {
            let shape = shapes.prepare(collider.shared_shape());
            count += usize::from(is_prepared(&shape));
            collider.set_shape(shape);
        }
        assert!(count > 5, "{count} hulls on {ground:?}");
        step(&mut world, 150);
        let depth = deepest(&world);
        assert!(depth < 0.1, "{depth} deep on {ground:?}");
    }
}
