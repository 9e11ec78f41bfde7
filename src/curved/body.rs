//! What contacts need to know of a convex shape beside its support mapping.

use glam::DVec3;

use super::piece::{FlatSide, Piece};
use crate::stats::Cost;
use crate::support::{Support, VertexId};

/// What a part of a surface demands of its outward unit normal: `axis · normal = sine`. An edge has normals
/// square to it; the side of a cylinder or a cone has normals with one angle to the axis.
#[derive(Clone, Copy, Debug)]
pub struct Ruling {
    /// A unit vector.
    pub axis: DVec3,
    /// Zero for an edge.
    pub sine: f64,
}

/// A circular edge.
#[derive(Clone, Copy, Debug)]
pub struct CircularEdge {
    /// A point of its axis.
    pub center: DVec3,
    /// The unit vector along its axis.
    pub axis: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// A convex shape with pieces of surface. Everything is in its own frame.
pub trait Body: Support {
    /// The flat side at `vertex`, extreme along `dir`, that looks most along `dir`.
    fn flat(&self, dir: DVec3, vertex: VertexId) -> Option<FlatSide>;

    /// How far inside a flat side a point of its plane is; not more than zero outside.
    fn inset(&self, flat: &FlatSide, p: DVec3) -> f64;

    /// A point of the flat or ruled side that looks about along `dir`, near another point.
    fn point_on_side(&self, dir: DVec3, near: DVec3, cost: &mut Cost) -> Option<DVec3>;

    /// The centre and the radius of a ball inside that touches the surface at a point of a ruled side; the point
    /// itself on others.
    fn ball_at(&self, p: DVec3) -> (DVec3, f64);

    /// The edges at `vertex`, extreme along `dir`, and the ruled sides.
    fn rulings(&self, dir: DVec3, vertex: VertexId) -> impl Iterator<Item = Ruling>;

    /// The straight edge at `vertex`, extreme along `dir`, that is most across that, if there is one.
    fn edge(&self, dir: DVec3, vertex: VertexId) -> Option<[DVec3; 2]>;

    /// The rim on which the point is that is extreme along `dir`, if it is on one.
    fn rim(&self, dir: DVec3) -> Option<CircularEdge>;

    /// The piece at `vertex`, extreme along `dir`, that looks most along `dir`. `border` is the width of the
    /// rounded border, by which the piece is moved outwards. The corners of a polygon go to `corners`.
    fn piece(
        &self,
        dir: DVec3,
        vertex: VertexId,
        border: f64,
        corners: &mut Vec<(DVec3, VertexId)>,
    ) -> Piece;
}
