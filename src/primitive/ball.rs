//! A ball: a point with a border.

use glam::DVec3;

use crate::stats::Cost;
use crate::support::{Support, VertexId};

/// The core of a ball around its origin: that one point. The radius is a border, to be taken off
/// the distance of the cores.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    radius: f64,
}

impl Ball {
    /// A ball of this radius.
    pub fn new(radius: f64) -> Self {
        Self { radius }
    }

    /// The width of the border around the core.
    pub fn border(&self) -> f64 {
        self.radius
    }
}

impl Support for Ball {
    #[inline]
    fn support(&self, _: DVec3, _: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        (DVec3::ZERO, 0)
    }

    #[inline]
    fn start(&self, _: DVec3) -> VertexId {
        0
    }

    #[inline]
    fn valid_start(&self, _: VertexId) -> VertexId {
        0
    }

    #[inline]
    fn center(&self) -> DVec3 {
        DVec3::ZERO
    }

    /// The border's: a point has no length that a tolerance could be relative to.
    #[inline]
    fn radius(&self) -> f64 {
        self.radius
    }
}
