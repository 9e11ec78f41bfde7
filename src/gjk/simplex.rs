//! The simplex of a search: vertices of the Minkowski difference.

use glam::DVec3;

use crate::simplex::{DistanceSubalgorithm, Nearest};
use crate::support::CsoVertex;

/// At most four vertices of the Minkowski difference, each in its own slot. Dropping a vertex clears a bit,
/// and adding one leaves the others where they are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Simplex {
    slots: [CsoVertex; 4],
    pub(super) occupied: u8,
}

impl Simplex {
    /// The vertices.
    pub fn vertices(&self) -> impl Iterator<Item = &CsoVertex> + Clone {
        self.weighted(&[0.0; 4]).map(|(vertex, _)| vertex)
    }

    fn weighted(&self, weights: &[f64; 4]) -> impl Iterator<Item = (&CsoVertex, f64)> + Clone {
        let slots = self.slots.iter().zip(*weights).enumerate();
        slots
            .filter(|(i, _)| self.occupied >> i & 1 == 1)
            .map(|(_, vertex)| vertex)
    }

    pub(crate) fn contains(&self, vertex: &CsoVertex) -> bool {
        self.vertices().any(|v| v.w == vertex.w)
    }

    /// Puts a vertex into the lowest free slot. There always is one: a full simplex contains the point that
    /// is sought, and ends the loop.
    pub(crate) fn push(&mut self, vertex: CsoVertex) {
        let slot = self.occupied.trailing_ones() as usize;
        debug_assert!(slot < 4, "a full simplex");
        self.slots[slot] = vertex;
        self.occupied |= 1 << slot;
    }

    /// Drops the vertices that are not in the `face` of a nearest point.
    pub(crate) fn keep(&mut self, face: u8) {
        self.occupied = face;
    }

    /// The point nearest to `x`, relative to `x`; its face and weights refer to slots.
    #[inline(always)]
    pub(crate) fn nearest<S: DistanceSubalgorithm>(&self, x: DVec3) -> Nearest {
        let mut points = [DVec3::ZERO; 4];
        let mut slots = [0; 4];
        let mut count = 0;
        for slot in 0..4 {
            if self.occupied >> slot & 1 == 1 {
                points[count] = self.slots[slot].w - x;
                slots[count] = slot;
                count += 1;
            }
        }
        let nearest = S::nearest(&points[..count]);
        if slots[..count] == [0, 1, 2, 3][..count] {
            return nearest;
        }
        let mut by_slot = Nearest {
            point: nearest.point,
            ..Nearest::default()
        };
        for (i, &slot) in slots[..count].iter().enumerate() {
            by_slot.face |= (nearest.face >> i & 1) << slot;
            by_slot.lambda[slot] = nearest.lambda[i];
        }
        by_slot
    }

    /// The point of shape 1 that a nearest point comes from.
    pub(crate) fn on_1(&self, nearest: &Nearest) -> DVec3 {
        let weighted = self.weighted(&nearest.lambda);
        weighted.map(|(v, weight)| v.on_1 * weight).sum()
    }
}
