//! The points of a manifold, and what they inherit from those of the frame before.

use glam::Vec3;
use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use wide::{f32x4, u32x4};

use super::cache;
use crate::manifold::{Contacts, MAX_POINTS};

/// Replaces the manifold's points, and hands the data (the solver's impulses) of the old ones on.
///
/// How many points there are and which of them are old is not predictable, and branches that go
/// wrong cost more than the work: so all that a manifold can have are computed, wanted or not.
pub(super) fn write_points<M, C: Default + Copy>(
    manifold: &mut ContactManifold<M, C>,
    contacts: &Contacts,
    borders: [f64; 2],
    swapped: bool,
) {
    let normals = cache::ordered([manifold.local_n1, manifold.local_n2], swapped);
    let at_border = |points: &[f32x4; 3], side: usize| {
        let border = normals[side] * borders[side] as Real;
        [0, 1, 2].map(|axis| (points[axis] + border[axis]).to_array())
    };
    let points = [at_border(&contacts.on_1, 0), at_border(&contacts.on_2, 1)];
    let distances = (contacts.distance - (borders[0] + borders[1]) as Real).to_array();
    let (side_1, side_2) = (usize::from(swapped), usize::from(!swapped));
    let place = |lane: usize| {
        let point = |side: usize| Vec3::from(points[side].map(|row| row[lane]));
        let fid = |side: usize| cache::pack(contacts.features[lane][side]);
        TrackedContact {
            local_p1: point(side_1),
            local_p2: point(side_2),
            dist: distances[lane],
            fid1: fid(side_1),
            fid2: fid(side_2),
            data: (),
        }
    };
    let places = [place(0), place(1), place(2), place(3)];
    let count = contacts.len;
    let tracked = &mut manifold.points;
    let old = Identities::of(tracked);
    let new = Identities::of_first(&places, count);
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
    let data = |i: usize| tracked.get(i).map_or_else(C::default, |old| old.data);
    let inheritance = [data(0), data(1), data(2), data(3), C::default()];
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

/// What the contacts of a manifold are between, see [`cache::identity`]: by the first shape, and by the
/// second.
struct Identities([u32x4; 2]);

impl Identities {
    /// Of a manifold; of contacts that it could have beside its own, nothing.
    #[inline(always)]
    fn of<C>(contacts: &[TrackedContact<C>]) -> Self {
        if let Some(four) = contacts.first_chunk() {
            return Self::of_first(four, MAX_POINTS);
        }
        let [mut first, mut second] = [[0; MAX_POINTS]; 2];
        for (i, contact) in contacts.iter().enumerate() {
            [first[i], second[i]] = [contact.fid1.0, contact.fid2.0];
        }
        Self(cache::identities([first.into(), second.into()]))
    }

    /// Of so many; of the others, nothing.
    #[inline(always)]
    fn of_first<C>([a, b, c, d]: &[TrackedContact<C>; MAX_POINTS], count: usize) -> Self {
        let counted = u32x4::new([0, 1, 2, 3]).simd_lt(u32x4::splat(count as u32));
        let first = u32x4::new([a.fid1.0, b.fid1.0, c.fid1.0, d.fid1.0]);
        let second = u32x4::new([a.fid2.0, b.fid2.0, c.fid2.0, d.fid2.0]);
        Self(cache::identities([first & counted, second & counted]))
    }

    /// A bit for each that is the same as one of the others.
    #[inline(always)]
    fn same(&self, others: &Self, one: usize) -> u32 {
        let [a, b] = [0, 1].map(|side| {
            let one = u32x4::splat(others.0[side].to_array()[one]);
            self.0[side].simd_eq(one)
        });
        (a & b).to_bitmask()
    }
}

impl PartialEq for Identities {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        let [a, b] = [0, 1].map(|side| self.0[side] ^ other.0[side]);
        !(a | b).any()
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
    for (i, heir) in heirs.iter_mut().enumerate() {
        let candidates = old_ids.same(new_ids, i) & left;
        *heir = (candidates.trailing_zeros() as usize).min(NONE);
        // All but the lowest one.
        left ^= candidates & candidates.wrapping_neg();
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
