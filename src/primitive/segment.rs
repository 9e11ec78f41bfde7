//! A capsule: a segment with a border.

use glam::DVec3;

use crate::stats::Cost;
use crate::support::{Support, VertexId};

/// The core of a capsule: the segment along its axis. The radius is a border, to be taken off
/// the distance of the cores. The ids 0 and 1 name the ends.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    ends: [DVec3; 2],
    border: f64,
}

impl Segment {
    /// A segment between two points, the core of a capsule whose radius is `border`.
    pub fn new(ends: [DVec3; 2], border: f64) -> Self {
        Self { ends, border }
    }

    /// The width of the border around the core.
    pub fn border(&self) -> f64 {
        self.border
    }
}

impl Support for Segment {
    #[inline]
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        let [a, b] = self.ends;
        let along = dir.dot(b - a);
        // Where both ends tie it stays: a resting capsule does not swap them.
        let end = match along {
            _ if along > 0.0 => 1,
            _ if along < 0.0 => 0,
            _ => start,
        };
        (self.ends[end as usize], end)
    }

    #[inline]
    fn start(&self, _: DVec3) -> VertexId {
        0
    }

    #[inline]
    fn valid_start(&self, vertex: VertexId) -> VertexId {
        vertex & 1
    }

    #[inline]
    fn center(&self) -> DVec3 {
        self.ends[0].midpoint(self.ends[1])
    }

    /// With the border: the core alone may be a point, without any length.
    #[inline]
    fn radius(&self) -> f64 {
        0.5 * self.ends[0].distance(self.ends[1]) + self.border
    }
}
