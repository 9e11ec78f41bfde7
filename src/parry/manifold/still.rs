//! Manifolds of pairs at rest, of which only the distances change.
//!
//! Contacts and normals are left as they are if the shapes turned by no more than [`STILL_TILT`] against each other
//! since the normals were stored, and if the deepest contact shows the signed distance up to [`STILL_DEPTH`]. Each
//! contact is then reported as it is measured along the normal. A query certifies the distance, or a certificate of an
//! earlier pose does: what the manifold becomes is the same.

use super::erased::ErasedManifold;
use super::kernel_manifold::KernelManifold;
use crate::parry::order::PairOrder;
use crate::parry::still_cache::{StillCache, StillPair};
use crate::pose::RelativePose;
use crate::query::{LastContacts, first_least};
use crate::simd::LANES;
use crate::tolerance::{DEPTH_ERROR, KEPT_DRIFT, STILL_DEPTH, STILL_TILT};

/// Contacts of a pair at rest, measured along the stored normal at the present pose.
pub(super) struct Still {
    distances: [f64; LANES],
    /// The least of them, and thus that of the shapes, if nothing has to change.
    least: f64,
    pair: StillPair,
}

impl Still {
    /// Reads the contacts into `last`, and measures them in `still` unless they have left their places.
    // perf: inlined, it costs pairs that move 2 % more instructions. Returning the answers would copy them.
    #[inline(never)]
    pub fn read(
        manifold: &KernelManifold<'_, '_>,
        pose: &RelativePose,
        pair: StillPair,
        last: &mut Option<LastContacts>,
        still: &mut Option<Self>,
    ) {
        manifold.read_contacts(pose, last);
        if let (Some(last), Some([normal, _])) = (last, manifold.normals())
            && last.are_within(normal, KEPT_DRIFT * pair.radius)
        {
            let distances = last.distances(normal).to_array();
            let least = distances[first_least(distances)];
            *still = Some(Self {
                distances,
                least,
                pair,
            });
        }
    }

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
        distance + tolerance <= max_distance && cache.proves(&self.pair, distance, tolerance)
    }

    /// Whether the contacts stay as they are if the shapes have this signed distance.
    #[inline]
    pub fn shows(&self, signed_distance: f64) -> bool {
        (self.least - signed_distance).abs() <= STILL_DEPTH * self.pair.radius
    }

    /// Stores the signed distance of the cores, which was certified.
    pub fn store(&self, cache: &mut StillCache, core_distance: f64) {
        cache.store(&self.pair, core_distance);
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
