//! Places of a contact patch, and features that identify them from frame to frame.

use glam::DVec3;

use crate::query::Feature;
use crate::support::{EdgeId, FaceId, VertexId};

/// A place of contact: a point on each surface, on one line along the contact normal. In frame 1.
#[derive(Clone, Copy, Debug)]
pub struct ContactPlace {
    /// The point on the surface of the first shape.
    pub on_1: DVec3,
    /// The point on the surface of the second shape.
    pub on_2: DVec3,
    /// The distance from the first point to the second, negative where the shapes overlap.
    pub distance: f64,
    /// The features that meet there.
    pub features: [Feature; 2],
}

/// The part of a piece on which a place lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spot {
    /// The interior.
    Inside,
    /// The extreme point along the normal.
    Extreme(VertexId),
    /// A corner of a polygon.
    Corner(VertexId),
    /// An edge of a polygon, identified by its first corner.
    Side(VertexId),
    /// A sector of a circle.
    Arc(usize),
    /// Where a circle crosses an edge of the other outline, on the way in or out.
    Crossing(usize),
    /// An end of a line.
    End(usize),
}

/// A point of one of the two pieces, and its spot on both.
#[derive(Clone, Copy)]
pub(super) struct PiecePoint {
    pub at: DVec3,
    pub spots: [Spot; 2],
}

/// Puts two values in the order of the shapes. The first one belongs to `shape`.
pub(super) fn by_shape<T>(shape: usize, [mine, other]: [T; 2]) -> [T; 2] {
    if shape == 0 {
        [mine, other]
    } else {
        [other, mine]
    }
}

/// Crossings and ends are numbered after the sectors of circles.
const FIRST_CROSSING: usize = 16;
const FIRST_END: usize = 32;

impl Spot {
    pub fn feature(self) -> Feature {
        match self {
            Self::Inside => Feature::Face(FaceId::default()),
            Self::Extreme(vertex) | Self::Corner(vertex) => Feature::Vertex(vertex),
            Self::Side(vertex) => Feature::Edge(EdgeId::new(vertex.index())),
            Self::Arc(sector) => Feature::Edge(EdgeId::new(sector)),
            Self::Crossing(i) => Feature::Edge(EdgeId::new(FIRST_CROSSING + i)),
            Self::End(i) => Feature::Edge(EdgeId::new(FIRST_END + i)),
        }
    }
}
