//! The order of a pair.

use crate::pose::{RelativePose, ValidPose};

/// Which of the caller's shapes comes first here. The kernels expect the hull first, and the routines for
/// composites the shape with parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum PairOrder {
    /// The caller's first shape.
    #[default]
    Given,
    /// The caller's second shape.
    Reversed,
}

impl PairOrder {
    pub const BOTH: [Self; 2] = [Self::Given, Self::Reversed];

    /// The order in which a shape of some kind comes first. The flags tell which of the caller's shapes are
    /// of that kind.
    #[inline]
    pub fn with_first(is_of_kind: [bool; 2]) -> Option<Self> {
        match is_of_kind {
            [true, _] => Some(Self::Given),
            [false, true] => Some(Self::Reversed),
            [false, false] => None,
        }
    }

    /// Like [`with_first`](Self::with_first), with the shape second.
    pub fn with_second([first, second]: [bool; 2]) -> Option<Self> {
        Self::with_first([second, first])
    }

    #[inline]
    pub fn is_reversed(self) -> bool {
        self == Self::Reversed
    }

    /// The other order.
    pub fn reversed(self) -> Self {
        match self {
            Self::Given => Self::Reversed,
            Self::Reversed => Self::Given,
        }
    }

    /// Converts from the order here to the caller's.
    #[inline]
    pub fn to_caller<T>(self, [a, b]: [T; 2]) -> [T; 2] {
        if self.is_reversed() { [b, a] } else { [a, b] }
    }

    /// Converts from the caller's order to the order here.
    #[inline]
    pub fn to_kernel<T>(self, caller: [T; 2]) -> [T; 2] {
        self.to_caller(caller)
    }

    /// The pose of the second shape in the frame of the first, from that of the caller's shapes.
    #[inline(always)]
    pub fn pose(self, pos12: ValidPose<'_>) -> RelativePose {
        let pose = RelativePose::from(pos12);
        if self.is_reversed() {
            pose.inverse()
        } else {
            pose
        }
    }
}
