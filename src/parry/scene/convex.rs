//! Convex shapes without a hull, for queries without memory.

use glam::DVec3;
use parry3d::query::Unsupported;
use parry3d::shape::{Shape, ShapeType};

use crate::curved::{CircularEdge, FlatSide, Piece, Ruling, SurfacePieces};
use crate::map_pair::map_pair;
use crate::parry::convert::Core;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::parry::workspace::{ThreadWorkspace, Workspace};
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
        }
    };
}

impl Support for Core {
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

    fn center(&self) -> DVec3 {
        of_shape!(self, shape => shape.center())
    }

    fn radius(&self) -> f64 {
        of_shape!(self, shape => shape.radius())
    }
}

/// The most edges at a vertex: a cuboid's.
const MAX_RULINGS: usize = 3;

impl SurfacePieces for Core {
    fn flat(&self, dir: DVec3, vertex: VertexId) -> Option<FlatSide> {
        of_shape!(self, shape => shape.flat(dir, vertex))
    }

    fn inset(&self, flat: &FlatSide, p: DVec3) -> f64 {
        of_shape!(self, shape => shape.inset(flat, p))
    }

    fn point_on_side(&self, dir: DVec3, near: DVec3, cost: &mut Cost) -> Option<DVec3> {
        of_shape!(self, shape => shape.point_on_side(dir, near, cost))
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

/// Hands two convex shapes without a hull to `answer`, if both are known.
pub(super) fn visit<T>(
    shapes: [&dyn Shape; 2],
    answer: impl FnOnce(&Pair<'_, Core, Core>, &mut Workspace) -> Result<T, Unsupported>,
) -> Result<T, Unsupported> {
    let cores = map_pair(shapes, Core::of);
    let [Some((first, border_1)), Some((second, border_2))] = &cores else {
        return Err(Unsupported);
    };
    let pair = Pair {
        hull: first,
        other: second,
        border_radii: [*border_1, *border_2].map(f64::from),
        order: PairOrder::default(),
    };
    ThreadWorkspace::with(|thread| answer(&pair, &mut thread.workspace))
}

/// As [`visit`], but for balls with shapes on whose surface parry projects their centre: that is exact, and
/// cheaper.
pub(super) fn visit_inexact<T>(
    shapes: [&dyn Shape; 2],
    answer: impl FnOnce(&Pair<'_, Core, Core>, &mut Workspace) -> Result<T, Unsupported>,
) -> Result<T, Unsupported> {
    let kinds = shapes.map(|shape| shape.shape_type());
    let is_rounded = |kind: &ShapeType| {
        use ShapeType::{RoundCone, RoundCuboid, RoundCylinder, RoundTriangle};
        matches!(
            kind,
            RoundCone | RoundCuboid | RoundCylinder | RoundTriangle
        )
    };
    if kinds.contains(&ShapeType::Ball) && !kinds.iter().any(is_rounded) {
        return Err(Unsupported);
    }
    visit(shapes, answer)
}
