//! Places of a contact patch, and the names they keep from frame to frame.

use glam::DVec3;

use crate::query::Feature;
use crate::support::{EdgeId, FaceId, VertexId};

/// A place of contact: a point on each surface, on one line along the contact normal. In frame 1.
#[derive(Clone, Copy, Debug)]
pub struct ContactPlace {
    /// On the surface of the first shape.
    pub on_1: DVec3,
    /// On that of the second shape.
    pub on_2: DVec3,
    /// From the first to the second: negative where they overlap.
    pub distance: f64,
    /// What meets there.
    pub features: [Feature; 2],
}

/// What of a piece a place is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spot {
    /// Its inside.
    Inside,
    /// The extreme point along the normal.
    Extreme(VertexId),
    /// A corner of a polygon.
    Corner(VertexId),
    /// A side of a polygon, by its first corner.
    Side(VertexId),
    /// A sector of a circle.
    Arc(usize),
    /// Where a circle crosses a side of the other outline: on the way in, or out.
    Crossing(usize),
    /// An end of a line.
    End(usize),
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
