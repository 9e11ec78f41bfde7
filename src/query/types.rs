//! The input and the output of a query.

use glam::DVec3;

use super::feature::Feature;
use crate::gjk::SeparatingAxis;
use crate::support::VertexId;

/// What one frame remembers about a pair for the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairMemory {
    /// Nothing: the pair is new.
    None,
    /// The shapes were apart along this unit axis (frame 1), at these vertices.
    Axis(DVec3, [VertexId; 2]),
    /// The shapes were in contact along this unit normal (frame 1), at these features.
    Contact(DVec3, [Feature; 2]),
}

/// Signed distance, normal and witness points of a pair. All in frame 1.
#[derive(Clone, Copy, Debug)]
pub struct Proximity {
    /// Distance of disjoint shapes; minus the penetration depth of overlapping ones.
    pub signed_distance: f64,
    /// Unit direction from shape 1 to shape 2 along which they are that far apart.
    pub normal: DVec3,
    /// The witness point on shape 1.
    pub on_1: DVec3,
    /// The witness point on shape 2.
    pub on_2: DVec3,
    /// The features on which the witness points lie.
    pub features: [Feature; 2],
}

/// The answer to a query.
#[derive(Clone, Copy, Debug)]
pub enum Answer {
    /// The shapes are farther apart than the query's maximum distance.
    Separated(SeparatingAxis),
    /// The shapes are this near, or overlap.
    Near(Proximity),
}

impl Answer {
    /// The memory to pass to the next frame's query.
    pub fn memory(&self) -> PairMemory {
        match self {
            Self::Separated(apart) => PairMemory::Axis(apart.axis, apart.ids),
            Self::Near(near) => PairMemory::Contact(near.normal, near.features),
        }
    }
}
