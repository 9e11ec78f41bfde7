//! Any convex shape other than a hull as one type, where a copy of the code for each kind would gain little.

use glam::DVec3;

use crate::curved::{BorderPlace, CircularEdge, FlatSide, Piece, Ruling, SurfacePieces};
use crate::parry::convert::Core;
use crate::stats::Cost;
use crate::support::{Support, VertexId};

/// Evaluates an expression about the shape in a core.
macro_rules! of_shape {
    ($core:expr, $shape:ident => $answer:expr) => {
        match $core {
            Core::Ball($shape) => $answer,
            Core::Segment($shape) => $answer,
            Core::Triangle($shape) => $answer,
            Core::Cuboid($shape) => $answer,
            Core::Cylinder($shape) => $answer,
            Core::Cone($shape) => $answer,
            Core::Custom($shape) => $answer,
        }
    };
}

impl Support for Core<'_> {
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        of_shape!(self, shape => shape.support(dir, start, cost))
    }

    fn extent(&self, dir: DVec3) -> f64 {
        of_shape!(self, shape => shape.extent(dir))
    }

    fn start_vertex(&self, dir: DVec3) -> VertexId {
        of_shape!(self, shape => shape.start_vertex(dir))
    }

    fn clamp_vertex(&self, vertex: VertexId) -> VertexId {
        of_shape!(self, shape => shape.clamp_vertex(vertex))
    }

    fn rounding(&self) -> f64 {
        of_shape!(self, shape => shape.rounding())
    }

    fn rolls(&self, from: DVec3, to: DVec3) -> bool {
        of_shape!(self, shape => shape.rolls(from, to))
    }

    fn center(&self) -> DVec3 {
        of_shape!(self, shape => shape.center())
    }

    fn radius(&self) -> f64 {
        of_shape!(self, shape => shape.radius())
    }
}

/// The most edges that matter at a place: those of a face of a user's own shape.
const MAX_RULINGS: usize = 4;

impl SurfacePieces for Core<'_> {
    fn flat(&self, dir: DVec3, vertex: VertexId) -> Option<FlatSide> {
        of_shape!(self, shape => shape.flat(dir, vertex))
    }

    fn flat_towards(&self, dir: DVec3, cost: &mut Cost) -> Option<FlatSide> {
        of_shape!(self, shape => shape.flat_towards(dir, cost))
    }

    fn inset(&self, flat: &FlatSide, p: DVec3) -> f64 {
        of_shape!(self, shape => shape.inset(flat, p))
    }

    fn ends_at_edges(&self, dir: DVec3) -> bool {
        of_shape!(self, shape => shape.ends_at_edges(dir))
    }

    fn point_on_side(&self, dir: DVec3, near: DVec3, cost: &mut Cost) -> Option<DVec3> {
        of_shape!(self, shape => shape.point_on_side(dir, near, cost))
    }

    fn border_near(&self, dir: DVec3, near: DVec3) -> Option<BorderPlace> {
        of_shape!(self, shape => shape.border_near(dir, near))
    }

    fn ball_at(&self, p: DVec3) -> (DVec3, f64) {
        of_shape!(self, shape => shape.ball_at(p))
    }

    fn rulings(&self, dir: DVec3, vertex: VertexId) -> impl Iterator<Item = Ruling> {
        let mut rulings = [None; MAX_RULINGS];
        of_shape!(self, shape => {
            let places = rulings.iter_mut().zip(shape.rulings(dir, vertex));
            places.for_each(|(place, ruling)| *place = Some(ruling));
        });
        rulings.into_iter().flatten()
    }

    fn edge(&self, dir: DVec3, vertex: VertexId) -> Option<[DVec3; 2]> {
        of_shape!(self, shape => shape.edge(dir, vertex))
    }

    fn rim(&self, dir: DVec3) -> Option<CircularEdge> {
        of_shape!(self, shape => shape.rim(dir))
    }

    fn piece(
        &self,
        dir: DVec3,
        vertex: VertexId,
        border: f64,
        corners: &mut Vec<(DVec3, VertexId)>,
    ) -> Piece {
        of_shape!(self, shape => shape.piece(dir, vertex, border, corners))
    }
}
