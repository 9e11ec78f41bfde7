//! The points of a manifold, and what they inherit from those of the frame before.

use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use super::cache;
use crate::manifold::{ContactPoint, Contacts, MAX_POINTS};
use crate::pose::RelativePose;

/// Replaces the manifold's points, and hands the data (the solver's impulses) of the old ones on.
pub(super) fn write_points<M, C: Default + Copy>(
    manifold: &mut ContactManifold<M, C>,
    pose: &RelativePose,
    contacts: &Contacts,
    borders: [f64; 2],
    swapped: bool,
) {
    let normals = cache::ordered([manifold.local_n1, manifold.local_n2], swapped);
    let [n1, n2] = normals.map(|n| n.as_dvec3());
    let ids = |contact: &ContactPoint| cache::ordered(contact.features.map(cache::pack), swapped);
    let place = |contact: &ContactPoint| {
        let points = [
            contact.on_1 + n1 * borders[0],
            pose.point_to_2(contact.on_2) + n2 * borders[1],
        ];
        let [local_p1, local_p2] = cache::ordered(points.map(|p| p.as_vec3()), swapped);
        let [fid1, fid2] = ids(contact);
        TrackedContact {
            local_p1,
            local_p2,
            dist: (contact.distance - borders[0] - borders[1]) as Real,
            fid1,
            fid2,
            data: (),
        }
    };
    let contacts = contacts.as_slice();
    let tracked = &mut manifold.points;
    let old = Identities::of(tracked.iter().map(|contact| [contact.fid1, contact.fid2]));
    let new = Identities::of(contacts.iter().map(ids));
    if old == new && tracked.len() == contacts.len() {
        for (tracked, place) in tracked.iter_mut().zip(contacts.iter().map(place)) {
            // Copies of the data would cost more than all the rest.
            tracked.local_p1 = place.local_p1;
            tracked.local_p2 = place.local_p2;
            tracked.dist = place.dist;
            tracked.fid1 = place.fid1;
            tracked.fid2 = place.fid2;
        }
        return;
    }
    let places = contacts.iter().map(place);
    let heirs = heirs(tracked, &old, places.clone(), &new);
    let data = heirs.map(|heir| heir.map_or_else(C::default, |j| tracked[j].data));
    tracked.clear();
    tracked.extend(places.zip(data).map(|(place, data)| TrackedContact {
        local_p1: place.local_p1,
        local_p2: place.local_p2,
        dist: place.dist,
        fid1: place.fid1,
        fid2: place.fid2,
        data,
    }));
}

/// What the first contacts of a manifold are between; see [`cache::identity`].
#[derive(PartialEq)]
struct Identities([u64; MAX_POINTS]);

impl Identities {
    fn of(contacts: impl Iterator<Item = [PackedFeatureId; 2]>) -> Self {
        let mut identities = Self([0; MAX_POINTS]);
        for (identity, ids) in identities.0.iter_mut().zip(contacts) {
            *identity = cache::identity(ids);
        }
        identities
    }
}

/// For each new contact the old one whose data it takes over: that between the same features. What
/// is left over goes to the nearest of the others, however far: an impulse in a wrong place of the
/// patch is a better start for the solver than a body that is borne by three contacts of four.
/// (Of another dispatcher's manifold no more points than ours have hand their data on.)
fn heirs<C>(
    old: &[TrackedContact<C>],
    old_ids: &Identities,
    new: impl Iterator<Item = TrackedContact<()>>,
    new_ids: &Identities,
) -> [Option<usize>; MAX_POINTS] {
    let old = &old[..old.len().min(MAX_POINTS)];
    let mut heirs = [None; MAX_POINTS];
    let mut left = [true; MAX_POINTS];
    for (heir, sought) in heirs.iter_mut().zip(&new_ids.0) {
        for (j, (id, left)) in old_ids.0.iter().zip(&mut left).take(old.len()).enumerate() {
            if id == sought {
                *heir = Some(j);
                *left = false;
            }
        }
    }
    for (heir, new) in heirs.iter_mut().zip(new).filter(|(heir, _)| heir.is_none()) {
        let away = |j: &usize| old[*j].local_p1.distance_squared(new.local_p1);
        let others = (0..old.len()).filter(|j| left[*j]);
        *heir = others.min_by(|j, k| away(j).total_cmp(&away(k)));
        if let Some(j) = *heir {
            left[j] = false;
        }
    }
    heirs
}
