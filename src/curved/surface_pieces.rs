//! Convex shapes made of pieces of surface: what contacts need besides the support mapping.

use glam::DVec3;

use super::piece::{FlatSide, Piece};
use crate::pose::RelativePose;
use crate::stats::Cost;
use crate::support::{Cso, Support, VertexId};
use crate::tolerance::KEPT_ANGLE_COS;

/// The condition that a part of a surface sets for its outward unit normals: `axis · normal = sine`. The
/// normals of an edge are perpendicular to it. Those of the side of a cylinder or a cone have a fixed angle
/// to the axis.
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

/// A place on the outline of a flat side, or on a line of a ruled side.
#[derive(Clone, Copy, Debug)]
pub struct BorderPlace {
    /// Where it is.
    pub at: DVec3,
    /// Along the outline or the line, of any length.
    pub along: DVec3,
}

/// The nearest point of a solid to a point outside of it.
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// Where it is.
    pub at: DVec3,
    /// `v · dp`, where `dp` is how fast it moves as the point outside moves by `v`.
    pub following: f64,
}

/// A convex shape whose surface consists of flat sides, ruled sides, edges and vertices. Everything is in its own
/// frame.
pub trait SurfacePieces: Support {
    /// The flat side at `vertex` whose normal is nearest to `dir`. `vertex` is extreme along `dir`.
    fn flat(&self, dir: DVec3, vertex: VertexId) -> Option<FlatSide>;

    /// The flat side whose normal is nearest to `dir`, at whatever vertex.
    fn flat_towards(&self, dir: DVec3, cost: &mut Cost) -> Option<FlatSide> {
        let (_, vertex) = self.support(dir, self.start_vertex(dir), cost);
        self.flat(dir, vertex)
    }

    /// The distance of a point in the plane of a flat side from its outline. Zero or negative outside.
    fn inset(&self, flat: &FlatSide, p: DVec3) -> f64;

    /// Whether the polygon whose normal is nearest to `dir` is a whole flat side, which ends at edges of the shape.
    fn ends_at_edges(&self, dir: DVec3) -> bool {
        let _ = dir;
        true
    }

    /// A point near `near` on the flat or ruled side whose normal is about `dir`.
    fn point_on_side(&self, dir: DVec3, near: DVec3, cost: &mut Cost) -> Option<DVec3>;

    /// The place near `near` on the outline of the flat side whose normal is about `dir`, or on the line of the ruled side.
    fn border_near(&self, dir: DVec3, near: DVec3) -> Option<BorderPlace> {
        let _ = (dir, near);
        None
    }

    /// The centre and radius of a ball inside the shape that touches the surface at `p`, a point of a ruled
    /// side. On other pieces, `p` itself with radius zero.
    fn ball_at(&self, p: DVec3) -> (DVec3, f64);

    /// The ends, if the shape is a segment.
    fn segment(&self) -> Option<[DVec3; 2]> {
        None
    }

    /// The point that is nearest to a point `p` outside, which moves by `v`, if that is known in closed form. `None`
    /// if `p` is inside.
    fn foot(&self, p: DVec3, v: DVec3) -> Option<Foot> {
        let _ = (p, v);
        None
    }

    /// The edges at `vertex`, which is extreme along `dir`, and the ruled sides.
    fn rulings(&self, dir: DVec3, vertex: VertexId) -> impl Iterator<Item = Ruling>;

    /// The straight edge at `vertex` that is most nearly perpendicular to `dir`, if there is one. `vertex` is
    /// extreme along `dir`.
    fn edge(&self, dir: DVec3, vertex: VertexId) -> Option<[DVec3; 2]>;

    /// The rim on which the extreme point along `dir` lies, if it lies on one.
    fn rim(&self, dir: DVec3) -> Option<CircularEdge>;

    /// The piece at `vertex` whose normal is nearest to `dir`. `vertex` is extreme along `dir`. The piece is
    /// moved outwards by `border`, the width of the rounded border. If it is a polygon, its corners are added
    /// to `corners`.
    fn piece(
        &self,
        dir: DVec3,
        vertex: VertexId,
        border: f64,
        corners: &mut Vec<(DVec3, VertexId)>,
    ) -> Piece;
}

/// The projection of a point into the plane of a flat side of a shape, if it is on the side, and the normal of the side is
/// about `dir`.
pub fn point_on_flat(
    shape: &impl SurfacePieces,
    flat: &FlatSide,
    dir: DVec3,
    near: DVec3,
) -> Option<DVec3> {
    let p = flat.foot(near);
    let is_on_it = flat.normal.dot(dir) >= KEPT_ANGLE_COS && shape.inset(flat, p) > 0.0;
    is_on_it.then_some(p)
}

impl<'a, A: SurfacePieces, B: SurfacePieces> Cso<'a, A, B> {
    /// The same shapes in the other order. `inverse` is the pose of shape 1 in frame 2.
    pub(super) fn reversed(&self, inverse: &'a RelativePose) -> Cso<'a, B, A> {
        Cso {
            shape_1: self.shape_2,
            shape_2: self.shape_1,
            pose: inverse,
        }
    }
}
