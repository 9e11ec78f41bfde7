//! Manifolds of two capsules. parry's routine finds only one contact, with which logs never rest.

use parry3d::math::{Pose, Real};
use parry3d::query::{TrackedContact, Unsupported};
use parry3d::shape::{Capsule as ParryCapsule, PackedFeatureId, Shape};

use crate::manifold::capsules::{Capsule, CapsuleContact, CapsuleContacts, Place};
use crate::map_pair::map_pair;
use crate::parry::far_apart::is_answered_by_reach;
use crate::parry::manifold::UpdateManifold;
use crate::parry::pair::valid_pose;
use crate::pose::RelativePose;
use crate::stats::Stage;

/// Updates the manifold of two capsules.
pub(crate) fn update_capsules(
    update: &mut UpdateManifold<'_>,
    shapes: [&dyn Shape; 2],
) -> Result<(), Unsupported> {
    if is_answered_by_reach(shapes, update) {
        return Ok(());
    }
    let (pose, capsules) = pair_in_frame_1(update.pos12, shapes)?;
    update.stats.record_free(Stage::Feature);
    let manifold = &mut update.manifold;
    let Some(contacts) = CapsuleContacts::new(capsules, update.prediction.into()) else {
        manifold.clear();
        return Ok(());
    };
    *manifold.local_n1 = contacts.normal.as_vec3();
    *manifold.local_n2 = pose.direction_to_2(-contacts.normal).as_vec3();
    let tracked = |contact: CapsuleContact| {
        let id = id_of(contact.place);
        let [p1, p2] = contact.points;
        let p2 = pose.point_to_2(p2).as_vec3();
        TrackedContact::new(p1.as_vec3(), p2, id, id, contact.distance as Real)
    };
    manifold.replace_by_ids(contacts.in_places.map(|contact| contact.map(tracked)));
    Ok(())
}

/// The feature id of a contact, on both capsules.
fn id_of(place: Place) -> PackedFeatureId {
    match place {
        Place::Deepest => PackedFeatureId::edge(0),
        Place::FirstEnd => PackedFeatureId::vertex(0),
        Place::SecondEnd => PackedFeatureId::vertex(1),
    }
}

/// Two capsules in frame 1. Other shapes are not supported.
pub(crate) fn pair_in_frame_1(
    pos12: &Pose,
    shapes: [&dyn Shape; 2],
) -> Result<(RelativePose, [Capsule; 2]), Unsupported> {
    let [Some(first), Some(second)] = map_pair(shapes, plain_capsule) else {
        return Err(Unsupported);
    };
    let pose = RelativePose::from(valid_pose(pos12)?);
    let second = Capsule {
        a: pose.point_to_1(second.a),
        b: pose.point_to_1(second.b),
        radius: second.radius,
    };
    Ok((pose, [first, second]))
}

/// The shape as a capsule, if it is finite and has a radius. A user's own shape may only look like a capsule.
fn plain_capsule(shape: &dyn Shape) -> Option<Capsule> {
    let capsule: &ParryCapsule = shape.as_shape()?;
    let [a, b] = [capsule.segment.a, capsule.segment.b].map(|p| p.as_dvec3());
    let radius = f64::from(capsule.radius);
    let is_solid = a.is_finite() && b.is_finite() && radius.is_finite() && radius > 0.0;
    is_solid.then_some(Capsule { a, b, radius })
}
