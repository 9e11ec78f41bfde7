//! Penetration depth by the expanding polytope algorithm (van den Bergen, *Proximity queries and
//! penetration depth computation on 3D game objects*, GDC 2001).
//!
//! A polytope inside the Minkowski difference is expanded by support points along the normal of the
//! face whose plane is nearest to the origin, until that face cannot be pushed out. Its plane then
//! bounds the depth from above, as a supporting plane, and from below, as the nearest face.
//!
//! The distances of faces are signed, and negative where the origin lies beyond the face. So the origin may
//! start anywhere: on a vertex, an edge or a face, or even outside. Touching shapes are no special case, and
//! the first polytope only needs volume.

mod cached_polytope;
mod clearance;
mod face_queue;
mod horizon;
mod polytope;
mod polytope_cache;
mod seed;

pub use clearance::KnownDepth;
pub use polytope::EpaScratch;
pub use polytope_cache::PolytopeCache;

use glam::DVec3;

use crate::pose::is_unit;
use crate::simplex::{DistanceSubalgorithm, Preferred};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Support};
use crate::tolerance::DEPTH_GAP;
use polytope::ExpandingPolytope;

/// Two identical fine spheres need a face for every pair of facets. No reasonable input needs more.
const MAX_EXPANSIONS: u32 = 50_000;

/// How deep two shapes overlap, in frame 1.
#[derive(Clone, Copy, Debug)]
pub struct Penetration {
    /// The least translation of shape 2 along `normal` that separates the shapes; negative if
    /// the normal separates them already.
    pub depth: f64,
    /// A lower bound of the depth over all directions.
    pub lower_bound: f64,
    /// Unit direction from shape 1 to shape 2.
    pub normal: DVec3,
    /// The witness point of shape 1: extreme along the normal.
    pub on_1: DVec3,
    /// The witness point of shape 2: extreme against the normal.
    pub on_2: DVec3,
    /// The vertices of the face that the witness points come from.
    pub face: [CsoVertex; 3],
}

/// The penetration depth. The polytope grows from the hull of `seeds`, which are points of the Minkowski
/// difference, usually GJK's last simplex.
///
/// Stops early, with a negative depth, when a face's normal separates the shapes. `None` if the
/// Minkowski difference has no volume or is not finite.
///
/// Polytopes, and curved shapes in general position, take tens of expansions. If a curved pair has a whole
/// circle of directions with the least depth (cylinders, cones and balls on a common axis), the polytope must
/// become as round as the tolerance requires. This takes 2,000 to 7,200 expansions, up to two seconds.
///
/// Along the normal, the distance of the witness points is the depth, up to the tolerance. Across the normal
/// it may be larger if the face found is part of a larger facet: 3e-5 of the size for parallel cylinders that
/// are sixteen times as long as wide.
pub fn penetration<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    seeds: &[CsoVertex],
    scratch: &mut EpaScratch,
    cost: &mut Cost,
) -> Option<Penetration> {
    match penetration_below(cso, seeds, f64::INFINITY, scratch, cost)? {
        DepthSearch::Found(found) => Some(found),
        DepthSearch::NotBelow => None,
    }
}

/// The penetration depth, as [`penetration`] finds it, if it is less than `known_depth` by more than the
/// tolerance. Otherwise [`DepthSearch::NotBelow`]: no depth is less by more than twice the tolerance.
pub fn penetration_below<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    seeds: &[CsoVertex],
    known_depth: f64,
    scratch: &mut EpaScratch,
    cost: &mut Cost,
) -> Option<DepthSearch> {
    let tolerance = DEPTH_GAP * cso.min_radius();
    penetration_within(cso, seeds, [known_depth, tolerance], scratch, cost)
}

/// Like [`penetration_below`], with another tolerance for the difference of the bounds.
pub fn penetration_within<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    seeds: &[CsoVertex],
    [known_depth, tolerance]: [f64; 2],
    scratch: &mut EpaScratch,
    cost: &mut Cost,
) -> Option<DepthSearch> {
    let polytope = &mut scratch.polytope;
    let search_radius = known_depth - tolerance;
    polytope.start(
        seed::tetrahedron(cso, seeds, cost)?,
        cso.size(),
        search_radius,
    );
    for seed in seeds {
        polytope.insert_if_outside(seed);
    }
    let mut best = (f64::INFINITY, None);
    for _ in 0..MAX_EXPANSIONS {
        let Some(face) = polytope.nearest_face() else {
            if best.0 >= search_radius - tolerance {
                return Some(DepthSearch::NotBelow);
            }
            break;
        };
        let (normal, distance) = polytope.plane(face);
        cost.iterations += 1;
        // Most climbs end farther away than the corners of the face.
        let w = cso.support(normal, cso.start_vertices(normal), cost);
        let depth = normal.dot(w.w);
        let is_bound = depth - distance <= tolerance;
        if depth < -tolerance || is_bound && depth < search_radius {
            return Some(DepthSearch::Found(witness(
                polytope,
                face,
                [distance, depth],
            )));
        }
        if depth < best.0 {
            best = (depth, Some(face));
            // A face beyond an upper bound of the depth cannot be the nearest.
            polytope.limit_search(depth + tolerance);
        }
        // A face that cannot be expanded (a sliver with an unreliable normal) is skipped.
        let is_stuck = !is_bound && (polytope.contains(&w) || !polytope.expand(face, w));
        if is_stuck {
            cost.fallbacks += 1;
        }
        if is_bound || is_stuck {
            polytope.remove_from_queue(face);
        }
    }
    cost.fallbacks += 1;
    let (depth, face) = best;
    let bounds = [f64::NEG_INFINITY, depth];
    Some(DepthSearch::Found(witness(polytope, face?, bounds)))
}

/// The answer of [`penetration_below`].
#[expect(
    clippy::large_enum_variant,
    reason = "lives for one call, on the stack"
)]
#[derive(Clone, Copy, Debug)]
pub enum DepthSearch {
    /// No direction has a smaller depth than the known one.
    NotBelow,
    /// This is the depth.
    Found(Penetration),
}

/// The witness points on a face: at the projection of the origin, or at the nearest point of the triangle. (If the
/// triangle is part of a larger facet, the projection may lie outside the triangle.)
fn witness(polytope: &ExpandingPolytope, face: u32, [lower_bound, depth]: [f64; 2]) -> Penetration {
    let (normal, _) = polytope.plane(face);
    let face = polytope.corners(face);
    debug_assert!(is_unit(normal), "no unit vector: {normal}");
    // Measured from the foot of the normal: next to a large depth, the position would be lost in rounding.
    let foot = normal * depth;
    let nearest = Preferred::nearest(&face.map(|v| v.w - foot));
    let combine = |on: fn(&CsoVertex) -> DVec3| -> DVec3 {
        let weighted = face.iter().zip(nearest.lambda);
        weighted.map(|(vertex, weight)| on(vertex) * weight).sum()
    };
    Penetration {
        depth,
        lower_bound,
        normal,
        on_1: combine(|vertex| vertex.on_1),
        on_2: combine(CsoVertex::on_2),
        face,
    }
}
