//! A contact manifold without the type of the data that the solver keeps in it. So updates are compiled once, with
//! this crate, and not in every program that steps a world.

use glam::Vec3;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use super::inherit::{ManifoldPoints, replace, replace_by_ids};
use crate::parry::order::PairOrder;
use crate::pose::RelativePose;
use crate::query::LastContacts;
use crate::simd::{DVec3x4, LANES, coordinates, widened};

/// What updates read and write of a manifold.
pub(crate) struct ErasedManifold<'a> {
    pub local_n1: &'a mut Vec3,
    pub local_n2: &'a mut Vec3,
    points: &'a mut dyn ErasedPoints,
    is_empty: bool,
    key: u64,
}

impl<'a> ErasedManifold<'a> {
    #[inline]
    pub fn new<M, C: Default + Copy>(manifold: &'a mut ContactManifold<M, C>) -> Self {
        let key = (&raw const *manifold).addr() as u64;
        Self {
            local_n1: &mut manifold.local_n1,
            local_n2: &mut manifold.local_n2,
            is_empty: manifold.points.is_empty(),
            points: &mut manifold.points,
            key,
        }
    }

    /// The address of the manifold, which is usually the same in the next frame.
    #[inline]
    pub fn key(&self) -> u64 {
        self.key
    }

    /// Whether there are no contacts.
    // A field: pairs that are apart ask several times, and would notice the calls.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.is_empty
    }

    #[inline]
    pub(super) fn points(&self) -> &dyn ErasedPoints {
        &*self.points
    }

    /// For changes that leave the number of contacts.
    #[inline]
    pub(super) fn points_mut(&mut self) -> &mut dyn ErasedPoints {
        self.points
    }

    /// Removes the contacts.
    #[inline]
    pub fn clear(&mut self) {
        if !self.is_empty {
            self.points.clear();
            self.is_empty = true;
        }
    }

    /// Clears the memory of a pair whose bounding spheres are apart. To store an axis would cost a root and a
    /// division, which is more than it would save the next query.
    #[inline]
    pub fn forget(&mut self) {
        self.clear();
        *self.local_n1 = Vec3::ZERO;
    }

    /// Replaces the contacts. The new ones inherit the data of the old ones.
    #[inline]
    pub(super) fn replace(&mut self, points: &ManifoldPoints) {
        self.points.replace(points);
        self.is_empty = points.count == 0;
    }

    /// Replaces the contacts. The new ones inherit the data of old ones with the same ids.
    pub fn replace_by_ids(&mut self, points: [Option<TrackedContact<()>>; 3]) {
        self.points.replace_by_ids(points);
        self.is_empty = points.iter().all(Option::is_none);
    }

    /// The ids of all contacts, in the caller's order of the shapes.
    #[inline]
    pub fn features(&self) -> impl Iterator<Item = [PackedFeatureId; 2]> {
        (0..).map_while(|i| self.points.features(i))
    }
}

/// The contacts of a manifold.
pub(super) trait ErasedPoints {
    /// The index of the contact that was deepest in the previous frame.
    fn deepest(&self) -> Option<usize>;

    fn distance(&self, contact: usize) -> Option<f32>;

    /// The points on the kernels' first shape, as [`read`](Self::read) reads them.
    fn places(&self, order: PairOrder) -> Option<DVec3x4>;

    /// In the caller's order of the shapes.
    fn features(&self, contact: usize) -> Option<[PackedFeatureId; 2]>;

    fn set_features(&mut self, contact: usize, ids: [PackedFeatureId; 2]);

    /// Writes the distances of up to four contacts.
    fn set_distances(&mut self, distances: &[f64; LANES]);

    /// Reads the contacts at the present pose, if there are one to four. Lanes beyond the last contact repeat it.
    // Returning them would copy them: 1 % more instructions in touching/8.
    fn read(&self, order: PairOrder, pose: &RelativePose, last: &mut Option<LastContacts>);

    fn clear(&mut self);

    fn replace(&mut self, points: &ManifoldPoints);

    fn replace_by_ids(&mut self, points: [Option<TrackedContact<()>>; 3]);
}

impl<C: Default + Copy> ErasedPoints for Vec<TrackedContact<C>> {
    fn deepest(&self) -> Option<usize> {
        let contacts = self.iter().enumerate();
        let deeper = contacts.reduce(|a, b| if b.1.dist < a.1.dist { b } else { a });
        deeper.map(|(i, _)| i)
    }

    fn distance(&self, contact: usize) -> Option<f32> {
        Some(self.get(contact)?.dist)
    }

    fn places(&self, order: PairOrder) -> Option<DVec3x4> {
        let places = of_lanes(lanes(self)?);
        Some(if order.is_reversed() {
            places(|contact| &contact.local_p2)
        } else {
            places(|contact| &contact.local_p1)
        })
    }

    fn features(&self, contact: usize) -> Option<[PackedFeatureId; 2]> {
        let contact = self.get(contact)?;
        Some([contact.fid1, contact.fid2])
    }

    fn set_features(&mut self, contact: usize, ids: [PackedFeatureId; 2]) {
        [self[contact].fid1, self[contact].fid2] = ids;
    }

    fn set_distances(&mut self, distances: &[f64; LANES]) {
        for (point, distance) in self.iter_mut().zip(distances) {
            point.dist = *distance as f32;
        }
    }

    fn read(&self, order: PairOrder, pose: &RelativePose, last: &mut Option<LastContacts>) {
        let Some(lanes) = lanes(self) else {
            return;
        };
        let points = of_lanes(lanes);
        let (on_1, on_2) = if order.is_reversed() {
            (points(|c| &c.local_p2), points(|c| &c.local_p1))
        } else {
            (points(|c| &c.local_p1), points(|c| &c.local_p2))
        };
        *last = Some(LastContacts::new(on_1, on_2, pose));
    }

    fn clear(&mut self) {
        self.clear();
    }

    fn replace(&mut self, points: &ManifoldPoints) {
        replace(self, points);
    }

    fn replace_by_ids(&mut self, points: [Option<TrackedContact<()>>; 3]) {
        replace_by_ids(self, points);
    }
}

/// One to four contacts, of which the last is repeated.
#[inline]
fn lanes<C>(contacts: &[TrackedContact<C>]) -> Option<[&TrackedContact<C>; LANES]> {
    Some(match contacts {
        [a] => [a, a, a, a],
        [a, b] => [a, b, b, b],
        [a, b, c] => [a, b, c, c],
        [a, b, c, d] => [a, b, c, d],
        _ => return None,
    })
}

/// Reads points of four contacts.
#[inline]
fn of_lanes<C>(
    lanes: [&TrackedContact<C>; LANES],
) -> impl Fn(fn(&TrackedContact<C>) -> &Vec3) -> DVec3x4 {
    move |of| DVec3x4(coordinates(lanes.map(of)).map(widened))
}
