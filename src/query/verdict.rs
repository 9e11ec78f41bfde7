//! The verdict on a pair of features: an answer, or where the walk continues.

use glam::DVec3;

use crate::gjk::SeparatingAxis;
use crate::map_pair::map_pair;
use crate::pose::{RelativePose, is_unit};
use crate::query::types::Proximity;
use crate::support::{CsoVertex, VertexId};

/// What a pair of features proves.
pub(crate) enum Verdict {
    /// The facet's plane separates the shapes by more than the maximum distance.
    Separated(SeparatingAxis),
    /// The facet's signed distance is that of the shapes.
    Certified(Proximity),
    /// The origin projects beyond this side of the facet: another facet is nearest now.
    OutsideEdge(FacetEdge),
    /// The facet's plane, with this normal, cuts through the difference: this vertex is beyond it.
    NotSupporting(CsoVertex, DVec3),
    /// The shapes overlap, but perhaps less in another direction. This is the answer if the facet is the
    /// nearest. The origin projects into it, this far from its sides.
    Undecided(Proximity, f64),
    /// These features do not span a facet.
    Degenerate,
}

/// A side of a facet. In frame 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FacetEdge {
    /// The vertices at its ends.
    pub ends: [[VertexId; 2]; 2],
    /// The facet's normal, from shape 1 to shape 2.
    pub normal: DVec3,
    /// The direction in the facet's plane out of the facet.
    pub outward: DVec3,
}

impl FacetEdge {
    /// The side from one vertex to the next, with the vector `along` between them.
    #[inline]
    pub(in crate::query) fn new(ends: [[VertexId; 2]; 2], along: DVec3, normal: DVec3) -> Self {
        debug_assert!(is_unit(normal), "no unit vector: {normal}");
        Self {
            ends,
            normal,
            outward: along.cross(normal),
        }
    }
}

impl Verdict {
    /// Converts from the frame of shape 2, with the shapes in the other order, to frame 1.
    #[inline]
    pub(in crate::query) fn reversed(&self, pose: &RelativePose) -> Self {
        let direction = |dir| -pose.direction_to_1(dir);
        match self {
            Self::Separated(apart) => Self::Separated(SeparatingAxis {
                axis: direction(apart.axis),
                separation: apart.separation,
                ids: flipped(apart.ids),
            }),
            Self::Certified(proximity) => Self::Certified(reversed(proximity, pose)),
            Self::OutsideEdge(side) => Self::OutsideEdge(FacetEdge {
                ends: map_pair(side.ends, flipped),
                normal: direction(side.normal),
                outward: direction(side.outward),
            }),
            Self::NotSupporting(vertex, normal) => {
                let vertex = CsoVertex {
                    w: direction(vertex.w),
                    on_1: pose.point_to_1(vertex.on_2()),
                    ids: flipped(vertex.ids),
                };
                Self::NotSupporting(vertex, direction(*normal))
            }
            Self::Undecided(candidate, inset) => Self::Undecided(reversed(candidate, pose), *inset),
            Self::Degenerate => Self::Degenerate,
        }
    }
}

#[inline]
fn flipped<T>([a, b]: [T; 2]) -> [T; 2] {
    [b, a]
}

#[inline]
fn reversed(p: &Proximity, pose: &RelativePose) -> Proximity {
    Proximity {
        signed_distance: p.signed_distance,
        normal: -pose.direction_to_1(p.normal),
        on_1: pose.point_to_1(p.on_2),
        on_2: pose.point_to_1(p.on_1),
        features: flipped(p.features),
    }
}
