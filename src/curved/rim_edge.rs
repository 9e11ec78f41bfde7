//! The proof of a depth where a rim crosses a straight edge.

use glam::DVec3;

use super::separation::NormalSeparation;
use super::surface_pieces::{CircularEdge, SurfacePieces};
use crate::support::{Cso, VertexId};
use crate::tolerance::SAME_NORMAL;

/// The point of shape 1 where a rim and an edge of overlapping shapes cross, if they prove that no direction
/// has a smaller depth than the normal at hand, up to `tolerance`.
///
/// The disc within the rim, swept along the edge, lies in the difference. It is an elliptic cylinder with
/// slanted ends. The depth is proved if this cylinder contains the ball with the depth as radius.
pub(super) fn proved_crossing<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
    tolerance: f64,
) -> Option<DVec3> {
    if at.distance >= 0.0 {
        return None;
    }
    let [on_1, on_2] = [at.extreme.on_1, at.extreme.on_2()];
    let [id_1, id_2] = at.extreme.ids;
    let (sweep, on_1) = match Sweep::of_first_rim(cso, at.normal, on_1, id_2) {
        Some(sweep) => (sweep, on_1),
        None => {
            let inverse = cso.pose.inverse();
            let reversed = cso.reversed(&inverse);
            let outward_2 = -cso.pose.direction_to_2(at.normal);
            let sweep = Sweep::of_first_rim(&reversed, outward_2, cso.pose.point_to_2(on_2), id_1)?;
            (sweep, on_2 - at.normal * at.distance)
        }
    };
    sweep.contains_ball(-at.distance, tolerance).then_some(on_1)
}

/// A disc minus an edge, in frame 1.
struct Sweep {
    rim: CircularEdge,
    /// The extreme point of the rim.
    on_rim: DVec3,
    edge: [DVec3; 2],
    /// Outwards from the disc.
    normal: DVec3,
}

impl Sweep {
    /// The rim of the first shape and the edge of the second one that are extreme along a normal: at the point
    /// `on_rim`, and at the vertex `vertex_2`.
    fn of_first_rim<A: SurfacePieces, B: SurfacePieces>(
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        on_rim: DVec3,
        vertex_2: VertexId,
    ) -> Option<Self> {
        let rim = cso.shape_1.rim(normal)?;
        let outward_2 = -cso.pose.direction_to_2(normal);
        let edge = cso.shape_2.edge(outward_2, vertex_2)?;
        Some(Self {
            rim,
            on_rim,
            edge: edge.map(|p| cso.pose.point_to_1(p)),
            normal,
        })
    }

    fn contains_ball(&self, depth: f64, tolerance: f64) -> bool {
        let [from, to] = self.edge;
        let length = from.distance(to);
        let (CircularEdge { axis, radius, .. }, along) = (self.rim, (to - from) / length);
        let rise = axis.dot(along);
        // There is no such cylinder if the edge is parallel or perpendicular to the axis.
        let Some(wide) = axis.cross(along).try_normalize() else {
            return false;
        };
        if self.normal.dot(along).abs() > SAME_NORMAL || rise.abs() < SAME_NORMAL {
            return false;
        }
        // The generators through the ball must meet the plane of the disc within the edge.
        let height = axis.dot(self.on_rim - from) / rise;
        let reach = depth / rise.abs();
        if height < reach || height + reach > length {
            return false;
        }
        // Within an ellipse, the nearest boundary point is the one whose normal passes through the given
        // point, as long as that is not beyond the long axis.
        let outward = (self.on_rim - self.rim.center) / radius;
        let (cosine, sine) = (outward.dot(wide), outward.dot(axis.cross(wide)));
        let most = rise.abs() * radius * (rise * cosine).hypot(sine);
        let aside = self.normal.cross(along).dot(self.on_rim - from);
        most - (most - depth).hypot(aside) >= depth - tolerance
    }
}
