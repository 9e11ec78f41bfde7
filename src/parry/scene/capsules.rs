//! The contact of two capsules, in closed form.

use parry3d::math::{Pose, Real};
use parry3d::query::{Contact, Unsupported};
use parry3d::shape::Shape;

use crate::manifold::capsules::{Capsule, CapsuleContacts};
use crate::map_pair::map_pair;
use crate::parry::capsules::plain_capsule;
use crate::parry::pair::valid_pose;
use crate::pose::RelativePose;

/// The deepest contact of capsules that overlap or are at most `prediction` apart; other shapes are not
/// supported.
pub(super) fn contact(
    pos12: &Pose,
    shapes: [&dyn Shape; 2],
    prediction: Real,
) -> Result<Option<Contact>, Unsupported> {
    let [Some(first), Some(second)] = map_pair(shapes, plain_capsule) else {
        return Err(Unsupported);
    };
    let pose = RelativePose::from(valid_pose(pos12)?);
    let second = Capsule {
        a: pose.point_to_1(second.a),
        b: pose.point_to_1(second.b),
        radius: second.radius,
    };
    let Some(contacts) = CapsuleContacts::new([first, second], prediction.into()) else {
        return Ok(None);
    };
    let deepest = contacts
        .iter()
        .min_by(|a, b| a.distance.total_cmp(&b.distance));
    Ok(deepest.map(|deepest| {
        let [on_1, on_2] = deepest.points;
        Contact::new(
            on_1.as_vec3(),
            pose.point_to_2(on_2).as_vec3(),
            contacts.normal.as_vec3(),
            pose.direction_to_2(-contacts.normal).as_vec3(),
            deepest.distance as Real,
        )
    }))
}
