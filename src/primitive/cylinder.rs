//! A cylinder about the y axis.

use glam::DVec3;

use super::rim::Rim;
use super::rolling::turns_about_y;
use crate::stats::Cost;
use crate::support::{ShapeId, ShapeKind, Support, VertexId};

/// A solid cylinder around its origin, as parry has it: the axis is y.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    half_height: f64,
    rim: Rim,
    radius: f64,
}

impl Cylinder {
    /// A cylinder from `-half_height` to `half_height`.
    pub fn new(half_height: f64, radius: f64) -> Self {
        Self {
            half_height,
            rim: Rim { radius },
            radius: (half_height * half_height + radius * radius).sqrt(),
        }
    }

    pub(crate) fn half_height(&self) -> f64 {
        self.half_height
    }

    pub(crate) fn rim_radius(&self) -> f64 {
        self.rim.radius
    }
}

impl Support for Cylinder {
    #[inline]
    fn support(&self, dir: DVec3, _: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        let height = self.half_height.copysign(dir.y);
        (self.rim.support(dir, height).0, VertexId::default())
    }

    #[inline]
    fn rolls(&self, from: DVec3, to: DVec3) -> bool {
        turns_about_y(from, to)
    }

    #[inline]
    fn id(&self) -> Option<ShapeId> {
        Some(ShapeId::described_by(
            ShapeKind::Cylinder,
            [self.half_height, self.rim.radius],
        ))
    }

    #[inline]
    fn radius(&self) -> f64 {
        self.radius
    }
}
