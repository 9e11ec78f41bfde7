//! The points of a manifold, and what they inherit from those of the frame before.

use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};

use super::cache;
use crate::both::both;
use crate::manifold::{ContactPoint, Contacts, MAX_POINTS};
use crate::pose::RelativePose;

/// Replaces the manifold's points, and hands the data (the solver's impulses) of the old ones on.
///
/// How many points there are and which of them are old is not predictable, and branches that go
/// wrong cost more than the work: so all that a manifold can have are computed, wanted or not.
pub(super) fn write_points<M, C: Default + Copy>(
    manifold: &mut ContactManifold<M, C>,
    pose: &RelativePose,
    contacts: &Contacts,
    borders: [f64; 2],
    swapped: bool,
) {
    let normals = cache::ordered([manifold.local_n1, manifold.local_n2], swapped);
    let [n1, n2] = both(normals, |n| n.as_dvec3());
    let count = contacts.as_slice().len();
    let place = |contact: &ContactPoint| {
        let points = [
            contact.on_1 + n1 * borders[0],
            pose.point_to_2(contact.on_2) + n2 * borders[1],
        ];
        let [local_p1, local_p2] = cache::ordered(both(points, |p| p.as_vec3()), swapped);
        let [fid1, fid2] = cache::ordered(both(contact.features, cache::pack), swapped);
        TrackedContact {
            local_p1,
            local_p2,
            dist: (contact.distance - borders[0] - borders[1]) as Real,
            fid1,
            fid2,
            data: (),
        }
    };
    let [a, b, c, d] = contacts.padded();
    let places = [place(a), place(b), place(c), place(d)];
    let tracked = &mut manifold.points;
    let old = Identities::of(tracked);
    let new = Identities::of(&places[..count]);
    if old == new && tracked.len() == count {
        for (tracked, place) in tracked.iter_mut().zip(&places) {
            // Copies of the data would cost more than all the rest.
            tracked.local_p1 = place.local_p1;
            tracked.local_p2 = place.local_p2;
            tracked.dist = place.dist;
            tracked.fid1 = place.fid1;
            tracked.fid2 = place.fid2;
        }
        return;
    }
    let heirs = heirs(tracked, &old, &places[..count], &new);
    let mut inheritance = [C::default(); MAX_POINTS + 1];
    for (data, tracked) in inheritance.iter_mut().zip(&**tracked).take(MAX_POINTS) {
        *data = tracked.data;
    }
    tracked.clear();
    let points = places.iter().zip(heirs).take(count);
    tracked.extend(points.map(|(place, heir)| TrackedContact {
        local_p1: place.local_p1,
        local_p2: place.local_p2,
        dist: place.dist,
        fid1: place.fid1,
        fid2: place.fid2,
        data: inheritance[heir],
    }));
}

/// What the first contacts of a manifold are between; see [`cache::identity`].
#[derive(PartialEq)]
struct Identities([u64; MAX_POINTS]);

impl Identities {
    fn of<C>(contacts: &[TrackedContact<C>]) -> Self {
        let mut identities = Self([0; MAX_POINTS]);
        for (identity, contact) in identities.0.iter_mut().zip(contacts) {
            *identity = cache::identity([contact.fid1, contact.fid2]);
        }
        identities
    }
}

/// What inherits from no point.
const NONE: usize = MAX_POINTS;

/// For each new contact the old one whose data it takes over: that between the same features. What
/// is left over goes to the nearest of the others, however far: an impulse in a wrong place of the
/// patch is a better start for the solver than a body that is borne by three contacts of four.
/// (Of another dispatcher's manifold no more points than ours have hand their data on.)
fn heirs<C>(
    old: &[TrackedContact<C>],
    old_ids: &Identities,
    new: &[TrackedContact<()>],
    new_ids: &Identities,
) -> [usize; MAX_POINTS] {
    let old = &old[..old.len().min(MAX_POINTS)];
    let mut heirs = [NONE; MAX_POINTS];
    // A bit for each that has no heir yet.
    let mut left = (1_u32 << old.len()) - 1;
    for (heir, sought) in heirs.iter_mut().zip(new_ids.0) {
        for (j, id) in old_ids.0.into_iter().enumerate() {
            let same = (id == sought) & (left >> j & 1 == 1) & (*heir == NONE);
            *heir = if same { j } else { *heir };
            left &= !(u32::from(same) << j);
        }
    }
    if left == 0 {
        return heirs;
    }
    for (heir, new) in heirs.iter_mut().zip(new).filter(|(heir, _)| **heir == NONE) {
        let away = |j: &usize| old[*j].local_p1.distance_squared(new.local_p1);
        let others = (0..old.len()).filter(|j| left >> j & 1 == 1);
        if let Some(j) = others.min_by(|j, k| away(j).total_cmp(&away(k))) {
            *heir = j;
            left &= !(1 << j);
        }
    }
    heirs
}
