//! Manifolds of pairs at rest, of which only the distances change.
//!
//! Contacts and normals are left as they are if the shapes turned by no more than [`STILL_TILT`] against each other
//! since the normals were stored, and if the deepest contact shows the signed distance up to [`STILL_DEPTH`]. Each
//! contact is then reported as it is measured along the normal. A query certifies the distance, or a certificate of an
//! earlier pose does: what the manifold becomes is the same.

use glam::DVec3;

use super::erased::ErasedManifold;
use super::kernel_manifold::KernelManifold;
use super::own_contacts::{ContactTag, ContactsOnShape, some_is_on_both};
use crate::parry::convert::HalfSpace;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::parry::still_cache::{StillCache, StillPair};
use crate::pose::RelativePose;
use crate::query::{LastContacts, first_least};
use crate::simd::LANES;
use crate::support::{Cso, Support};
use crate::tolerance::{DEPTH_ERROR, KEPT_DRIFT, STILL_DEPTH, STILL_TILT};

/// The contacts of a manifold at the present pose.
#[derive(Default)]
pub(super) struct PresentContacts {
    /// Once they are read.
    pub last: Option<LastContacts>,
    /// If they may stay as they are.
    pub still: Option<Still>,
}

/// Contacts of a pair at rest, measured along the stored normal at the present pose.
pub(super) struct Still {
    distances: [f64; LANES],
    /// The least of them, and thus that of the shapes, if nothing has to change.
    least: f64,
    pair: StillPair,
    /// Tells the contacts and the shapes from others.
    tag: u64,
    /// Whether the contacts are known to belong to the shapes.
    are_own: bool,
}

impl PresentContacts {
    /// Reads the contacts, and measures them unless they have left their places.
    // perf: inlined, it costs pairs that move 2 % more instructions. Returning the answers would copy them.
    #[inline(never)]
    pub fn read(
        &mut self,
        manifold: &KernelManifold<'_, '_>,
        pose: &RelativePose,
        pair: StillPair,
    ) {
        manifold.read_contacts(pose, &mut self.last);
        if let (Some(last), Some([normal, _])) = (&self.last, manifold.normals())
            && last.are_within(normal, KEPT_DRIFT * pair.radius)
        {
            let distances = last.distances(normal).to_array();
            let least = distances[first_least(distances)];
            self.still = Some(Still {
                distances,
                least,
                tag: ContactTag::new(pair.shapes, last.fingerprint())
                    .along(manifold.stored_normal()),
                pair,
                are_own: false,
            });
        }
    }
}

impl Still {
    /// Whether an earlier certificate proves that a query up to a maximum distance would leave the contacts as they
    /// are.
    #[inline]
    pub fn is_proved(
        &self,
        cache: &StillCache,
        max_distance: f64,
        [border_1, border_2]: [f64; 2],
    ) -> bool {
        let distance = self.least + border_1 + border_2;
        let tolerance = (STILL_DEPTH - DEPTH_ERROR) * self.pair.radius;
        distance + tolerance <= max_distance
            && cache.proves(&self.pair, self.tag, distance, tolerance)
    }

    /// Looks up whether the contacts belong to the shapes.
    #[inline]
    pub fn find_own(&mut self, cache: &StillCache) {
        self.are_own = cache.are_own(self.pair.key, self.tag);
    }

    /// Whether the contacts stay as they are if the shapes have this signed distance.
    #[inline]
    pub fn shows(&self, signed_distance: f64) -> bool {
        (self.least - signed_distance).abs() <= STILL_DEPTH * self.pair.radius
    }

    /// Whether the contacts belong to the shapes of the pair.
    #[inline]
    pub fn is_of<A: Support, B: Support>(
        &self,
        cso: &Cso<'_, A, B>,
        (manifold, border_radii): (&KernelManifold<'_, '_>, [f64; 2]),
        last: &LastContacts,
    ) -> bool {
        let points = || last.points(cso.pose);
        self.are_own
            || self.depths_match((manifold, border_radii), points, |[on_1, on_2]| {
                Some([on_1.depths(cso.shape_1)?, on_2.depths(cso.shape_2)?])
            })
    }

    /// The same for a half-space.
    #[inline]
    pub fn is_of_half_space(
        &self,
        pair: &Pair<'_, HalfSpace>,
        pose: &RelativePose,
        manifold: &KernelManifold<'_, '_>,
        last: &LastContacts,
    ) -> bool {
        let points = || last.points(pose);
        self.are_own
            || self.depths_match((manifold, pair.border_radii), points, |[on_1, on_2]| {
                Some([on_1.depths(pair.hull)?, on_2.depths_in(pair.other)?])
            })
    }

    /// Whether the contacts have the `depths` of contacts that belong to the shapes.
    #[inline(never)]
    fn depths_match(
        &self,
        (manifold, border_radii): (&KernelManifold<'_, '_>, [f64; 2]),
        points: impl FnOnce() -> [[DVec3; LANES]; 2],
        depths: impl FnOnce([ContactsOnShape<'_>; 2]) -> Option<[[f64; LANES]; 2]>,
    ) -> bool {
        let Some(normals) = manifold.normals() else {
            return false;
        };
        let points = points();
        let on = |shape: usize| ContactsOnShape {
            points: &points[shape],
            normal: normals[shape],
            border_radius: border_radii[shape],
            radius: self.pair.radius,
        };
        depths([on(0), on(1)]).is_some_and(|depths| some_is_on_both(depths, self.pair.radius))
    }

    /// Stores the signed distance of the cores, which was certified, and that the contacts belong to the shapes.
    pub fn store(&self, cache: &mut StillCache, core_distance: f64) {
        cache.store(&self.pair, self.tag, core_distance);
        if !self.are_own {
            *cache.own_contacts(self.pair.key) = self.tag;
        }
    }
}

/// Whether a manifold has contacts whose normals the shapes hardly turned against since they were stored.
#[inline]
pub(super) fn is_settled(
    manifold: &ErasedManifold<'_>,
    order: PairOrder,
    pose: &RelativePose,
) -> bool {
    let [n1, n2] = order.to_kernel([*manifold.local_n1, *manifold.local_n2]);
    let turned = n1.as_dvec3() + pose.direction_to_1(n2.as_dvec3());
    !manifold.is_empty() && turned.length_squared() <= STILL_TILT * STILL_TILT
}

impl ErasedManifold<'_> {
    /// Writes the distances, and leaves everything else.
    #[inline]
    pub(super) fn hold(&mut self, still: &Still) {
        self.points_mut().set_distances(&still.distances);
    }
}
