//! A cone about the y axis.

use glam::DVec3;

use super::rim::Rim;
use super::rolling::turns_about_y;
use crate::stats::Cost;
use crate::support::{ShapeId, ShapeKind, Support, VertexId};

/// A solid cone around its origin, as parry has it: the apex is at `half_height` on the y axis,
/// the base disc at `-half_height`.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    half_height: f64,
    rim: Rim,
    center: DVec3,
    radius: f64,
    lean: [f64; 2],
}

impl Cone {
    /// A cone from its base at `-half_height` to its apex at `half_height`.
    pub fn new(half_height: f64, radius: f64) -> Self {
        // The centre of mass: a quarter of the way up.
        let above_base = 0.5 * half_height;
        let to_rim = (radius * radius + above_base * above_base).sqrt();
        let height = 2.0 * half_height;
        let slant = (radius * radius + height * height).sqrt();
        Self {
            half_height,
            rim: Rim { radius },
            center: DVec3::new(0.0, above_base - half_height, 0.0),
            radius: to_rim.max(height - above_base),
            lean: [radius / slant, height / slant],
        }
    }

    pub(crate) fn half_height(&self) -> f64 {
        self.half_height
    }

    pub(crate) fn rim_radius(&self) -> f64 {
        self.rim.radius
    }

    /// The sine and the cosine of the angle between the side's normals and the base.
    pub(crate) fn lean(&self) -> [f64; 2] {
        self.lean
    }

    /// By how much the radius shrinks along the axis.
    pub(crate) fn slope(&self) -> f64 {
        0.5 * self.rim.radius / self.half_height
    }
}

impl Support for Cone {
    #[inline]
    fn support(&self, dir: DVec3, _: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        let (on_rim, reach) = self.rim.support(dir, -self.half_height);
        let point = if 2.0 * self.half_height * dir.y > reach {
            DVec3::new(0.0, self.half_height, 0.0)
        } else {
            on_rim
        };
        (point, VertexId::default())
    }

    #[inline]
    fn center(&self) -> DVec3 {
        self.center
    }

    #[inline]
    fn rolls(&self, from: DVec3, to: DVec3) -> bool {
        turns_about_y(from, to)
    }

    #[inline]
    fn id(&self) -> Option<ShapeId> {
        Some(ShapeId::described_by(
            ShapeKind::Cone,
            [self.half_height, self.rim.radius],
        ))
    }

    #[inline]
    fn radius(&self) -> f64 {
        self.radius
    }
}
