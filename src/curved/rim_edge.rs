//! What proves a depth where a rim crosses a straight edge.

use glam::DVec3;

use super::body::{Body, CircularEdge};
use super::stationary::NormalSeparation;
use crate::support::Cso;
use crate::tolerance::SAME_NORMAL;

/// The point of shape 1 where a rim and an edge of overlapping shapes cross, if these prove that no depth is less
/// than that along the normal at hand, up to `tolerance`.
///
/// The disc in the rim, swept along the edge, is a part of the difference: an elliptic cylinder with slanted
/// ends. The depth is its least one if the ball of the depth is in it.
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
        // An edge along the axis or across it has no such cylinder.
        let Some(wide) = axis.cross(along).try_normalize() else {
            return false;
        };
        if self.normal.dot(along).abs() > SAME_NORMAL || rise.abs() < SAME_NORMAL {
            return false;
        }
        // Where on the edge the lines of the cylinder through the ball are in the plane of the disc.
        let height = axis.dot(self.on_rim - from) / rise;
        let reach = depth / rise.abs();
        if height < reach || height + reach > length {
            return false;
        }
        // Inside of an ellipse, the nearest point is that on whose normal a point is, up to the long axis.
        let outward = (self.on_rim - self.rim.center) / radius;
        let (cosine, sine) = (outward.dot(wide), outward.dot(axis.cross(wide)));
        let most = rise.abs() * radius * (rise * cosine).hypot(sine);
        let aside = self.normal.cross(along).dot(self.on_rim - from);
        most - (most - depth).hypot(aside) >= depth - tolerance
    }
}
