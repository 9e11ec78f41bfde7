//! The proof of a depth where a rim crosses a straight edge, or a line of a ruled side.

use glam::DVec3;

use super::piece::Piece;
use super::separation::NormalSeparation;
use super::surface_pieces::{CircularEdge, SurfacePieces};
use crate::support::{Cso, VertexId};
use crate::tolerance::SAME_NORMAL;

/// What a rim crosses.
#[derive(Clone, Copy)]
pub(super) enum RimPartner {
    Edge,
    /// A line of a ruled side.
    Line,
}

/// The point of shape 1 where a rim and its partner cross, if they prove that no direction of overlapping shapes has a
/// smaller depth than the normal at hand, up to `tolerance`.
///
/// The disc within the rim, swept along the edge, lies in the difference. It is an elliptic cylinder with
/// slanted ends. The depth is proved if this cylinder contains the ball with the depth as radius. Balls inside the other
/// shape that touch a line have their centres on a segment: it takes the place of the edge, and the radius of the balls is
/// taken off the depth.
pub(super) fn proved_crossing<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    partner: RimPartner,
    at: &NormalSeparation,
    tolerance: f64,
) -> Option<DVec3> {
    if at.distance >= 0.0 {
        return None;
    }
    let [on_1, on_2] = [at.extreme.on_1, at.extreme.on_2()];
    let [id_1, id_2] = at.extreme.ids;
    let depth = -at.distance;
    let sweep = Sweep::of_first_rim(cso, partner, at.normal, (on_1, id_2), depth);
    if sweep.is_some_and(|sweep| sweep.proves(depth, tolerance)) {
        return Some(on_1);
    }
    let inverse = cso.pose.inverse();
    let reversed = cso.reversed(&inverse);
    let outward_2 = -cso.pose.direction_to_2(at.normal);
    let on_rim = cso.pose.point_to_2(on_2);
    let sweep = Sweep::of_first_rim(&reversed, partner, outward_2, (on_rim, id_1), depth)?;
    sweep
        .proves(depth, tolerance)
        .then(|| on_2 + at.normal * depth)
}

/// A disc minus an edge, in frame 1.
struct Sweep {
    rim: CircularEdge,
    /// The extreme point of the rim.
    on_rim: DVec3,
    edge: [DVec3; 2],
    /// The radius of the balls around the points of the edge.
    ball: f64,
    /// Outwards from the disc.
    normal: DVec3,
}

impl Sweep {
    /// The rim of the first shape, and of the second one the edge or line that is extreme along a normal: at the point
    /// `on_rim`, and at the vertex `vertex_2`.
    fn of_first_rim<A: SurfacePieces, B: SurfacePieces>(
        cso: &Cso<'_, A, B>,
        partner: RimPartner,
        normal: DVec3,
        (on_rim, vertex_2): (DVec3, VertexId),
        depth: f64,
    ) -> Option<Self> {
        let rim = cso.shape_1.rim(normal)?;
        let outward_2 = -cso.pose.direction_to_2(normal);
        let (edge, ball) = match partner {
            RimPartner::Edge => (cso.shape_2.edge(outward_2, vertex_2)?, 0.0),
            RimPartner::Line => {
                centers(cso.shape_2, outward_2, cso.pose.point_to_2(on_rim), depth)?
            }
        };
        Some(Self {
            rim,
            on_rim,
            edge: edge.map(|p| cso.pose.point_to_1(p)),
            ball,
            normal,
        })
    }

    fn proves(&self, depth: f64, tolerance: f64) -> bool {
        let depth = depth - self.ball;
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

/// The centres of the largest balls inside a shape that touch the line of its ruled side with the normal `outward` beside
/// a point, and their radius, `most` at most.
fn centers(
    shape: &impl SurfacePieces,
    outward: DVec3,
    beside: DVec3,
    most: f64,
) -> Option<([DVec3; 2], f64)> {
    let piece = shape.piece(outward, VertexId::default(), 0.0, &mut Vec::new());
    let Piece::Line(line) = piece else {
        return None;
    };
    if (outward.dot(line.surface.axis) - line.surface.sine()).abs() > SAME_NORMAL {
        return None;
    }
    let [from, to] = line.ends;
    let along = to - from;
    let share = along.dot(beside - from) / along.length_squared();
    let radius = line.ball.radius(share.clamp(0.0, 1.0)).min(most);
    let [first, last] = line.ball.growth.map(|growth| radius / growth);
    let inwards = outward * -radius;
    Some((
        [from + along * first, to - along * last].map(|p| p + inwards),
        radius,
    ))
}
