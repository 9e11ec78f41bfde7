//! Ids of the parts of a shape. Each kind has its own type, so that a face cannot be mistaken for a vertex.

use std::fmt;
use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::at::to_u32;
use crate::mix::extended;

/// Defines an id, which is a number of 30 bits at most.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(u32);

        impl $name {
            /// The id with this number.
            #[inline]
            pub const fn new(number: usize) -> Self {
                Self(to_u32(number))
            }

            /// Its number, as an index.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }

        impl From<u16> for $name {
            #[inline]
            fn from(number: u16) -> Self {
                Self(number.into())
            }
        }

        impl From<u32> for $name {
            #[inline]
            fn from(number: u32) -> Self {
                Self(number)
            }
        }

        impl From<$name> for u32 {
            #[inline]
            fn from(id: $name) -> Self {
                id.0
            }
        }
    };
}

id! {
    /// The index of a vertex of a shape. Smooth shapes, which have none, use 0.
    VertexId
}

id! {
    /// A face of a polytope: polygon and plane.
    FaceId
}

id! {
    /// An edge of a polytope.
    EdgeId
}

/// Tells a shape from every other that this process has built. Copies, which never change, share it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct ShapeId(NonZeroU64);

/// The highest bit. It is set in the ids of shapes that a few numbers describe.
const DESCRIBED: u64 = 1 << 63;

/// The kind of a shape that a few numbers describe.
#[derive(Clone, Copy)]
pub(crate) enum ShapeKind {
    Ball = 1,
    Segment,
    Triangle,
    Cuboid,
    Cylinder,
    Cone,
    HalfSpace,
}

impl ShapeId {
    /// The id of a shape that a few numbers describe. Two such shapes that differ have the same id with a probability
    /// of 2^-62.
    #[inline]
    pub(crate) fn described_by<const N: usize>(kind: ShapeKind, numbers: [f64; N]) -> Self {
        let words = numbers.into_iter().map(f64::to_bits);
        let hash = words.fold(kind as u64, extended);
        Self(NonZeroU64::MIN | DESCRIBED | hash)
    }

    /// The number that it is.
    #[inline]
    pub(crate) fn number(self) -> u64 {
        self.0.get()
    }

    /// One that no shape has.
    pub(crate) fn new() -> Self {
        static LAST: AtomicU64 = AtomicU64::new(0);
        let number = LAST.fetch_add(1, Ordering::Relaxed) + 1;
        Self(NonZeroU64::new(number).unwrap_or(NonZeroU64::MAX))
    }
}

/// Equal shapes look equal.
impl fmt::Debug for ShapeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ShapeId")
    }
}
