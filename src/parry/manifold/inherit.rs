//! The points of a manifold, and the data that they inherit from the previous frame.

use glam::Vec3;
use parry3d::math::Real;
use parry3d::query::TrackedContact;
use parry3d::shape::PackedFeatureId;

use super::packed_feature::pack;
use crate::at::to_u32;
use crate::manifold::{Contacts, MAX_POINTS};
use crate::map_pair::map_pair;
use crate::parry::order::PairOrder;
use crate::query::{Feature, contact_keys};
use crate::simd::{f32x4, u32x4};

/// Replaces the contacts. The new ones inherit the data of the old ones.
pub(super) fn replace<C: Default + Copy>(
    tracked: &mut Vec<TrackedContact<C>>,
    new_points: &ManifoldPoints,
) {
    let count = new_points.count;
    let old = FeatureKeys::of(tracked);
    let new = FeatureKeys::new(new_points.features, count);
    if old == new && tracked.len() == count {
        for (i, tracked) in tracked.iter_mut().enumerate() {
            *tracked = new_points.tracked(i, tracked.data);
        }
        return;
    }
    let matches = match_old_points(tracked, &old, new_points, &new);
    let data = |i: usize| tracked.get(i).map_or_else(C::default, |old| old.data);
    let inheritance = [data(0), data(1), data(2), data(3), C::default()];
    tracked.clear();
    tracked.extend((0..count).map(|i| new_points.tracked(i, inheritance[matches[i]])));
}

/// Replaces the contacts. The new ones inherit the data of old ones with the same ids.
pub(super) fn replace_by_ids<C: Default + Copy>(
    tracked: &mut Vec<TrackedContact<C>>,
    new_points: [Option<TrackedContact<()>>; 3],
) {
    let with_data = |new: TrackedContact<()>| {
        let is_same = |old: &&TrackedContact<C>| [old.fid1, old.fid2] == [new.fid1, new.fid2];
        let old = tracked.iter().find(is_same);
        TrackedContact {
            local_p1: new.local_p1,
            local_p2: new.local_p2,
            dist: new.dist,
            fid1: new.fid1,
            fid2: new.fid2,
            data: old.map_or_else(C::default, |old| old.data),
        }
    };
    let new_points = new_points.map(|new| new.map(with_data));
    // Reuses the memory of the points, so that a pair at rest allocates nothing.
    tracked.clear();
    tracked.extend(new_points.into_iter().flatten());
}

/// Positions and features of contacts in the manifold's order of the shapes, coordinate by coordinate. Unused
/// entries mean nothing.
pub(super) struct ManifoldPoints {
    pub count: usize,
    points: [[[f32; MAX_POINTS]; 3]; 2],
    distances: [f32; MAX_POINTS],
    features: [[u32; MAX_POINTS]; 2],
}

impl ManifoldPoints {
    #[inline(always)]
    pub fn new(
        contacts: &Contacts,
        normals: [Vec3; 2],
        border_radii: [f64; 2],
        order: PairOrder,
    ) -> Self {
        let at_border = |(points, shape): (&[f32x4; 3], usize)| {
            let [x, y, z] = *points;
            let to_border = normals[shape] * border_radii[shape] as Real;
            [
                (x + to_border.x).to_array(),
                (y + to_border.y).to_array(),
                (z + to_border.z).to_array(),
            ]
        };
        let [a, b, c, d] = &contacts.features;
        let packed = |shape: usize| {
            let packed_id = |features: &[Feature; 2]| pack(features[shape]).0;
            [packed_id(a), packed_id(b), packed_id(c), packed_id(d)]
        };
        // References, since which one comes first is selected.
        let of_shapes = order.to_caller([(&contacts.on_1, 0), (&contacts.on_2, 1)]);
        Self {
            count: contacts.len,
            points: map_pair(of_shapes, at_border),
            distances: (contacts.distance - (border_radii[0] + border_radii[1]) as Real).to_array(),
            features: map_pair(of_shapes, |(_, shape)| packed(shape)),
        }
    }

    #[inline(always)]
    fn point(&self, shape: usize, i: usize) -> Vec3 {
        let [x, y, z] = &self.points[shape];
        Vec3::new(x[i], y[i], z[i])
    }

    #[inline(always)]
    fn tracked<C>(&self, i: usize, data: C) -> TrackedContact<C> {
        let [fid1, fid2] = map_pair([0, 1], |shape| PackedFeatureId(self.features[shape][i]));
        TrackedContact {
            local_p1: self.point(0, i),
            local_p2: self.point(1, i),
            dist: self.distances[i],
            fid1,
            fid2,
            data,
        }
    }
}

/// The keys of a manifold's contacts on the first and the second shape, see [`contact_keys`].
struct FeatureKeys([u32x4; 2]);

impl FeatureKeys {
    /// The keys of a manifold's contacts. Lanes beyond the last contact have none.
    #[inline(always)]
    fn of<C>(contacts: &[TrackedContact<C>]) -> Self {
        if let Some([a, b, c, d]) = contacts.first_chunk() {
            let first = [a.fid1.0, b.fid1.0, c.fid1.0, d.fid1.0];
            let second = [a.fid2.0, b.fid2.0, c.fid2.0, d.fid2.0];
            return Self::new([first, second], MAX_POINTS);
        }
        let [mut first, mut second] = [[0; MAX_POINTS]; 2];
        for (i, contact) in contacts.iter().enumerate() {
            [first[i], second[i]] = [contact.fid1.0, contact.fid2.0];
        }
        Self::new([first, second], contacts.len())
    }

    /// From the packed features of the first `count` contacts. The others have none.
    #[inline(always)]
    fn new([first, second]: [[u32; MAX_POINTS]; 2], count: usize) -> Self {
        debug_assert!(count <= MAX_POINTS, "{count} contacts");
        let counted = u32x4::new([0, 1, 2, 3]).simd_lt(u32x4::splat(to_u32(count)));
        let features = map_pair([first, second], |row| u32x4::new(row) & counted);
        Self(contact_keys(features))
    }

    /// A bit for each key that equals one of the others.
    #[inline(always)]
    fn same(&self, others: &Self, one: usize) -> u32 {
        let [a, b] = map_pair([0, 1], |shape| {
            let one = u32x4::splat(others.0[shape].to_array()[one]);
            self.0[shape].simd_eq(one)
        });
        (a & b).to_bitmask()
    }
}

impl PartialEq for FeatureKeys {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        let [a, b] = map_pair([0, 1], |shape| self.0[shape] ^ other.0[shape]);
        !(a | b).any()
    }
}

/// Index meaning "no old point matched".
const NONE: usize = MAX_POINTS;

/// For each new contact, the old contact whose data it inherits: the one between the same features. Without
/// such a match it is the nearest old contact that is left, however far away: for the solver, an impulse in
/// the wrong place of the patch is a better start than a body that rests on three contacts of four.
/// (Manifolds of other dispatchers may have more points than ours; the others pass on nothing.)
fn match_old_points<C>(
    old: &[TrackedContact<C>],
    old_ids: &FeatureKeys,
    new_points: &ManifoldPoints,
    new_ids: &FeatureKeys,
) -> [usize; MAX_POINTS] {
    let old = &old[..old.len().min(MAX_POINTS)];
    let mut matches = [NONE; MAX_POINTS];
    // A bit for each old point that is not matched yet.
    let mut left = (1_u32 << old.len()) - 1;
    for (i, matched) in matches[..new_points.count].iter_mut().enumerate() {
        let candidates = old_ids.same(new_ids, i) & left;
        *matched = (candidates.trailing_zeros() as usize).min(NONE);
        // Clears the lowest bit.
        left ^= candidates & candidates.wrapping_neg();
    }
    if left == 0 {
        return matches;
    }
    let unmatched = matches[..new_points.count].iter_mut().enumerate();
    for (i, matched) in unmatched.filter(|(_, matched)| **matched == NONE) {
        let place = new_points.point(0, i);
        let away = |j: &usize| old[*j].local_p1.distance_squared(place);
        let others = (0..old.len()).filter(|j| left >> j & 1 == 1);
        if let Some(j) = others.min_by(|j, k| away(j).total_cmp(&away(k))) {
            *matched = j;
            left &= !(1 << j);
        }
    }
    matches
}
