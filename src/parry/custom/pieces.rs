//! The pieces of surface of a user's own shape.

use glam::DVec3;

use super::feature::{ExtremeFeature, MAX_CORNERS};
use super::shape::{CustomShape, extreme};
use crate::curved::{CircularEdge, FlatSide, Outline, Piece, Ruling, SurfacePieces, point_on_flat};
use crate::primitive::nearest_share;
use crate::stats::Cost;
use crate::support::{FaceId, VertexId};
use crate::tuning::EDGE_ON;

/// A face, moved outwards by a border.
fn flat_side(face: &ExtremeFeature, normal: DVec3, border: f64) -> FlatSide {
    let (corner, _) = face.corners()[0];
    FlatSide {
        normal,
        offset: normal.dot(corner) + border,
        outline: Outline::Polygon(FaceId::default()),
    }
}

impl CustomShape<'_> {
    /// The edge or the point that is extreme along `dir`.
    fn edge_or_point(&self, dir: DVec3, border: f64) -> Piece {
        let edge = self.extreme_edge(dir);
        let edge = edge.filter(|edge| border == 0.0 || self.is_sharp(*edge, dir));
        let line = edge.and_then(|edge| Piece::of_edge(edge, dir, border));
        line.unwrap_or_else(|| Piece::Point(extreme(self.support, dir)))
    }
}

impl SurfacePieces for CustomShape<'_> {
    fn flat(&self, dir: DVec3, _: VertexId) -> Option<FlatSide> {
        let (face, normal) = self.face(dir)?;
        Some(flat_side(&face, normal, 0.0))
    }

    fn inset(&self, flat: &FlatSide, p: DVec3) -> f64 {
        let Some((face, normal)) = self.face(flat.normal) else {
            return 0.0;
        };
        face.inset(normal, p)
    }

    fn ends_at_edges(&self, dir: DVec3) -> bool {
        self.face(dir)
            .is_some_and(|(face, normal)| self.are_edges(&face, normal))
    }

    fn point_on_side(&self, dir: DVec3, near: DVec3, _: &mut Cost) -> Option<DVec3> {
        if let Some(flat) = self.flat(dir, VertexId::default()) {
            return point_on_flat(self, &flat, dir, near);
        }
        let [a, b] = self.extreme_edge(dir)?;
        Some(a.lerp(b, nearest_share([a, b], near)))
    }

    fn ball_at(&self, p: DVec3) -> (DVec3, f64) {
        (p, 0.0)
    }

    fn rulings(&self, dir: DVec3, _: VertexId) -> impl Iterator<Item = Ruling> {
        let mut rulings = [None; MAX_CORNERS];
        let feature = self.feature(dir, 2);
        let edges = feature.iter().flat_map(ExtremeFeature::edges);
        for (ruling, [a, b]) in rulings.iter_mut().zip(edges) {
            *ruling = (b - a)
                .try_normalize()
                .map(|axis| Ruling { axis, sine: 0.0 });
        }
        rulings.into_iter().flatten()
    }

    fn edge(&self, dir: DVec3, _: VertexId) -> Option<[DVec3; 2]> {
        self.extreme_edge(dir)
    }

    fn rim(&self, _: DVec3) -> Option<CircularEdge> {
        None
    }

    fn piece(
        &self,
        dir: DVec3,
        _: VertexId,
        border: f64,
        corners: &mut Vec<(DVec3, VertexId)>,
    ) -> Piece {
        match self.face(dir) {
            Some((face, normal)) if normal.dot(dir) > EDGE_ON => {
                let moved = normal * border;
                corners.extend(face.corners().iter().map(|&(at, id)| (at + moved, id)));
                Piece::Flat(flat_side(&face, normal, border))
            }
            _ => self.edge_or_point(dir, border),
        }
    }
}
