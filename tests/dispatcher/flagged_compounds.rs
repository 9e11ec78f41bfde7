//! Compounds whose normals are corrected at the seams between their parts.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::QueryDispatcher;
use parry3d::shape::{Compound, CompoundFlags, SharedShape};
use testkit::generate::{Rng, prepared};
use testkit::memory::{Memory, UpdateManifolds};
use testkit::scenes::hulls::cuboid;

/// A part of one of the kinds that decompositions and users have.
fn part(rng: &mut Rng) -> SharedShape {
    let half = Vector::new(0.2, 0.3, 0.25) * rng.range(0.5, 1.5) as Real;
    match rng.count(0, 4) {
        0 => SharedShape::ball(half.x),
        1 => SharedShape::cylinder(half.y, half.x),
        2 => SharedShape::cuboid(half.x, half.y, half.z),
        3 => cuboid(half).expect("a box"),
        _ => prepared(&cuboid(half).expect("a box")),
    }
}

/// A normal may be corrected away at each part that overlaps, but not at all of them.
#[test]
fn what_overlaps_a_flagged_compound_has_a_contact() {
    let mut rng = Rng::new(17);
    let ours = IsaGjkDispatcher::default();
    let mut overlapping = 0;
    for _ in 0..4_000 {
        let parts = (0..rng.count(2, 5)).map(|_| {
            let place = (rng.direction() * rng.range(0.0, 0.5)).as_vec3();
            let pose = if rng.count(0, 1) == 0 {
                Pose::from_translation(place)
            } else {
                Pose::from_parts(place, rng.rotation().as_quat())
            };
            (pose, part(&mut rng))
        });
        let parts: Vec<_> = parts.collect();
        let flags = CompoundFlags::FIX_INTERNAL_EDGES;
        let compound = SharedShape::new(Compound::with_flags(parts, flags, None));
        let other = match rng.count(0, 3) {
            0 => compound.clone(),
            _ => part(&mut rng),
        };
        let place = (rng.direction() * rng.range(0.1, 0.9)).as_vec3();
        let pose = Pose::from_parts(place, rng.rotation().as_quat());
        let shapes = [&*compound, &*other];
        let meets = ours.intersection_test(&pose, shapes[0], shapes[1]);
        if !meets.is_ok_and(|meets| meets.intersecting) {
            continue;
        }
        overlapping += 1;
        let mut memory = Memory::default();
        let Memory {
            manifolds,
            workspace,
        } = &mut memory;
        let updated = ours.update_manifolds(&pose, shapes, 0.02, manifolds, workspace);
        assert!(updated.is_ok());
        let contacts: usize = memory.manifolds.iter().map(|m| m.points.len()).sum();
        assert!(
            contacts > 0,
            "{pose:?}: {:?}",
            compound.as_compound().map(Compound::shapes)
        );
    }
    assert!(overlapping > 1_500, "only {overlapping} overlap");
}
