//! The contact of two capsules, in closed form.

use parry3d::math::{Pose, Real};
use parry3d::query::{Contact, Unsupported};
use parry3d::shape::Shape;

use crate::manifold::capsules::CapsuleContacts;
use crate::parry::capsules::pair_in_frame_1;

/// The deepest contact of capsules that overlap or are at most `prediction` apart; other shapes are not
/// supported.
pub(super) fn contact(
    pos12: &Pose,
    shapes: [&dyn Shape; 2],
    prediction: Real,
) -> Result<Option<Contact>, Unsupported> {
    let (pose, capsules) = pair_in_frame_1(pos12, shapes)?;
    let Some(contacts) = CapsuleContacts::new(capsules, prediction.into()) else {
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
