//! Whoever plugs the dispatcher in must not lose a single contact by it.
//!
//! rapier throws the result of a narrow-phase query away, so a pair that the dispatcher does not
//! support falls through the floor in silence, and parry's dispatcher hands itself, not us, to
//! the routines for compounds, meshes, heightfields and voxels. So every shape meets every
//! shape: the dispatcher supports exactly what parry supports, finds contacts wherever parry
//! does, and passes every pair without a convex hull through untouched, to the last bit.

mod common;

use std::fmt::Debug;

use common::generate::{Dice, hull_of};
use common::memory::{Manifold, Memory};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{IVector, Pose, Real, Rotation, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{
    DefaultQueryDispatcher, NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher,
};
use parry3d::shape::SharedShape;
use parry3d::utils::Array2;

const PREDICTION: Real = 0.1;

/// A shape about one unit across.
struct Exhibit {
    name: &'static str,
    has_hull: bool,
    shape: SharedShape,
}

/// One of every type of shape, and hulls wherever a hull can be.
fn zoo() -> Vec<Exhibit> {
    let [hull, other_hull] = [20, 40].map(|corners| Dice::new(11).hull(corners, 1.2).shape);
    let hull_points: Vec<Vector> = hull
        .as_convex_polyhedron()
        .expect("a convex polyhedron")
        .points()
        .iter()
        .map(|p| *p * 0.8)
        .collect();
    let round_hull = SharedShape::round_convex_hull(&hull_points, 0.1).expect("a solid");
    let aside = |x: Real| Pose::translation(x, 0.1, 0.0);
    let compound_of_hulls = SharedShape::compound(vec![
        (aside(-0.4), hull.clone()),
        (aside(0.4), other_hull.clone()),
        (aside(0.0), SharedShape::cuboid(0.2, 0.6, 0.2)),
    ]);
    let compound = SharedShape::compound(vec![
        (aside(-0.4), SharedShape::ball(0.3)),
        (aside(0.4), SharedShape::cuboid(0.3, 0.3, 0.3)),
    ]);
    let (a, b, c) = (
        Vector::new(-0.5, -0.3, 0.0),
        Vector::new(0.5, -0.3, 0.1),
        Vector::new(0.0, 0.6, -0.1),
    );
    let with_hull = [
        ("hull", hull),
        ("box as hull", box_hull()),
        ("round hull", round_hull),
        ("compound of hulls", compound_of_hulls),
    ];
    let without_hull = [
        ("ball", SharedShape::ball(0.5)),
        ("cuboid", SharedShape::cuboid(0.5, 0.5, 0.5)),
        ("capsule", SharedShape::capsule_y(0.3, 0.25)),
        ("segment", SharedShape::segment(a, b)),
        ("triangle", SharedShape::triangle(a, b, c)),
        ("cylinder", SharedShape::cylinder(0.5, 0.4)),
        ("cone", SharedShape::cone(0.5, 0.4)),
        (
            "round cuboid",
            SharedShape::round_cuboid(0.4, 0.4, 0.4, 0.1),
        ),
        ("round cylinder", SharedShape::round_cylinder(0.4, 0.3, 0.1)),
        ("round cone", SharedShape::round_cone(0.4, 0.3, 0.1)),
        ("round triangle", SharedShape::round_triangle(a, b, c, 0.1)),
        ("half-space", SharedShape::halfspace(Vector::Y)),
        ("trimesh", trimesh()),
        ("heightfield", heightfield()),
        ("compound", compound),
        ("voxels", voxels()),
        ("polyline", SharedShape::polyline(vec![a, b, c], None)),
    ];
    let exhibits = |has_hull: bool| {
        move |(name, shape)| Exhibit {
            name,
            has_hull,
            shape,
        }
    };
    with_hull
        .into_iter()
        .map(exhibits(true))
        .chain(without_hull.into_iter().map(exhibits(false)))
        .collect()
}

fn box_hull() -> SharedShape {
    let corner = |i: u32| {
        let side = |bit: u32| if i & (1 << bit) == 0 { -0.5 } else { 0.5 };
        Vector::new(side(0), side(1), side(2))
    };
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    hull_of(&corners).expect("a box is convex").shape
}

fn trimesh() -> SharedShape {
    let (points, triangles) = parry3d::shape::Cuboid::new(Vector::new(0.5, 0.4, 0.6)).to_trimesh();
    SharedShape::trimesh(points, triangles).expect("a mesh")
}

fn heightfield() -> SharedShape {
    let heights = (0..25).map(|i| 0.1 * (i % 4) as Real).collect();
    SharedShape::heightfield(Array2::new(5, 5, heights), Vector::new(2.0, 1.0, 2.0))
}

fn voxels() -> SharedShape {
    let cells: Vec<IVector> = (-1..1)
        .flat_map(|x| (-1..1).map(move |y| IVector::new(x, y, x + y)))
        .collect();
    SharedShape::voxels(Vector::splat(0.5), &cells)
}

/// Deep, touching, near and apart, from several sides, straight and tilted.
fn poses() -> Vec<Pose> {
    let rotations = [
        Rotation::IDENTITY,
        Rotation::from_scaled_axis(Vector::new(0.3, 0.2, -0.1)),
        Rotation::from_scaled_axis(Vector::new(-1.1, 0.7, 2.0)),
    ];
    let directions = [
        Vector::X,
        Vector::Y,
        -Vector::Y,
        Vector::new(0.48, 0.6, 0.64),
    ];
    let mut poses = Vec::new();
    for rotation in rotations {
        for direction in directions {
            for distance in [0.0, 0.2, 0.5, 0.7, 0.9, 1.0, 1.05, 1.3] {
                poses.push(Pose::from_parts(direction * distance, rotation));
            }
        }
    }
    poses
}

/// A frame later: moved by less than a hundredth.
fn nudged(pose: &Pose) -> Pose {
    let turn = Rotation::from_scaled_axis(Vector::new(0.004, -0.002, 0.003));
    Pose::from_parts(
        pose.translation + Vector::new(-0.002, -0.003, 0.001),
        turn * pose.rotation,
    )
}

/// Every ordered pair of shapes, but for those that make parry itself panic.
fn pairs(zoo: &[Exhibit]) -> impl Iterator<Item = [&Exhibit; 2]> {
    zoo.iter()
        .flat_map(move |first| zoo.iter().map(move |second| [first, second]))
        .filter(|[first, second]| !parry_panics(first.name, second.name))
}

/// An infinite shape meets one made of finitely many cells.
fn parry_panics(first: &str, second: &str) -> bool {
    let infinite = |name| name == "half-space";
    let cells = |name| name == "voxels" || name == "heightfield";
    (infinite(first) && cells(second)) || (cells(first) && infinite(second))
}

fn contacts(
    dispatcher: &impl PersistentQueryDispatcher<(), ()>,
    pair: [&Exhibit; 2],
    pose: &Pose,
    memory: &mut Memory,
) -> bool {
    let [first, second] = pair;
    dispatcher
        .contact_manifolds(
            pose,
            &*first.shape,
            &*second.shape,
            PREDICTION,
            &mut memory.manifolds,
            &mut memory.workspace,
        )
        .is_ok()
}

/// The distance of the deepest point of all manifolds.
fn deepest(manifolds: &[Manifold]) -> Option<Real> {
    manifolds
        .iter()
        .filter_map(|m| m.find_deepest_contact())
        .map(|point| point.dist)
        .reduce(Real::min)
}

/// Equal to the last bit: floats print in as many digits as tell them apart.
fn assert_same(ours: &impl Debug, theirs: &impl Debug, what: &str) {
    assert_eq!(format!("{ours:?}"), format!("{theirs:?}"), "{what}");
}

#[test]
fn contacts_are_found_wherever_parry_finds_them() {
    let (mut checked, mut in_contact) = (0, 0);
    for pair in pairs(&zoo()) {
        for pose in poses() {
            let dispatcher = IsaGjkDispatcher::default();
            let (mut ours, mut theirs) = (Memory::default(), Memory::default());
            for pose in [pose, nudged(&pose)] {
                let what = format!("{} / {} at {pose:?}", pair[0].name, pair[1].name);
                let we_can = contacts(&dispatcher, pair, &pose, &mut ours);
                let they_can = contacts(&DefaultQueryDispatcher, pair, &pose, &mut theirs);
                assert_eq!(we_can, they_can, "supported: {what}");
                if !pair.iter().any(|exhibit| exhibit.has_hull) {
                    assert_same(&ours.manifolds, &theirs.manifolds, &what);
                }
                checked += 1;
                // At the very edge of the prediction either answer is right.
                if deepest(&theirs.manifolds).is_some_and(|dist| dist < 0.9 * PREDICTION) {
                    assert!(deepest(&ours.manifolds).is_some(), "lost: {what}");
                    in_contact += 1;
                }
            }
        }
    }
    let share = f64::from(in_contact) / f64::from(checked);
    assert!((0.2..0.9).contains(&share), "the zoo hardly meets: {share}");
}

#[test]
fn scene_queries_are_supported_wherever_parry_supports_them() {
    let ours = IsaGjkDispatcher::default();
    let theirs = DefaultQueryDispatcher;
    for pair in pairs(&zoo()) {
        let (g1, g2) = (&*pair[0].shape, &*pair[1].shape);
        for pose in poses().iter().step_by(5) {
            let agree = |ours: String, theirs: String, query: &str| {
                let what = format!("{query}, {} / {} at {pose:?}", pair[0].name, pair[1].name);
                if pair.iter().any(|exhibit| exhibit.has_hull) {
                    let supported = |answer: &str| answer.starts_with("Ok");
                    assert_eq!(supported(&ours), supported(&theirs), "{what}");
                } else {
                    assert_eq!(ours, theirs, "{what}");
                }
            };
            macro_rules! compare {
                ($query:ident $arguments:tt) => {
                    agree(
                        format!("{:?}", ours.$query $arguments),
                        format!("{:?}", theirs.$query $arguments),
                        stringify!($query),
                    )
                };
            }
            let still = NonlinearRigidMotion::identity();
            let spin = Vector::new(0.1, 0.2, 0.3);
            let moving = NonlinearRigidMotion::new(*pose, Vector::ZERO, -pose.translation, spin);
            let options = ShapeCastOptions::default();
            compare!(intersection_test(pose, g1, g2));
            compare!(distance(pose, g1, g2));
            compare!(contact(pose, g1, g2, PREDICTION));
            compare!(closest_points(pose, g1, g2, PREDICTION));
            compare!(cast_shapes(pose, -pose.translation, g1, g2, options));
            compare!(cast_shapes_nonlinear(
                &still, g1, &moving, g2, 0.0, 1.0, true
            ));
        }
    }
}
