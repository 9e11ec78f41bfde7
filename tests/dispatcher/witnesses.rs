//! Witness points lie on both surfaces, one over the other along the normal, however deep the shapes
//! overlap, whatever features meet, and however far a query looks.

use glam::{DQuat, DVec3, Vec3};
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::Real;
use parry3d::query::{Contact, QueryDispatcher};
use testkit::cases::Hull;
use testkit::generate::{Rng, hull_of};
use testkit::memory::Memory;
use testkit::oracle::signed_distance;
use testkit::pose::ExactPose;
use testkit::report::{Finding, Report};

/// Relative to the smaller shape's diameter: what a depth is certified to.
const OFF: f64 = 2e-6;
/// The f32 rounding of points, relative to the larger coordinates.
const SINGLE: f64 = 4e-7;

fn contact(shapes: [&Hull; 2], pose: &ExactPose, prediction: f64) -> Option<Contact> {
    let [a, b] = shapes.map(|hull| &*hull.shape);
    IsaGjkDispatcher::default()
        .contact(&pose.to_f32(), a, b, prediction as Real)
        .expect("supported")
}

/// The deepest contact of a manifold that was brought up to date twice.
fn deepest(shapes: [&Hull; 2], pose: &ExactPose, prediction: f64) -> Option<Contact> {
    let (dispatcher, mut memory) = (IsaGjkDispatcher::default(), Memory::default());
    let shapes = shapes.map(|hull| &hull.shape);
    let pose = pose.to_f32();
    memory.update(&dispatcher, &pose, shapes, prediction as Real)?;
    let manifold = memory.update(&dispatcher, &pose, shapes, prediction as Real)?;
    let point = manifold.find_deepest_contact()?;
    Some(Contact::new(
        point.local_p1,
        point.local_p2,
        manifold.local_n1,
        manifold.local_n2,
        point.dist,
    ))
}

/// Whether the points of a contact are on both surfaces, and one over the other.
fn judge(shapes: [&Hull; 2], pose: &ExactPose, contact: Option<&Contact>, exact: f64) -> Finding {
    let mut finding = Finding::default();
    let Some(contact) = contact else {
        finding.require(false, || "no answer".to_owned());
        return finding;
    };
    let [a, b] = shapes.map(|hull| &hull.solid);
    let (p1, p2) = (contact.point1.as_dvec3(), contact.point2.as_dvec3());
    let dist = f64::from(contact.dist);
    let sideways = pose.apply(p2) - p1 - contact.normal1.as_dvec3() * dist;
    let large = a.diameter().max(b.diameter()) + pose.translation.length();
    let limit = OFF * a.diameter().min(b.diameter()) + SINGLE * large;
    finding.at_most("point1/limit", a.distance_to_surface(p1) / limit, 1.0);
    finding.at_most("point2/limit", b.distance_to_surface(p2) / limit, 1.0);
    finding.at_most("sideways/limit", sideways.length() / limit, 1.0);
    finding.at_most("distance/limit", (dist - exact).abs() / limit, 1.0);
    finding
}

#[test]
fn witnesses_lie_on_both_surfaces() {
    let mut rng = Rng::new(1);
    let mut report = Report::new("witnesses of overlaps");
    for round in 0..1500 {
        let size = if round % 2 == 0 {
            1.0
        } else {
            10_f64.powf(rng.range(-3.0, 0.0))
        };
        let hulls = [rng.any_hull(1.0), rng.any_hull(size)];
        let pose = ExactPose {
            rotation: rng.any_turn(),
            translation: rng.any_place(0.5 * (1.0 + size)),
        };
        let (one, other) = ([&hulls[0], &hulls[1]], [&hulls[1], &hulls[0]]);
        for (shapes, pose) in [(one, pose.rounded()), (other, pose.inverse().rounded())] {
            let exact = signed_distance(&shapes[0].solid, &shapes[1].solid, &pose);
            if exact > -f64::EPSILON {
                continue;
            }
            for prediction in [0.0, 0.002 * size, 0.5, 5.0] {
                let answers = [
                    ("contact", contact(shapes, &pose, prediction)),
                    ("manifold", deepest(shapes, &pose, prediction)),
                ];
                for (route, contact) in answers {
                    let finding = judge(shapes, &pose, contact.as_ref(), exact);
                    let id = format!("{round}, {prediction}");
                    report.add(route, &id, finding);
                }
            }
        }
    }
    report.conclude();
}

fn hull(points: &[[f32; 3]]) -> Hull {
    let points: Vec<Vec3> = points.iter().copied().map(Vec3::from).collect();
    hull_of(&points).expect("all are corners")
}

fn cuboid([x, y, z]: [f32; 3]) -> Hull {
    let corners = [-x, x].map(|x| [-y, y].map(|y| [[x, y, -z], [x, y, z]]));
    hull(corners.as_flattened().as_flattened())
}

/// Each used to have a witness point beside its shape by up to twenty sizes of that.
#[test]
fn no_witness_lies_beside_its_shape() {
    let blade = |half: f32, height: f32, breadth: f32| {
        let [upper, lower] = [[-breadth, breadth], [0.0, 0.0]];
        let ends = [-half, half].map(|x| upper.map(|z| [x, height, z]));
        hull(
            &[
                ends.concat(),
                vec![[-half, 0.0, lower[0]], [half, 0.0, lower[1]]],
            ]
            .concat(),
        )
    };
    let over_two = |half: f32, height: f32, z: f32, far: f32| {
        hull(&[
            [-half, 0.0, 0.0],
            [half, 0.0, 0.0],
            [far, height, z],
            [far, height, -z],
        ])
    };
    let unit = || cuboid([1.0; 3]);
    let turned = |by: f64| DQuat::from_rotation_y(by);
    let prism = hull(&[
        [21.913_77, 0.0, 21.913_77],
        [-16.159078, 14.801946, 21.913_77],
        [0.945408, -10.763347, 5.3274],
        [6.573106, 8.575412, 5.3274],
        [-5.245826, -0.928709, 1.29513],
        [4.495548, -2.858539, 1.29513],
    ]);
    let golden = 0.5 * (1.0 + 5_f32.sqrt());
    let scale = 0.85 / (1.0 + golden * golden).sqrt();
    let icosahedron: Vec<[f32; 3]> = [-scale, scale]
        .iter()
        .flat_map(|&x| {
            [-scale * golden, scale * golden].map(|y| [[x, y, 0.0], [0.0, x, y], [y, 0.0, x]])
        })
        .flatten()
        .collect();
    let cases = [
        (
            unit(),
            blade(2.0, 0.5, 0.02),
            turned(0.5),
            [0.75, 0.875, 0.75],
            0.5,
        ),
        (
            unit(),
            over_two(2.0, 1.0, 0.01, 2.0),
            turned(0.5),
            [0.75, 0.875, 0.75],
            0.5,
        ),
        (
            unit(),
            over_two(0.5, 0.5, 0.01, 0.0),
            turned(0.25),
            [0.75, 0.96875, 0.5],
            0.5,
        ),
        (
            cuboid([21.913_77, 8.60113, 7.957224]),
            prism,
            DQuat::from_rotation_x(std::f64::consts::PI),
            [-2.877347, 2.0193, 11.604451],
            0.0,
        ),
        (
            hull(&icosahedron),
            cuboid([0.0113, 0.0031, 0.0011]),
            DQuat::IDENTITY,
            [0.0; 3],
            0.2,
        ),
    ];
    for (a, b, rotation, translation, prediction) in &cases {
        let pose = ExactPose {
            rotation: *rotation,
            translation: DVec3::from(*translation),
        };
        for (shapes, pose) in [([a, b], pose.rounded()), ([b, a], pose.inverse().rounded())] {
            let exact = signed_distance(&shapes[0].solid, &shapes[1].solid, &pose);
            for contact in [
                contact(shapes, &pose, *prediction),
                deepest(shapes, &pose, *prediction),
            ] {
                let finding = judge(shapes, &pose, contact.as_ref(), exact);
                assert!(
                    finding.is_fine(),
                    "{finding:?} at {translation:?}: {contact:?}"
                );
            }
        }
    }
}
