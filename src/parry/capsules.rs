//! Manifolds of two capsules. Parry's routine makes one contact of them, so logs never lie still.

use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, TrackedContact, Unsupported};
use parry3d::shape::{Capsule as ParryCapsule, PackedFeatureId, Shape};

use crate::manifold::capsules::{Capsule, CapsuleContact, CapsuleContacts, Place};
use crate::map_pair::map_pair;
use crate::parry::pair::valid_pose;
use crate::pose::RelativePose;

/// Brings the manifold of two capsules up to date; other shapes are not supported.
pub(crate) fn update_capsules<M, C: Default + Copy>(
    pos12: &Pose,
    shapes: [&dyn Shape; 2],
    prediction: Real,
    manifold: &mut ContactManifold<M, C>,
) -> Result<(), Unsupported> {
    let [Some(first), Some(second)] = map_pair(shapes, plain_capsule) else {
        return Err(Unsupported);
    };
    let pose = RelativePose::from(valid_pose(pos12)?);
    let second = Capsule {
        a: pose.point_to_1(second.a),
        b: pose.point_to_1(second.b),
        radius: second.radius,
    };
    let old = std::mem::take(&mut manifold.points);
    manifold.clear();
    let Some(contacts) = CapsuleContacts::new([first, second], prediction.into()) else {
        return Ok(());
    };
    manifold.local_n1 = contacts.normal.as_vec3();
    manifold.local_n2 = pose.direction_to_2(-contacts.normal).as_vec3();
    let tracked = |contact: &CapsuleContact| {
        let id = match contact.place {
            Place::Deepest => PackedFeatureId::edge(0),
            Place::FirstEnd => PackedFeatureId::vertex(0),
            Place::SecondEnd => PackedFeatureId::vertex(1),
        };
        let [p1, p2] = contact.points;
        let p2 = pose.point_to_2(p2).as_vec3();
        TrackedContact::new(p1.as_vec3(), p2, id, id, contact.distance as Real)
    };
    manifold.points.extend(contacts.iter().map(tracked));
    manifold.match_contacts(&old);
    Ok(())
}

/// A capsule that is solid: finite, with a radius. A shape of a user's own may only look like one.
fn plain_capsule(shape: &dyn Shape) -> Option<Capsule> {
    let capsule: &ParryCapsule = shape.as_shape()?;
    let [a, b] = [capsule.segment.a, capsule.segment.b].map(|p| p.as_dvec3());
    let radius = f64::from(capsule.radius);
    let is_solid = a.is_finite() && b.is_finite() && radius.is_finite() && radius > 0.0;
    is_solid.then_some(Capsule { a, b, radius })
}
