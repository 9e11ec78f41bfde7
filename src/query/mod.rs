//! The coherent query: starting from the previous frame, the cheapest stage that can *prove* its answer gives
//! it.
//!
//! 1. [`Stage::BoundingSpheres`]: the bounding spheres are apart.
//! 2. [`Stage::Axis`]: one support pair along the previous axis still separates.
//! 3. [`Stage::Feature`]: the previous nearest features still prove distance or depth.
//! 4. [`Stage::FacetWalk`]: features next to them prove it.
//! 5. [`Stage::CachedPolytope`]: those features prove it, together with the polytope of the previous
//!    expansion.
//! 6. [`Stage::WarmGjk`]: incremental GJK from the previous axis and vertices.
//! 7. [`Stage::WarmEpa`]: the depth, expanded from the previous features.
//!
//! A pair without a previous frame starts with the line of centres as its axis, and its GJK and EPA count as
//! cold. A stale or wrong memory costs time, never accuracy: everything is re-evaluated at the present poses.
//!
//! [`Stage::BoundingSpheres`]: crate::stats::Stage::BoundingSpheres
//! [`Stage::Axis`]: crate::stats::Stage::Axis
//! [`Stage::Feature`]: crate::stats::Stage::Feature
//! [`Stage::FacetWalk`]: crate::stats::Stage::FacetWalk
//! [`Stage::CachedPolytope`]: crate::stats::Stage::CachedPolytope
//! [`Stage::WarmGjk`]: crate::stats::Stage::WarmGjk
//! [`Stage::WarmEpa`]: crate::stats::Stage::WarmEpa

mod bounds;
mod certificate;
mod contact_id;
mod error;
mod facet_walk;
mod feature;
mod gauss_map;
mod last_contacts;
mod patch;
mod pipeline;
mod search;
mod seeds;
mod types;
mod witness;

pub(crate) use certificate::verdict::Verdict;
pub(crate) use certificate::{cone_contains_ball, inset};

pub use bounds::{Certificate, SeparationBounds};
pub(crate) use certificate::flush::FlushFaces;
pub use contact_id::ContactId;
pub(crate) use contact_id::contact_keys;
pub use error::QueryError;
pub use feature::Feature;
pub(crate) use feature::vertices;
pub(crate) use last_contacts::{LastContacts, first_least};
pub use patch::{ContactPatch, PatchVertex};
pub(crate) use pipeline::{Distance, Found, Full, Sink, Start, Strategy};
pub use types::{Answer, PairMemory, Proximity};
pub(crate) use witness::moved_apart;

pub use crate::epa::EpaScratch;
pub use crate::gjk::SeparatingAxis;
pub use crate::pose::RelativePose;
pub use crate::stats::Cost;
pub use crate::support::{Cso, EdgeId, FaceId, Polytope, Support, VertexId};

use crate::epa::PolytopeCache;
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
    /// A query for how far apart two shapes are, up to `max_distance`, or how deep they overlap.
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
    fn tolerance(&self) -> f64 {
        DEPTH_GAP * self.cso.min_radius()
    }

    fn skips_facet_walk(&self) -> bool {
        self.max_distance > FACET_WALK_RANGE * self.cso.size()
    }
}
