//! Prepared hulls of plain convex polyhedra, found again by address and proved by content.
//!
//! A dispatcher gets bare references: it cannot know whether the polyhedron at an address is the one that was
//! there before. So each use compares the polyhedron's points with those from which the hull was built (a
//! `memcmp`, some 20 ns for 100 vertices; for large hulls a `Digest`, 130 ns for 1,000), and also the edges
//! that the points do not determine, those across flat sides. Equal polyhedra have equal hulls, whatever the
//! allocator or the user did in between: the table is a pure function of the shapes, and no answer depends on
//! its history. Only the first use in an [`Epoch`] compares. An epoch is the update of one pair, or a step in
//! which the user promises unchanged shapes.
//!
//! Each thread has its own table, which needs no lock; the hulls themselves are shared. Nothing reports that
//! a polyhedron is gone: its hull is dropped once it has not been used for long ([`Aging`]).

mod aging;
mod digest;
pub(crate) mod epoch;
pub(crate) mod registry;

use std::cell::Cell;
use std::sync::Arc;

use parry3d::shape::ConvexPolyhedron;

use crate::hull::Hull;
use crate::parry::int_hash::IntMap;
use aging::Aging;
use epoch::Epoch;
use registry::PreparedHull;

/// Unused hulls are dropped after this many pairs, and whenever this share of the allowed bytes has been
/// prepared.
const LOOK_AFTER: u32 = 4096;
const LOOK_AFTER_BYTES: usize = KEEP / 4;
/// How many bytes are kept even if unused.
const KEEP: usize = aging::KEEP_BYTES as usize;

/// A thread's prepared hulls.
pub(crate) struct HullCache {
    entries: IntMap<Address, usize>,
    /// The last address and slot of each class of addresses. It is tried before the map.
    recent: DirectMapped,
    slots: Vec<Slot>,
    bytes: usize,
    /// The number of bytes, and of pairs, at which unused hulls are dropped.
    look_at: usize,
    look_after: u32,
    aging: Aging,
}

impl Default for HullCache {
    fn default() -> Self {
        Self {
            entries: IntMap::default(),
            recent: DirectMapped::default(),
            slots: Vec::new(),
            bytes: 0,
            look_at: KEEP + LOOK_AFTER_BYTES,
            look_after: LOOK_AFTER,
            aging: Aging::default(),
        }
    }
}

/// The address of a polyhedron's points.
type Address = usize;

struct Slot {
    address: Address,
    prepared: Arc<PreparedHull>,
    /// When it was last used, by the table's `Aging`.
    used: Cell<u64>,
    /// The epoch in which it was last verified.
    epoch: Cell<Epoch>,
}

impl Slot {
    fn new(address: Address, polyhedron: &ConvexPolyhedron) -> Self {
        Self {
            address,
            prepared: PreparedHull::get_or_build(polyhedron),
            used: Cell::default(),
            epoch: Cell::default(),
        }
    }

    /// Whether it belongs to the polyhedron at its address. This was verified in this epoch, or is now.
    #[inline(always)]
    fn matches(&self, polyhedron: &ConvexPolyhedron, epoch: Epoch) -> bool {
        self.epoch.get() == epoch || self.prepared.matches(polyhedron)
    }

    /// Marks the slot as verified, and returns its hull, if it has one.
    #[inline(always)]
    fn proved(&self, now: u64, epoch: Epoch) -> Option<&Hull> {
        self.used.set(now);
        self.epoch.set(epoch);
        self.prepared.hull()
    }

    /// The key by which the same polyhedron at the same address is recognised.
    fn key(&self) -> u64 {
        self.prepared.key() ^ self.address as u64
    }

    /// The bytes that are freed with it, if nobody else uses the hull.
    fn bytes(&self) -> usize {
        size_of::<Self>() + self.prepared.bytes()
    }
}

/// A reference into the table, valid until hulls are dropped.
#[derive(Clone, Copy)]
pub(crate) struct HullRef(usize);

impl HullCache {
    /// Called before the hulls of a pair are looked up. Earlier references become invalid.
    #[inline(always)]
    pub fn begin(&mut self) {
        self.look_after -= 1;
        if self.look_after == 0 {
            self.look_after();
        }
    }

    /// Drops hulls that seem unused, if there are many.
    #[cold]
    #[inline(never)]
    fn look_after(&mut self) {
        self.look_after = LOOK_AFTER;
        self.aging.pass();
        if self.bytes > KEEP {
            self.evict();
            self.look_at = self.bytes.max(KEEP) + LOOK_AFTER_BYTES;
        }
    }

    fn evict(&mut self) {
        let is_old = self.aging.limit();
        let before = self.slots.len();
        let aging = &mut self.aging;
        self.slots.retain(|slot| {
            let goes = is_old(slot.used.get());
            if goes {
                aging.dropped(slot.key(), slot.used.get());
            }
            !goes
        });
        if self.slots.len() == before {
            return;
        }
        self.slots.shrink_to(2 * self.slots.len());
        self.recent = DirectMapped::default();
        self.entries = (self.slots.iter().enumerate())
            .map(|(i, slot)| (slot.address, i))
            .collect();
        self.bytes = self.slots.iter().map(Slot::bytes).sum();
    }

    /// The hull of a polyhedron that is found at once. It may also be in the map.
    #[inline(always)]
    pub fn known(&self, polyhedron: &ConvexPolyhedron, epoch: Epoch) -> Option<&Hull> {
        let place = self.recent_place(polyhedron)?;
        let slot = self.slots.get(place)?;
        if slot.matches(polyhedron, epoch) {
            slot.proved(self.aging.now(), epoch)
        } else {
            None
        }
    }

    #[inline]
    fn recent_place(&self, polyhedron: &ConvexPolyhedron) -> Option<usize> {
        let address = polyhedron.points().as_ptr() as Address;
        let (known, place) = self.recent.0[DirectMapped::class(address)];
        (known == address).then_some(place)
    }

    /// The hull of a polyhedron, built if it is new; `None` if it has none.
    #[inline]
    pub fn find(&mut self, polyhedron: &ConvexPolyhedron, epoch: Epoch) -> Option<HullRef> {
        if self.known(polyhedron, epoch).is_some() {
            return self.recent_place(polyhedron).map(HullRef);
        }
        self.find_among_all(polyhedron, epoch)
    }

    #[inline(never)]
    fn find_among_all(&mut self, polyhedron: &ConvexPolyhedron, epoch: Epoch) -> Option<HullRef> {
        let address = polyhedron.points().as_ptr() as Address;
        let place = match self.entries.get(&address).copied() {
            Some(i) if self.slots[i].matches(polyhedron, epoch) => i,
            known => self.insert(address, polyhedron, known),
        };
        self.recent.0[DirectMapped::class(address)] = (address, place);
        let hull = self.slots[place].proved(self.aging.now(), epoch);
        hull.is_some().then_some(HullRef(place))
    }

    #[cold]
    fn insert(
        &mut self,
        address: Address,
        polyhedron: &ConvexPolyhedron,
        known: Option<usize>,
    ) -> usize {
        // First, so that the new hull takes over its memory, which is in the processor's caches.
        if let Some(place) = known {
            self.drop_hull(place);
        }
        let slot = Slot::new(address, polyhedron);
        self.aging.prepared(slot.key(), slot.bytes());
        self.bytes += slot.bytes();
        if self.bytes > self.look_at {
            // They are dropped at the next pair, since this one holds references.
            self.look_after = 1;
        }
        self.slots.push(slot);
        let last = self.slots.len() - 1;
        match known {
            Some(place) => {
                self.slots.swap(place, last);
                place
            }
            None => {
                self.entries.insert(address, last);
                last
            }
        }
    }

    /// Drops the hull in a place, in which the last one stays until another hull is there.
    fn drop_hull(&mut self, place: usize) {
        let old = self.slots.swap_remove(place);
        self.bytes -= old.bytes();
    }

    /// The hull of a reference from [`find`](Self::find).
    #[inline]
    pub fn get(&self, place: HullRef) -> Option<&Hull> {
        debug_assert!(
            place.0 < self.slots.len(),
            "a reference has outlived its pair"
        );
        self.slots.get(place.0)?.prepared.hull()
    }
}

/// A direct-mapped cache: one pair of address and slot for each class of addresses.
struct DirectMapped([(Address, usize); CLASSES]);

/// This is enough for the different hulls of most scenes, and takes a few kilobytes.
const CLASSES: usize = 256;

impl Default for DirectMapped {
    fn default() -> Self {
        // No points are at address 0.
        Self([(0, 0); CLASSES])
    }
}

impl DirectMapped {
    #[inline(always)]
    fn class(address: Address) -> usize {
        (address >> 4 ^ address >> 12) % CLASSES
    }
}
