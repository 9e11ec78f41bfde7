//! A bound on the depth in all directions except those over one facet, which holds while the shapes hardly move.
//!
//! Take a disc in the plane of a facet of the Minkowski difference, around the projection of the origin. In all
//! directions of a cap around the facet's normal, the support of the disc is at least the facet's depth; the tangent
//! of half of the cap's angle is `inset / depth`. If the support of the difference is as large in all other
//! directions, no direction has a smaller depth.
//!
//! The planes of a polytope inside the difference bound that support: the part of a ball that is beneath the planes
//! that cut it lies in the polytope. When the shapes move, the support shrinks by at most the way of the fastest
//! point. So a proof for all directions outside a cap holds for some time.

use glam::DVec3;

use crate::pose::RelativePose;
use crate::support::{Cso, ShapeId, Support};
use crate::tuning::{CAP_SHARE, WIDE_CAP};

/// A facet of the Minkowski difference that may be the nearest.
#[derive(Clone, Copy, Debug)]
pub struct KnownDepth {
    /// The distance of the origin beneath its plane.
    pub depth: f64,
    /// Its outward unit normal, in frame 1.
    pub normal: DVec3,
    /// The distance of the origin's projection from the facet's sides. If it is not positive, it means nothing.
    pub inset: f64,
}

impl KnownDepth {
    /// The directions that the facet covers, with this share of the tangent.
    fn cap(&self, share: f64) -> Cap {
        let tangent = share * (self.inset / self.depth).clamp(0.0, 1.0);
        let squared = tangent * tangent;
        Cap {
            axis: self.normal,
            cos: (1.0 - squared) / (1.0 + squared),
            sin: 2.0 * tangent / (1.0 + squared),
        }
    }

    /// Whether the facet covers enough directions for a proof of the others to last.
    pub(super) fn is_wide(&self) -> bool {
        self.inset >= WIDE_CAP * self.depth
    }

    /// Directions that the facet covers now, and still covers after a small motion; only the normal if these are few.
    pub(super) fn narrow_cap(&self) -> Cap {
        self.cap(if self.is_wide() { CAP_SHARE } else { 0.0 })
    }
}

/// Directions within an angle of an axis, at most a right angle.
#[derive(Clone, Debug)]
pub(super) struct Cap {
    axis: DVec3,
    cos: f64,
    sin: f64,
}

impl Cap {
    /// The square of the least distance from the origin to a plane, measured along directions outside the cap. The
    /// normal may have any length; `height` is that length times the distance of the origin beneath the plane.
    pub fn squared_reach(&self, outward: DVec3, height: f64) -> f64 {
        let (along, squared) = (outward.dot(self.axis), outward.length_squared());
        let along_squared = along * along;
        // The cosine of the angle between the normal and the nearest direction outside the cap.
        let cos = if along > 0.0 && along_squared >= self.cos * self.cos * squared {
            let across = (squared - along_squared).max(0.0).sqrt();
            let cos = self.cos * along + self.sin * across;
            cos * cos
        } else {
            squared
        };
        height * height / cos
    }

    /// Whether this cap contains another one.
    fn contains(&self, other: &Self) -> bool {
        // A chord is longer than the sine.
        let turned = self.axis.distance(other.axis);
        self.cos <= other.cos * (1.0 - 0.5 * turned * turned) - other.sin * turned
    }
}

/// What a polytope has proved about two shapes at some pose.
#[derive(Clone, Debug)]
pub(super) struct Clearance {
    shapes: [ShapeId; 2],
    pose: RelativePose,
    /// In directions outside this cap, the support of the difference is at least `reach`.
    cap: Cap,
    reach: f64,
}

impl Clearance {
    pub fn new<A: Support, B: Support>(cso: &Cso<'_, A, B>, cap: Cap, reach: f64) -> Option<Self> {
        Some(Self {
            shapes: [cso.shape_1.id()?, cso.shape_2.id()?],
            pose: *cso.pose,
            cap,
            reach,
        })
    }

    /// Whether the support of the difference is at least `radius` in each direction that the facet does not cover.
    pub fn proves<A: Support, B: Support>(
        &self,
        cso: &Cso<'_, A, B>,
        facet: &KnownDepth,
        radius: f64,
    ) -> bool {
        if self.shapes.map(Some) != [cso.shape_1.id(), cso.shape_2.id()] {
            return false;
        }
        let lever = cso.shape_2.center().length() + cso.shape_2.radius();
        let moved = cso.pose.way_from(&self.pose, lever);
        radius + moved <= self.reach && facet.cap(1.0).contains(&self.cap)
    }
}
