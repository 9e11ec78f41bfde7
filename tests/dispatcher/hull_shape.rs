//! A `HullShape` is to other shapes, and to whoever asks what it is, the plain convex hull that it
//! stands for.

use isa_gjk::internals::support::Support;
use isa_gjk::{Hull, HullError, HullShape, IsaGjkDispatcher};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{DefaultQueryDispatcher, QueryDispatcher};
use parry3d::shape::{ShapeType, SharedShape, TypedShape};
use testkit::cases::hulls;
use testkit::generate::{Rng, prepared};
use testkit::memory::{Manifold, Memory, UpdateManifolds};
use testkit::shape_samples::{poses, shape_samples};
use testkit::twins::{assert_same, hull_shape, with_twins};

/// Deepest point of all manifolds.
fn deepest(manifolds: &[Manifold]) -> Option<Real> {
    let points = manifolds.iter().filter_map(|m| m.find_deepest_contact());
    points.map(|point| point.dist).reduce(Real::min)
}

fn update(shapes: [&SharedShape; 2], pose: &Pose, memory: &mut Memory) {
    let [a, b] = shapes;
    let (manifolds, workspace) = (&mut memory.manifolds, &mut memory.workspace);
    IsaGjkDispatcher::default()
        .update_manifolds(pose, [&**a, &**b], 0.1, manifolds, workspace)
        .expect("hulls are supported");
}

fn distance([a, b]: [&SharedShape; 2], pose: &Pose) -> Real {
    let distance = DefaultQueryDispatcher.distance(pose, &**a, &**b);
    distance.expect("supported").distance
}

/// What the solver sees, whose bits are those of the plain hull where our kernels answer.
#[test]
fn contacts_with_every_shape_are_those_of_the_plain_hull() {
    let samples = shape_samples();
    let [plain, ours] = ["hull", "hull shape"].map(|name| {
        let sample = samples.iter().find(|sample| sample.name == name);
        &sample.expect("in the samples").shape
    });
    let (mut touching, mut identical) = (0, 0);
    for other in samples.iter().filter(|e| e.name != "hull shape") {
        // In parry's own contacts, the point or the corners of a face may differ.
        let kernel = other.has_hull || ["cuboid", "triangle", "trimesh"].contains(&other.name);
        for pose in poses() {
            for flipped in [false, true] {
                let what = format!("{} at {pose:?}, flipped: {flipped}", other.name);
                let [a, b] = [plain, ours].map(|hull| {
                    let mut memory = Memory::default();
                    let shapes = [hull, &other.shape];
                    let pair = if flipped {
                        [shapes[1], shapes[0]]
                    } else {
                        shapes
                    };
                    update(pair, &pose, &mut memory);
                    memory.manifolds
                });
                if kernel {
                    assert_same(&b, &a, &what);
                    identical += 1;
                }
                let [a, b] = [a, b].map(|manifolds| deepest(&manifolds));
                let clearly = |dist: Option<Real>| dist.is_some_and(|dist| dist < 0.09);
                assert!(!clearly(a) || b.is_some(), "lost: {what}");
                // parry may look for the deepest corner on a face that does not have it.
                let near = || distance([ours, &other.shape], &pose) < 0.1;
                assert!(!clearly(b) || a.is_some() || near(), "made up: {what}");
                touching += usize::from(clearly(b));
            }
        }
    }
    assert!(
        touching > 1000 && identical > 500,
        "{touching}, {identical}"
    );
}

#[test]
fn scene_queries_between_hulls_are_those_of_plain_hulls() {
    let mut rng = Rng::new(5);
    let dispatcher = IsaGjkDispatcher::default();
    for _ in 0..20 {
        let plain = [12, 40].map(|corners| rng.hull(corners, 1.0).shape);
        let ours = plain.each_ref().map(prepared);
        for _ in 0..20 {
            let pose = rng.pose(1.5).to_f32();
            let [a, b] = [&plain, &ours].map(|[g1, g2]| {
                let (g1, g2) = (&**g1, &**g2);
                let query = "supported";
                (
                    dispatcher.contact(&pose, g1, g2, 1.0).expect(query),
                    dispatcher.distance(&pose, g1, g2).expect(query),
                    dispatcher.closest_points(&pose, g1, g2, 1.0).expect(query),
                    dispatcher.intersection_test(&pose, g1, g2).expect(query),
                )
            });
            assert_same(&b, &a, "a scene query");
            let cast = |[g1, g2]: &[SharedShape; 2]| {
                let options = ShapeCastOptions::default();
                let hit = dispatcher.cast_shapes(&pose, -pose.translation, &**g1, &**g2, options);
                hit.expect("supported").map(|hit| hit.time_of_impact)
            };
            let difference = cast(&plain).unwrap_or(9.0) - cast(&ours).unwrap_or(9.0);
            assert!(difference.abs() < 1e-3, "cast off by {difference}");
        }
    }
}

#[test]
fn it_shows_itself_as_the_polyhedron_that_it_holds() {
    with_twins(|name, hull, ours| {
        let TypedShape::ConvexPolyhedron(shown) = ours.as_typed_shape() else {
            panic!("{name} is no polyhedron");
        };
        assert_eq!(Some(shown), hull.shape.as_convex_polyhedron(), "{name}");
        assert_eq!(ours.shape_type(), ShapeType::Custom);
        assert!(ours.is_convex());
        let copy = SharedShape(ours.clone_dyn().into());
        assert!(copy.as_shape::<HullShape>().is_some(), "{name}");
    });
}

#[test]
fn both_ways_to_build_it_agree() {
    let points: Vec<Vector> = hulls()["rand100"]
        .solid
        .points
        .iter()
        .map(|p| p.as_vec3())
        .collect();
    let (vertices, triangles) = parry3d::transformation::try_convex_hull(&points).expect("a hull");
    let from_points = HullShape::from_points(&points).expect("a hull");
    let from_triangles = HullShape::from_triangles(vertices, &triangles).expect("a hull");
    let plain = SharedShape::convex_hull(&points).expect("a hull");
    let from_plain = prepared(&plain);
    assert_same(
        from_triangles.hull(),
        hull_shape(&from_plain).hull(),
        "built from a plain hull",
    );
    // Our builder numbers vertices in another order than parry's.
    let [ours, parrys] = [&from_points, &from_triangles].map(HullShape::hull);
    let sizes = |hull: &Hull| (hull.points().len(), hull.face_count());
    assert_eq!(sizes(ours), sizes(parrys));
    assert!(ours.center().distance(parrys.center()) < 1e-12);
}

#[test]
fn bad_input_is_named() {
    let tetrahedron = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let error = |points: &[Vector]| HullShape::from_points(points).err();
    assert_eq!(error(&[]), Some(HullError::TooFewPoints));
    assert_eq!(error(&tetrahedron[..3]), Some(HullError::TooFewPoints));
    let with = |odd: Vector| [&tetrahedron[..], &[odd]].concat();
    assert_eq!(error(&with(Vector::NAN)), Some(HullError::NotFinite(4)));
    assert_eq!(
        error(&with(Vector::INFINITY)),
        Some(HullError::NotFinite(4))
    );
    let line: Vec<Vector> = (0..9).map(|i| Vector::X * i as Real).collect();
    for flat in [&line, &vec![Vector::ONE; 9], &tetrahedron[..3].repeat(2)] {
        let error = error(flat);
        let named = [
            HullError::Flat,
            HullError::BuilderFailed,
            HullError::NotManifold,
        ];
        assert!(
            error.is_some_and(|e| named.contains(&e)),
            "{error:?} for {flat:?}"
        );
    }

    let error = |faces: &[[u32; 3]]| HullShape::from_triangles(tetrahedron.into(), faces).err();
    assert_eq!(error(&faces), None);
    assert_eq!(error(&faces[1..]), Some(HullError::NotManifold));
    assert_eq!(error(&[[0, 1, 4]]), Some(HullError::BadTriangle(0)));
    assert_eq!(
        error(&faces.map(|[a, b, c]| [a, c, b])),
        Some(HullError::InsideOut)
    );
}
