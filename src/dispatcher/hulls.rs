//! Prepared hulls of plain convex polyhedra, found again by address and proved by content.
//!
//! A dispatcher is handed bare references: it cannot know whether the polyhedron at an address
//! is the one that was there before. So each use compares the polyhedron's points with those the
//! hull was built from (a `memcmp`, some 20 ns for 100 vertices; of large hulls a `Digest` of them,
//! 130 ns for 1,000). Equal points have an equal hull, whatever the allocator or the user did in
//! between; the table is a pure function of the shapes, and no answer depends on its history. Where the user promises that no shape changes for
//! a while, the first use in that span compares for all of them.
//!
//! Each thread has a table of its own, which needs no lock; the hulls themselves are shared.

use std::sync::Arc;

use glam::Vec3;
use parry3d::shape::ConvexPolyhedron;

use super::int_hash::IntMap;
use super::preparation::Preparation;
use super::unchanged::Span;
use crate::hull::Hull;

/// Bytes of prepared hulls that are kept without asking whether they are still in use.
const KEEP_BYTES: usize = 16 << 20;

/// An entry that was not asked for during this many look-ups may go when room is needed.
const STALE_AFTER: u64 = 1 << 20;

/// A thread's prepared hulls.
#[derive(Default)]
pub(super) struct HullTable {
    entries: IntMap<Address, usize>,
    /// The last address and slot met of each class of addresses, before the map is asked.
    recent: Recent,
    slots: Vec<Slot>,
    bytes: usize,
    sweep_at: usize,
    /// How often references have ended.
    sweeps: u64,
    clock: u64,
    /// The span that is under way.
    span: Option<Span>,
}

/// Where a polyhedron keeps its points.
type Address = usize;

struct Slot {
    address: Address,
    prepared: Arc<Preparation>,
    last_use: u64,
    /// In which it was proved last.
    span: Option<Span>,
}

impl Slot {
    fn new(address: Address, polyhedron: &ConvexPolyhedron) -> Self {
        Self {
            address,
            prepared: Preparation::of(polyhedron),
            last_use: 0,
            span: None,
        }
    }

    /// Whether it is of the points at its address: it was proved in the span that is under way, or is now.
    #[inline(always)]
    fn is_of(&self, points: &[Vec3], span: Option<Span>) -> bool {
        (span.is_some() && self.span == span) || self.prepared.is_of(points)
    }

    /// Marks the slot as proved again and returns a reference to its hull, if it has one.
    #[inline(always)]
    fn used(&mut self, place: usize, clock: u64, span: Option<Span>) -> Option<HullRef> {
        self.last_use = clock;
        self.span = span;
        self.prepared.hull().is_some().then_some(HullRef(place))
    }

    /// What goes with it, if nobody else has it.
    fn bytes(&self) -> usize {
        size_of::<Self>() + self.prepared.bytes()
    }
}

/// A place in the table, good until room is made.
#[derive(Clone, Copy)]
pub(super) struct HullRef(usize);

/// Finds the hulls of polyhedra in the table.
pub(super) trait Find<'a> {
    /// The hull of a polyhedron; `None` if it has none.
    fn find(&mut self, table: &mut HullTable, polyhedron: &'a ConvexPolyhedron) -> Option<HullRef>;
}

/// Each with its proof.
pub(super) struct EachProved;

impl<'a> Find<'a> for EachProved {
    #[inline(always)]
    fn find(&mut self, table: &mut HullTable, polyhedron: &'a ConvexPolyhedron) -> Option<HullRef> {
        table.find(polyhedron)
    }
}

impl<'a, F: Find<'a>> Find<'a> for &mut F {
    #[inline]
    fn find(&mut self, table: &mut HullTable, polyhedron: &'a ConvexPolyhedron) -> Option<HullRef> {
        (**self).find(table, polyhedron)
    }
}

/// Without another proof for the one that was proved last: it cannot have changed, it is borrowed.
#[derive(Clone, Copy, Default)]
pub(super) struct LastProved<'a>(Option<Proof<'a>>);

#[derive(Clone, Copy)]
struct Proof<'a> {
    polyhedron: &'a ConvexPolyhedron,
    place: HullRef,
    sweeps: u64,
}

impl<'a> Find<'a> for LastProved<'a> {
    #[inline]
    fn find(&mut self, table: &mut HullTable, polyhedron: &'a ConvexPolyhedron) -> Option<HullRef> {
        if let Some(proof) = self.0
            && std::ptr::eq(proof.polyhedron, polyhedron)
            && proof.sweeps == table.sweeps
        {
            return Some(proof.place);
        }
        let place = table.find(polyhedron)?;
        *self = Self(Some(Proof {
            polyhedron,
            place,
            sweeps: table.sweeps,
        }));
        Some(place)
    }
}

impl HullTable {
    /// Before hulls are looked for, which are unchanged during `span`. References end here.
    #[inline(always)]
    pub fn begin(&mut self, span: Option<Span>) {
        self.span = span;
        if self.bytes > self.sweep_at.max(KEEP_BYTES) {
            self.make_room();
        }
    }

    /// Drops what seems unused.
    #[cold]
    #[inline(never)]
    fn make_room(&mut self) {
        self.sweeps += 1;
        let oldest = self.clock.saturating_sub(STALE_AFTER);
        self.slots.retain(|slot| slot.last_use >= oldest);
        self.entries.clear();
        self.recent = Recent::default();
        for (i, slot) in self.slots.iter().enumerate() {
            self.entries.insert(slot.address, i);
        }
        self.bytes = self.slots.iter().map(Slot::bytes).sum();
        self.sweep_at = 2 * self.bytes;
    }

    /// The hull of a polyhedron, built if it is new; `None` if it has none.
    #[inline(always)]
    fn find(&mut self, polyhedron: &ConvexPolyhedron) -> Option<HullRef> {
        let points = polyhedron.points();
        let address = points.as_ptr() as Address;
        let (known, place) = *self.recent.class(address);
        if known == address
            && let Some(slot) = self.slots.get_mut(place)
            && slot.is_of(points, self.span)
        {
            self.clock += 1;
            return slot.used(place, self.clock, self.span);
        }
        self.find_among_all(polyhedron)
    }

    #[inline(never)]
    fn find_among_all(&mut self, polyhedron: &ConvexPolyhedron) -> Option<HullRef> {
        let points = polyhedron.points();
        let address = points.as_ptr() as Address;
        let place = match self.entries.get(&address).copied() {
            Some(i) if self.slots[i].is_of(points, self.span) => i,
            known => self.insert(address, polyhedron, known),
        };
        *self.recent.class(address) = (address, place);
        self.clock += 1;
        self.slots[place].used(place, self.clock, self.span)
    }

    #[cold]
    fn insert(
        &mut self,
        address: Address,
        polyhedron: &ConvexPolyhedron,
        known: Option<usize>,
    ) -> usize {
        let slot = Slot::new(address, polyhedron);
        self.bytes += slot.bytes();
        if let Some(i) = known {
            self.bytes -= self.slots[i].bytes();
            self.slots[i] = slot;
            return i;
        }
        self.slots.push(slot);
        self.entries.insert(address, self.slots.len() - 1);
        self.slots.len() - 1
    }

    /// The hull at a place that [`find`](Self::find) gave.
    #[inline]
    pub fn get(&self, place: HullRef) -> Option<&Hull> {
        self.slots.get(place.0)?.prepared.hull()
    }
}

/// A direct-mapped cache: one pair of address and slot for each class of addresses.
struct Recent([(Address, usize); CLASSES]);

/// Enough for the different hulls of most scenes, in a few kilobytes.
const CLASSES: usize = 256;

impl Default for Recent {
    fn default() -> Self {
        // No points are at address 0.
        Self([(0, 0); CLASSES])
    }
}

impl Recent {
    #[inline(always)]
    fn class(&mut self, address: Address) -> &mut (Address, usize) {
        &mut self.0[(address >> 4 ^ address >> 12) % CLASSES]
    }
}
