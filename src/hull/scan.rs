//! Support by looking at every vertex, four at a time. On small hulls that takes less time than a
//! climb, which has to wait for each step to know the next.

use std::array;

use glam::{DVec3, Vec3};

use super::top::{Highest, LANES, coordinates};
use crate::support::VertexId;

/// Up to so many vertices a scan is quicker than a cold climb, by a third with 24, and no slower
/// than a warm one: the narrow phase of tumbling hulls takes as long with 40 vertices, and 3 %
/// longer with 48.
const LARGEST: usize = 40;

/// The vertices of a small hull, coordinate by coordinate in fours.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    /// The last one is filled up with its first vertex, which wins a tie with its copies.
    fours: Box<[[[f32; LANES]; 3]]>,
}

impl Scan {
    /// `None` for a hull that is quicker to climb.
    pub fn new(points: &[Vec3]) -> Option<Self> {
        (points.len() <= LARGEST).then(|| {
            let fours = points
                .chunks(LANES)
                .map(|chunk| coordinates(array::from_fn(|i| *chunk.get(i).unwrap_or(&chunk[0]))));
            Self {
                fours: fours.collect(),
            }
        })
    }

    /// The extreme vertex in direction `dir`.
    #[inline]
    pub fn highest(&self, dir: DVec3) -> VertexId {
        let mut highest = Highest::new(dir);
        for (number, &four) in self.fours.iter().enumerate() {
            highest.look_at(number, four);
        }
        highest.top().place as VertexId
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.fours)
    }
}
