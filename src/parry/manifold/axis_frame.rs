//! Where a pair that is apart keeps its separating axis.

use glam::{DVec3, Vec3};

use crate::parry::order::PairOrder;
use crate::pose::RelativePose;
use crate::support::{Cso, Support};
use crate::tolerance::NEARLY_UNIT;
use crate::tuning::MUCH_LARGER;

/// The shape in whose frame a pair keeps its separating axis.
#[derive(Clone, Copy)]
pub(super) enum AxisFrame<'a> {
    /// The kernels' first shape.
    First,
    /// Their second shape, with its pose in the frame of the first.
    Second(&'a RelativePose),
}

impl<'a> AxisFrame<'a> {
    /// The frame of the caller's second shape if that is much larger, or else of the first. If sizes differ, mostly the
    /// small shape tumbles over a floor or along a wall, and in the frame of these the axis does not move.
    #[inline]
    pub fn of<A: Support, B: Support>(cso: &Cso<'a, A, B>, order: PairOrder) -> Self {
        let is_second = is_second_larger([cso.shape_1.radius(), cso.shape_2.radius()], order);
        if is_second == order.is_reversed() {
            Self::First
        } else {
            Self::Second(cso.pose)
        }
    }

    /// The frame of the caller's first shape.
    #[inline]
    pub fn of_callers_first(pose: &'a RelativePose, order: PairOrder) -> Self {
        if order.is_reversed() {
            Self::Second(pose)
        } else {
            Self::First
        }
    }

    /// Whether this is the frame of the caller's second shape.
    #[inline]
    pub fn is_of_second(self, order: PairOrder) -> bool {
        matches!(self, Self::Second(_)) != order.is_reversed()
    }

    /// The greatest distance of a point of the other shape from the centre of its rotation: the origin of the caller's
    /// second shape, which the caller's pose turns.
    pub fn lever<A: Support, B: Support>(self, cso: &Cso<'_, A, B>, order: PairOrder) -> f64 {
        let (first, second) = (cso.shape_1, cso.shape_2);
        match (self, order) {
            (Self::First, PairOrder::Given) => second.center().length() + second.radius(),
            (Self::First, PairOrder::Reversed) => {
                cso.pose.point_to_1(second.center()).length() + second.radius()
            }
            (Self::Second(pose), PairOrder::Given) => {
                (first.center() - pose.translation()).length() + first.radius()
            }
            (Self::Second(_), PairOrder::Reversed) => first.center().length() + first.radius(),
        }
    }

    /// Converts to the frame of the kernels' first shape.
    #[inline]
    pub fn to_kernel(self, axis: DVec3) -> DVec3 {
        match self {
            Self::First => axis,
            Self::Second(pose) => pose.direction_to_1(axis),
        }
    }
}

/// Whether the caller's second shape is much larger than the first. The radii are in the kernels' order.
#[inline]
fn is_second_larger(radii: [f64; 2], order: PairOrder) -> bool {
    let [first, second] = order.to_caller(radii);
    second > MUCH_LARGER * first
}

/// The vector, if it has unit length up to rounding. Separations along it then have the same relative error.
#[inline]
pub(super) fn unit(v: Vec3) -> Option<DVec3> {
    let v = v.as_dvec3();
    // This is also false for NaN.
    ((v.length_squared() - 1.0).abs() < NEARLY_UNIT).then_some(v)
}
