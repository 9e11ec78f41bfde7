//! The proof of a depth where a rim crosses a straight edge.

use glam::DVec3;

use super::body::{Body, CircularEdge};
use super::stationary::NormalSeparation;
use crate::support::Cso;
use crate::tolerance::SAME_NORMAL;

/// The point of shape 1 where a rim and an edge of overlapping shapes cross, if they prove that no direction
/// has a smaller depth than the normal at hand, up to `tolerance`.
///
/// The disc within the rim, swept along the edge, lies in the difference. It is an elliptic cylinder with
/// slanted ends. The depth is proved if this cylinder contains the ball with the depth as radius.
pub(super) fn proved_crossing<A: Body, B: Body>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
    tolerance: f64,
) -> Option<DVec3> {
    if at.distance >= 0.0 {
        return None;
    }
    let (sweep, on_1) = sweep_of_first(cso, at).or_else(|| sweep_of_second(cso, at))?;
    sweep.contains_ball(-at.distance, tolerance).then_some(on_1)
}

/// A rim of the first shape and an edge of the second one, and their place on shape 1.
fn sweep_of_first<A: Body, B: Body>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
) -> Option<(Sweep, DVec3)> {
    let outward_2 = -cso.pose.direction_to_2(at.normal);
    let rim = cso.shape_1.rim(at.normal)?;
    let edge = cso.shape_2.edge(outward_2, at.extreme.ids[1])?;
    let sweep = Sweep {
        rim,
        on_rim: at.extreme.on_1,
        edge: edge.map(|p| cso.pose.point_to_1(p)),
        normal: at.normal,
    };
    Some((sweep, at.extreme.on_1))
}

/// The same with the shapes' parts exchanged.
fn sweep_of_second<A: Body, B: Body>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
) -> Option<(Sweep, DVec3)> {
    let outward_2 = -cso.pose.direction_to_2(at.normal);
    let rim = cso.shape_2.rim(outward_2)?;
    let edge = cso.shape_1.edge(at.normal, at.extreme.ids[0])?;
    let on_rim = at.extreme.on_2();
    let sweep = Sweep {
        rim: CircularEdge {
            axis: cso.pose.direction_to_1(rim.axis),
            center: cso.pose.point_to_1(rim.center),
            ..rim
        },
        on_rim,
        edge,
        normal: -at.normal,
    };
    Some((sweep, on_rim - at.normal * at.distance))
}

/// A disc minus an edge.
struct Sweep {
    rim: CircularEdge,
    /// The extreme point of the rim.
    on_rim: DVec3,
    edge: [DVec3; 2],
    /// Outwards from the disc.
    normal: DVec3,
}

impl Sweep {
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
