//! A query, its input and its output.

use glam::DVec3;

use super::feature::Feature;
use crate::epa::{EpaScratch, PolytopeCache};
use crate::gjk::SeparatingAxis;
use crate::stats::{Cost, Stage};
use crate::support::{Cso, Support, VertexId};
use crate::tolerance::DEPTH_GAP;
use crate::tuning::FACET_WALK_RANGE;

/// A query between two shapes.
pub struct Query<'a, 'c, A, B> {
    /// The pair.
    pub cso: &'a Cso<'c, A, B>,
    /// Answers beyond this distance are [`Answer::Separated`].
    pub max_distance: f64,
    /// Polytopes of earlier expansions, and the key of this pair. They save work for a deep pair that is
    /// queried in every frame, and never change an answer.
    pub polytope_cache: Option<(&'a mut PolytopeCache, u64)>,
    /// Memory for the expanding polytope.
    pub scratch: &'a mut EpaScratch,
    /// The cost of the query is added here.
    pub cost: &'a mut Cost,
}

impl<'a, 'c, A: Support, B: Support> Query<'a, 'c, A, B> {
    /// A query for the distance between two shapes, up to `max_distance`, or for their depth if they overlap.
    pub fn new(
        cso: &'a Cso<'c, A, B>,
        max_distance: f64,
        scratch: &'a mut EpaScratch,
        cost: &'a mut Cost,
    ) -> Self {
        Self {
            cso,
            max_distance,
            polytope_cache: None,
            scratch,
            cost,
        }
    }

    /// Two bounds on a depth that differ by at most this count as equal.
    pub(super) fn tolerance(&self) -> f64 {
        DEPTH_GAP * self.cso.min_radius()
    }

    pub(super) fn skips_facet_walk(&self) -> bool {
        self.max_distance > FACET_WALK_RANGE * self.cso.size()
    }
}

/// The memory of a pair from one frame for the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairMemory {
    /// Nothing: the pair is new.
    None,
    /// The shapes were apart along this unit axis (frame 1), at these vertices.
    Axis(DVec3, [VertexId; 2]),
    /// The shapes were in contact along this unit normal (frame 1), at these features.
    Contact(DVec3, [Feature; 2]),
}

/// Whether a query continues from a previous frame. GJK and EPA count as warm or cold by this.
#[derive(Clone, Copy)]
pub enum Start {
    /// From a previous frame.
    Warm,
    /// From the line of centres.
    Cold,
}

impl Start {
    pub(crate) fn gjk(self) -> Stage {
        match self {
            Self::Warm => Stage::WarmGjk,
            Self::Cold => Stage::ColdGjk,
        }
    }

    pub(crate) fn epa(self) -> Stage {
        match self {
            Self::Warm => Stage::WarmEpa,
            Self::Cold => Stage::ColdEpa,
        }
    }
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
