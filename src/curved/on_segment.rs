//! Capsules: the place of the segment inside that is nearest to the other shape, as long as that is apart from it.

use glam::DVec3;

use super::query::{CurvedAnswer, CurvedQuery};
use super::surface_pieces::SurfacePieces;
use crate::gjk::SeparatingAxis;
use crate::support::VertexId;
use crate::tolerance::{FINE_GAP, MIN_DIRECTED_DISTANCE};
use crate::tuning::MAX_SEGMENT_STEPS;

/// A place of a segment and the nearest point of a solid, which prove their distance.
struct ProvedPlace {
    /// The fraction of the segment at the place.
    share: f64,
    /// From the solid to the place.
    between: DVec3,
    distance: f64,
    /// A plane proves that no place of the segment is nearer than this.
    separation: f64,
}

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// The answer for a segment and a solid that are apart.
    pub(super) fn on_segment(&mut self) -> Option<CurvedAnswer> {
        let pose = self.cso.pose;
        let ends = self.cso.shape_1.segment()?;
        let ProvedPlace {
            share,
            between,
            distance,
            separation,
        } = nearest(self.cso.shape_2, ends.map(|end| pose.point_to_2(end)))?;
        if distance < MIN_DIRECTED_DISTANCE * self.cso.size() {
            return None;
        }
        self.cost.supports += 1;
        let normal = pose.direction_to_1(between / -distance);
        if separation > self.max_distance {
            return Some(CurvedAnswer::Separated(SeparatingAxis {
                axis: normal,
                separation,
                ids: [VertexId::default(); 2],
            }));
        }
        self.scratch.patch.aim_along(normal);
        let [a, b] = ends;
        Some(CurvedAnswer::Near {
            signed_distance: distance,
            normal,
            on_1: a.lerp(b, share) + normal * self.border_radii[0],
        })
    }
}

/// Half of the squared distance from a convex solid is a convex function along a segment. Newton's method finds where
/// its slope vanishes, between two places at which the slope has opposite signs.
fn nearest(solid: &impl SurfacePieces, [a, b]: [DVec3; 2]) -> Option<ProvedPlace> {
    let along = b - a;
    let [mut low, mut high] = [0.0, 1.0];
    let mut share = 0.5;
    for _ in 0..MAX_SEGMENT_STEPS {
        let p = a + along * share;
        let foot = solid.foot(p, along)?;
        let between = p - foot.at;
        let slope = between.dot(along);
        let squared = between.length_squared();
        // How much nearer to the plane through the foot one end of the segment is, times the distance.
        let excess = (slope * share).max(slope * (share - 1.0));
        if excess <= FINE_GAP * squared {
            let distance = squared.sqrt();
            return Some(ProvedPlace {
                share,
                between,
                distance,
                separation: distance - excess / distance,
            });
        }
        let (fresh, end) = if slope > 0.0 {
            high = share;
            (low == 0.0, low)
        } else {
            low = share;
            (high == 1.0, high)
        };
        let next = share - slope / (along.length_squared() - foot.following);
        share = if low < next && next < high {
            next
        } else if fresh {
            end
        } else {
            0.5 * (low + high)
        };
    }
    None
}
