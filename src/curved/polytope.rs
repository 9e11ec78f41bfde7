//! Polytopes as bodies: faces, edges, and the cores of capsules and balls.

use glam::DVec3;

use super::piece::{FlatSide, Outline, Piece};
use super::surface_pieces::{CircularEdge, Ruling, SurfacePieces, point_on_flat};
use crate::primitive::nearest_share;
use crate::query::inset;
use crate::stats::Cost;
use crate::support::{FaceId, Polytope, VertexId};
use crate::tuning::EDGE_ON;

impl<P: Polytope> SurfacePieces for P {
    fn flat(&self, dir: DVec3, vertex: VertexId) -> Option<FlatSide> {
        let face = self.face_at_vertex(vertex, dir);
        let normal = self.face_normal(face);
        (normal != DVec3::ZERO).then(|| FlatSide {
            normal,
            offset: self.face_offset(face),
            outline: Outline::Polygon(face),
        })
    }

    fn inset(&self, flat: &FlatSide, p: DVec3) -> f64 {
        match flat.outline {
            Outline::Polygon(face) => self.face_inset(face, p).unwrap_or_else(|| {
                inset(self.face_corners(face), self.radius(), flat.normal, p, 0.0)
            }),
            Outline::Disc { .. } => 0.0,
        }
    }

    fn point_on_side(&self, dir: DVec3, near: DVec3, cost: &mut Cost) -> Option<DVec3> {
        let (from, vertex) = self.support(dir, self.start_vertex(dir), cost);
        let face = self.face_at_vertex(vertex, dir);
        if self.face_len(face) == 2 {
            let to = self.vertex(self.face_vertex(face, 1 - vertex.index()));
            return Some(from + (to - from) * nearest_share([from, to], near));
        }
        point_on_flat(self, &self.flat(dir, vertex)?, dir, near)
    }

    fn ball_at(&self, p: DVec3) -> (DVec3, f64) {
        (p, 0.0)
    }

    fn segment(&self) -> Option<[DVec3; 2]> {
        let face = FaceId::default();
        let end = |i: usize| self.vertex(self.face_vertex(face, i));
        (self.face_len(face) == 2).then(|| [end(0), end(1)])
    }

    fn rulings(&self, _: DVec3, vertex: VertexId) -> impl Iterator<Item = Ruling> {
        let from = self.vertex(vertex);
        self.neighbors(vertex).filter_map(move |to| {
            let axis = (self.vertex(to) - from).try_normalize()?;
            Some(Ruling { axis, sine: 0.0 })
        })
    }

    fn edge(&self, dir: DVec3, vertex: VertexId) -> Option<[DVec3; 2]> {
        let from = self.vertex(vertex);
        let ends = self.neighbors(vertex).map(|to| self.vertex(to));
        let slope = |to: &DVec3| (*to - from).normalize_or(dir).dot(dir).abs();
        let across = ends.min_by(|a, b| slope(a).total_cmp(&slope(b)));
        across.map(|to| [from, to])
    }

    fn rim(&self, _: DVec3) -> Option<CircularEdge> {
        None
    }

    fn piece(
        &self,
        dir: DVec3,
        vertex: VertexId,
        border: f64,
        corners: &mut Vec<(DVec3, VertexId)>,
    ) -> Piece {
        let face = self.face_at_vertex(vertex, dir);
        match self.face_len(face) {
            0 | 1 => Piece::Point(self.vertex(vertex)),
            2 => {
                let ends = [0, 1].map(|i| self.vertex(self.face_vertex(face, i)));
                Piece::of_edge(ends, dir, border).unwrap_or(Piece::Point(self.vertex(vertex)))
            }
            len => {
                let normal = self.face_normal(face);
                // A sliver has no normal, and a face seen edge-on is an edge.
                if normal.dot(dir) <= EDGE_ON {
                    let edge = self.edge(dir, vertex);
                    let line = edge.and_then(|edge| Piece::of_edge(edge, dir, border));
                    return line.unwrap_or(Piece::Point(self.vertex(vertex)));
                }
                let moved = normal * border;
                corners.extend((0..len).map(|i| {
                    let corner = self.face_vertex(face, i);
                    (self.vertex(corner) + moved, corner)
                }));
                Piece::Flat(FlatSide {
                    normal,
                    offset: self.face_offset(face) + border,
                    outline: Outline::Polygon(face),
                })
            }
        }
    }
}
