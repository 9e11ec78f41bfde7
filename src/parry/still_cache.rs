//! Certified distances of pairs at rest, which bound the distances at later poses while the shapes hardly move.
//!
//! The signed distance of two shapes changes by no more than their points move relative to each other. The present
//! pose is compared with that of the certificate, so errors do not add up from frame to frame.
//!
//! Whoever asks wants to know whether the distance is still what the contacts show, up to a tolerance. A query would
//! find the same, and would change nothing but the distances of the contacts. So what is in this cache only saves
//! time.

use glam::{DVec3, Quat};

use crate::ids::ShapeId;
use crate::pose::{chord, is_nearly_unit};
use crate::slots::Slots;
use crate::support::{Cso, Support};
use crate::tolerance::PROOF_MARGIN;

/// 4,096 slots, which take 512 KiB.
const SLOT_BITS: u32 = 12;
/// 131,072 slots, which take 1 MiB where they are used. All contacts that stay ask for their tag, and to look them up on the
/// shapes instead costs as much as several queries: with 4,096 slots, a heap of 1,000 took 1.6 times as long.
const TAG_BITS: u32 = 17;

/// Distances of many pairs. A key gives the slot; a tag of the shapes and the contacts tells whether the distance in it is
/// that of the pair.
#[derive(Default)]
pub(crate) struct StillCache {
    /// Two for each pair: a body that trembles comes back to where it was, and one certificate that is replaced where it
    /// proves nothing is mostly at an end of its way.
    certified: Slots<[Certified; 2], SLOT_BITS>,
    /// Tags of contacts and of shapes to which they belong.
    own_contacts: Slots<u64, TAG_BITS>,
}

/// Fills one cache line.
#[derive(Clone, Copy, Default)]
#[repr(C, align(64))]
struct Certified {
    rotation: Quat,
    place: DVec3,
    distance: f64,
    /// Of the contacts, and of the shapes to which they belong.
    tag: u64,
}

/// The pair of a distance.
pub(crate) struct StillPair {
    pub key: u64,
    pub shapes: [ShapeId; 2],
    pub rotation: Quat,
    /// The centre of the smaller shape in the frame of the larger.
    pub place: DVec3,
    /// The radius of the smaller shape.
    pub radius: f64,
}

impl StillPair {
    /// Of two shapes with ids.
    #[inline]
    pub fn of<A: Support, B: Support>(
        cso: &Cso<'_, A, B>,
        rotation: Quat,
        key: u64,
    ) -> Option<Self> {
        let (first, second, pose) = (cso.shape_1, cso.shape_2, cso.pose);
        let (place, radius) = if second.radius() > first.radius() {
            (pose.point_to_2(first.center()), first.radius())
        } else {
            (pose.point_to_1(second.center()), second.radius())
        };
        Some(Self {
            key,
            shapes: [first.id()?, second.id()?],
            rotation,
            place,
            radius,
        })
    }
}

impl StillCache {
    /// Whether contacts with a tag belong to the shapes of a pair, and these certainly have this signed distance, up to a
    /// tolerance.
    #[inline]
    pub fn proves(&self, pair: &StillPair, tag: u64, distance: f64, tolerance: f64) -> bool {
        let Some(slot) = self.certified.get(pair.key) else {
            return false;
        };
        slot.iter().any(|known| {
            known.tag == tag
                && is_nearly_unit(pair.rotation)
                && (known.distance - distance).abs() + known.motion_to(pair) <= tolerance
        })
    }

    /// Whether contacts are known to belong to the shapes of a pair, by their tag.
    #[inline]
    pub fn are_own(&self, key: u64, tag: u64) -> bool {
        self.own_contacts.get(key) == Some(&tag)
    }

    /// The tag of contacts that belong to the shapes of a pair.
    #[inline]
    pub fn own_contacts(&mut self, key: u64) -> &mut u64 {
        self.own_contacts.get_or_allocate(key)
    }

    /// Stores a signed distance that was certified at the present pose, for contacts that belong to the shapes. It replaces
    /// that of other contacts, or of the pose farthest from the present one.
    #[inline]
    pub fn store(&mut self, pair: &StillPair, tag: u64, distance: f64) {
        if !is_nearly_unit(pair.rotation) {
            return;
        }
        let slot = self.certified.get_or_allocate(pair.key);
        let of_others = slot.iter().position(|known| known.tag != tag);
        let replaced = of_others.unwrap_or_else(|| {
            let [first, second] = slot.each_ref().map(|known| known.motion_to(pair));
            usize::from(second > first)
        });
        slot[replaced] = Certified {
            rotation: pair.rotation,
            place: pair.place,
            distance,
            tag,
        };
    }
}

impl Certified {
    /// An upper bound of how far any point of the smaller shape has moved since, in the frame of the larger one.
    #[inline]
    fn motion_to(&self, pair: &StillPair) -> f64 {
        let turned = chord(pair.rotation, self.rotation) / PROOF_MARGIN;
        self.place.distance(pair.place) + turned * pair.radius
    }
}
