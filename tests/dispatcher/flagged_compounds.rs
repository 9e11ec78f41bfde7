//! Compounds whose normals are corrected at the seams between their parts.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Real, Vector};
use parry3d::shape::{Compound, CompoundFlags, SharedShape};
use testkit::curved::{Body, Difference};
use testkit::generate::{Rng, prepared};
use testkit::memory::{Memory, UpdateManifolds};
use testkit::pose::ExactPose;

/// Less of an overlap need not have a contact: where it ends depends on the rounding of f32.
const LEAST_OVERLAP: f64 = 1e-4;

/// A part, and its pose in the whole.
type Part = (ExactPose, Body);

/// A body of one of the kinds that decompositions and users have.
fn body(rng: &mut Rng) -> Body {
    let half = Vector::new(0.2, 0.3, 0.25) * rng.range(0.5, 1.5) as Real;
    let hull = || hull(half, 0.0);
    match rng.count(0, 4) {
        0 => Body::ball(half.x),
        1 => Body::cylinder(half.y, half.x, 0.0),
        2 => Body::cuboid(half, 0.0),
        3 => hull(),
        _ => Body {
            shape: prepared(&hull().shape),
            ..hull()
        },
    }
}

/// A box as a hull.
fn hull(half: Vector, border: Real) -> Body {
    let signs = |i: usize| Vector::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
    let corners: Vec<_> = (0..8)
        .map(|i| half * (signs(i) * 2.0 - Vector::ONE))
        .collect();
    Body::hull(&corners, border).expect("a box")
}

/// A hull most of which is border.
fn rounded(rng: &mut Rng) -> Body {
    hull(Vector::new(0.1, 0.15, 0.12), rng.range(0.05, 0.2) as Real)
}

fn parts(rng: &mut Rng) -> Vec<Part> {
    let count = rng.count(2, 5);
    let part = |_| {
        let pose = ExactPose {
            translation: rng.direction() * rng.range(0.0, 0.5),
            rotation: match rng.count(0, 1) {
                0 => Default::default(),
                _ => rng.rotation(),
            },
        };
        (pose.rounded(), body(rng))
    };
    (0..count).map(part).collect()
}

fn compound(parts: &[Part]) -> SharedShape {
    let shapes = parts.iter();
    let shapes = shapes.map(|(pose, body)| (pose.to_f32(), body.shape.clone()));
    let flags = CompoundFlags::FIX_INTERNAL_EDGES;
    SharedShape::new(Compound::with_flags(shapes.collect(), flags, None))
}

/// Whether some part of the one certainly overlaps one of the other, which is at `pose`.
fn overlap(pose: ExactPose, parts: &[Part], others: &[Part]) -> bool {
    let pairs = parts
        .iter()
        .flat_map(|part| others.iter().map(move |other| (part, other)));
    pairs.into_iter().any(|((at_1, body_1), (at_2, body_2))| {
        let inverse = at_1.inverse();
        let between = ExactPose {
            rotation: inverse.rotation * pose.rotation * at_2.rotation,
            translation: inverse.apply(pose.apply(at_2.translation)),
        };
        let difference = Difference::new([body_1, body_2], between);
        difference.signed_distance().upper < -LEAST_OVERLAP
    })
}

/// A normal may be corrected away at each part that overlaps, but not at all of them.
#[test]
fn what_overlaps_a_flagged_compound_has_a_contact() {
    let mut rng = Rng::new(17);
    let ours = IsaGjkDispatcher::default();
    let mut overlapping = 0;
    for _ in 0..4_000 {
        let parts = parts(&mut rng);
        let shape = compound(&parts);
        let alone = |body: Body| {
            let shape = body.shape.clone();
            (vec![(ExactPose::default(), body)], shape)
        };
        let (others, other) = match rng.count(0, 4) {
            0 => (parts.clone(), shape.clone()),
            1 => alone(rounded(&mut rng)),
            _ => alone(body(&mut rng)),
        };
        let pose = ExactPose {
            translation: rng.direction() * rng.range(0.1, 0.9),
            rotation: rng.rotation(),
        };
        let pose = pose.rounded();
        if !overlap(pose, &parts, &others) {
            continue;
        }
        overlapping += 1;
        let mut memory = Memory::default();
        let Memory {
            manifolds,
            workspace,
        } = &mut memory;
        let shapes = [&*shape, &*other];
        let updated = ours.update_manifolds(&pose.to_f32(), shapes, 0.02, manifolds, workspace);
        assert!(updated.is_ok());
        let contacts: usize = memory.manifolds.iter().map(|m| m.points.len()).sum();
        assert!(
            contacts > 0,
            "{pose:?}: {:?}",
            Compound::shapes(shape.as_compound().expect("a compound"))
        );
    }
    assert!(overlapping > 1_500, "only {overlapping} overlap");
}
