//! Polytopes as bodies: faces, edges, and the cores of capsules and balls.

use glam::DVec3;

use super::piece::{FlatSide, Outline, Piece};
use super::surface_pieces::{BorderPlace, CircularEdge, Ruling, SurfacePieces, point_on_flat};
use crate::primitive::nearest_share;
use crate::query::inset;
use crate::stats::Cost;
use crate::support::{FaceId, FacePoints, Polytope, VertexId};
use crate::tolerance::FACE_FLATNESS;
use crate::tuning::EDGE_ON;

fn flat_side(shape: &impl Polytope, face: FaceId) -> Option<FlatSide> {
    let normal = shape.face_normal(face);
    (normal != DVec3::ZERO).then(|| FlatSide {
        normal,
        offset: shape.face_offset(face),
        outline: Outline::Polygon(face),
    })
}

/// The point of the line where two flat sides meet that is nearest to `p`, a point in the plane of the first one. The second
/// one is the nearest beside it. `None` if `p` is outside of a shape with this radius.
fn meet(side: &FlatSide, other: &FlatSide, p: DVec3, radius: f64) -> Option<BorderPlace> {
    let outward = other.normal - side.normal * side.normal.dot(other.normal);
    let beneath = other.offset - other.normal.dot(p);
    let at = p + outward * (beneath / outward.length_squared());
    let is_on_it = beneath >= -FACE_FLATNESS * radius && at.is_finite();
    is_on_it.then(|| BorderPlace {
        at,
        along: side.normal.cross(other.normal),
    })
}

/// The point of the outline of a face that is nearest to a point.
fn nearest_on_outline(corners: impl FacePoints, p: DVec3) -> Option<BorderPlace> {
    let mut from = corners.clone().next_back()?;
    let mut nearest = (f64::INFINITY, None);
    for to in corners {
        let along = to - from;
        let at = from + along * nearest_share([from, to], p);
        let squared = at.distance_squared(p);
        if squared < nearest.0 {
            nearest = (squared, Some(BorderPlace { at, along }));
        }
        from = to;
    }
    nearest.1
}

impl<P: Polytope> SurfacePieces for P {
    fn flat(&self, dir: DVec3, vertex: VertexId) -> Option<FlatSide> {
        flat_side(self, self.face_at_vertex(vertex, dir))
    }

    fn flat_towards(&self, dir: DVec3, cost: &mut Cost) -> Option<FlatSide> {
        let planes = self.face_planes();
        if let Some(face) = planes.and_then(|planes| planes.face_towards(dir)) {
            return flat_side(self, face);
        }
        let (_, vertex) = self.support(dir, self.start_vertex(dir), cost);
        self.flat(dir, vertex)
    }

    fn inset(&self, flat: &FlatSide, p: DVec3) -> f64 {
        match flat.outline {
            Outline::Polygon(face) => {
                let of_planes = || self.face_planes()?.inset(face, p);
                let known = self.face_inset(face, p).or_else(of_planes);
                known.unwrap_or_else(|| {
                    inset(self.face_corners(face), self.radius(), flat.normal, p, 0.0)
                })
            }
            Outline::Disc { .. } => 0.0,
        }
    }

    fn point_on_side(&self, dir: DVec3, near: DVec3, cost: &mut Cost) -> Option<DVec3> {
        if let Some(ends) = self.segment() {
            return Some(ends[0].lerp(ends[1], nearest_share(ends, near)));
        }
        point_on_flat(self, &self.flat_towards(dir, cost)?, dir, near)
    }

    fn border_near(&self, dir: DVec3, near: DVec3) -> Option<BorderPlace> {
        if let Some([a, b]) = self.segment() {
            return Some(BorderPlace {
                at: a.lerp(b, nearest_share([a, b], near)),
                along: b - a,
            });
        }
        let flat = self.flat_towards(dir, &mut Cost::default())?;
        let Outline::Polygon(face) = flat.outline else {
            return None;
        };
        let p = flat.foot(near);
        let planes = self.face_planes();
        match planes.and_then(|planes| planes.nearest_beside(face, p)) {
            Some(beside) => meet(&flat, &flat_side(self, beside)?, p, self.radius()),
            None => nearest_on_outline(self.face_points(face), p),
        }
    }

    fn ball_at(&self, p: DVec3) -> (DVec3, f64) {
        (p, 0.0)
    }

    fn segment(&self) -> Option<[DVec3; 2]> {
        let face = FaceId::default();
        let end = |i: usize| self.vertex(self.face_vertex(face, i));
        let is_segment = self.face_planes().is_none() && self.face_len(face) == 2;
        is_segment.then(|| [end(0), end(1)])
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
