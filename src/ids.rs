//! Ids of the parts of a shape. Each kind has its own type, so that a face cannot be mistaken for a vertex.

use std::fmt;

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
                Self(number as u32)
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
