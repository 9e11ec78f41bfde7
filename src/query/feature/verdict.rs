//! What features turned out to prove, and where to go on from.

use glam::DVec3;

use crate::gjk::SeparatingAxis;
use crate::pose::RelativePose;
use crate::query::Proximity;
use crate::support::CsoVertex;

/// What a pair of features turned out to prove.
#[expect(
    clippy::large_enum_variant,
    reason = "lives for one call, on the stack"
)]
pub(in crate::query) enum Verdict {
    /// The facet's plane separates the shapes by more than was asked about.
    Apart(SeparatingAxis),
    /// The facet's signed distance is that of the shapes.
    Certified(Proximity),
    /// The origin projects beyond this side of the facet: another one is nearest by now.
    Beyond(Side),
    /// The facet's plane, with this normal, cuts through the difference: this vertex is beyond it.
    Cut(CsoVertex, DVec3),
    /// The shapes overlap, perhaps less elsewhere. Points of the Minkowski difference around the
    /// facet, to go on from, and the answer if the facet turns out to be the nearest.
    Unproved(Seeds, Proximity),
    /// These features do not span a facet.
    NoPlane,
}

/// A side of a facet. In frame 1.
#[derive(Clone, Copy, Debug)]
pub(in crate::query) struct Side {
    /// Its end points.
    pub ends: [CsoVertex; 2],
    /// The facet's normal, from shape 1 to shape 2.
    pub normal: DVec3,
    /// The unit direction in the facet's plane out of the facet.
    pub outward: DVec3,
}

impl Side {
    pub(super) fn new(from: CsoVertex, to: CsoVertex, normal: DVec3) -> Self {
        Self {
            ends: [from, to],
            normal,
            outward: (to.w - from.w).cross(normal).normalize_or_zero(),
        }
    }
}

/// A few points of the Minkowski difference.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::query) struct Seeds {
    points: [CsoVertex; 5],
    len: usize,
}

impl Seeds {
    pub fn new(points: &[CsoVertex]) -> Self {
        let mut seeds = Self::default();
        points.iter().for_each(|point| seeds.push(*point));
        seeds
    }

    pub fn as_slice(&self) -> &[CsoVertex] {
        &self.points[..self.len]
    }

    pub fn push(&mut self, point: CsoVertex) {
        if self.len < self.points.len() {
            self.points[self.len] = point;
            self.len += 1;
        }
    }
}

impl Verdict {
    /// From the frame of shape 2, with the shapes swapped, to frame 1.
    pub(super) fn mirrored(self, pose: &RelativePose) -> Self {
        match self {
            Self::Apart(apart) => Self::Apart(SeparatingAxis {
                axis: -pose.direction_to_1(apart.axis),
                separation: apart.separation,
                ids: [apart.ids[1], apart.ids[0]],
            }),
            Self::Certified(proximity) => Self::Certified(mirrored_proximity(&proximity, pose)),
            Self::Beyond(side) => Self::Beyond(Side {
                ends: side.ends.map(|vertex| mirrored(&vertex, pose)),
                normal: -pose.direction_to_1(side.normal),
                outward: -pose.direction_to_1(side.outward),
            }),
            Self::Cut(vertex, normal) => {
                Self::Cut(mirrored(&vertex, pose), -pose.direction_to_1(normal))
            }
            Self::Unproved(mut seeds, candidate) => {
                for seed in &mut seeds.points[..seeds.len] {
                    *seed = mirrored(seed, pose);
                }
                Self::Unproved(seeds, mirrored_proximity(&candidate, pose))
            }
            Self::NoPlane => Self::NoPlane,
        }
    }
}

fn mirrored(vertex: &CsoVertex, pose: &RelativePose) -> CsoVertex {
    CsoVertex {
        w: -pose.direction_to_1(vertex.w),
        on_1: pose.point_to_1(vertex.on_2()),
        ids: [vertex.ids[1], vertex.ids[0]],
    }
}

fn mirrored_proximity(p: &Proximity, pose: &RelativePose) -> Proximity {
    Proximity {
        signed_distance: p.signed_distance,
        normal: -pose.direction_to_1(p.normal),
        on_1: pose.point_to_1(p.on_2),
        on_2: pose.point_to_1(p.on_1),
        features: [p.features[1], p.features[0]],
    }
}
