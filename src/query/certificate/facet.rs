//! Features in contact, and the proof that they still are.
//!
//! A pair of features spans a facet of the Minkowski difference: a face and a vertex, or two edges that
//! cross. Re-evaluated at the present poses, it is again a polygon inside the Minkowski difference. One
//! support pair along its normal shows whether its plane supports the difference. If so, the signed distance
//! of the plane from the origin bounds the true one from one side. From the other side,
//!
//! - if the plane separates the shapes: the origin projects into the polygon, so a point of the
//!   difference is that near;
//! - if they overlap by `d`: the pyramid from the polygon to the difference's centre lies in the difference.
//!   If the origin is at least `d` inside all of its sides, so does the ball of radius `d`, and no direction
//!   has a smaller depth. This is a *global* proof, although no other face was examined. Before that, a copy
//!   of the shape with the face, around the vertex, may contain the ball; and of two boxes all separating axes
//!   are compared.

use std::cmp::Ordering;

use glam::DVec3;

use super::boxes::are_deep_boxes;
use super::flush::FlushFaces;
use super::polygon::{cone_contains_ball, crossing, inset, inset_of_origin, pyramid_contains_ball};
use crate::gjk::SeparatingAxis;
use crate::map_pair::map_pair;
use crate::query::feature::Feature;
use crate::query::types::Proximity;
use crate::query::verdict::{FacetEdge, Verdict};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, FaceCorners, FaceId, Polytope, VertexId};
use crate::tolerance::PARALLEL_EDGES;
use crate::tuning::{MANY_SIDES, SHALLOW};

/// Re-evaluates the facet that `features` span.
#[inline]
pub(in crate::query) fn certify<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    features: [Feature; 2],
    mut flush: impl FnMut() -> Option<FlushFaces>,
    [max_distance, tolerance]: [f64; 2],
    cost: &mut Cost,
) -> Verdict {
    let test = FacetTest {
        max_distance,
        tolerance,
    };
    match features {
        [Feature::Edge(e1), Feature::Edge(e2)] => {
            match (cso.shape_1.edge_ends(e1), cso.shape_2.edge_ends(e2)) {
                (Some(ends_1), Some(ends_2)) => test.edges(cso, features, ends_1, ends_2, cost),
                _ => Verdict::Degenerate,
            }
        }
        [Feature::Face(f1), other] if cso.shape_1.has_face(f1) => {
            let start = other.vertex(cso.shape_2);
            test.face(cso, (f1, start), &mut flush, cost)
        }
        [other, Feature::Face(f2)] if cso.shape_2.has_face(f2) => {
            let start = other.vertex(cso.shape_1);
            let reversed = Cso {
                shape_1: cso.shape_2,
                shape_2: cso.shape_1,
                pose: &cso.pose.inverse(),
            };
            let mut flush = || flush().map(|flush| flush.reversed(cso.pose));
            test.face(&reversed, (f2, start), &mut flush, cost)
                .reversed(cso.pose)
        }
        _ => Verdict::Degenerate,
    }
}

struct FacetTest {
    max_distance: f64,
    tolerance: f64,
}

impl FacetTest {
    /// A face of the first shape against the second one. The climb over that begins at `start`. If the facet alone
    /// does not prove enough, and the faces lie `flush`, these may.
    #[inline]
    fn face<P: Polytope, Q: Polytope>(
        &self,
        cso: &Cso<'_, P, Q>,
        (face, start): (FaceId, VertexId),
        flush: &mut dyn FnMut() -> Option<FlushFaces>,
        cost: &mut Cost,
    ) -> Verdict {
        let &Cso {
            shape_1: p,
            shape_2: q,
            pose: q_pose,
        } = cso;
        let normal = p.face_normal(face);
        if normal == DVec3::ZERO {
            return Verdict::Degenerate; // a sliver without a plane
        }
        let (on_q, q_id) = q.support(-q_pose.direction_to_2(normal), start, cost);
        let on_q = q_pose.point_to_1(on_q);
        let signed_distance = normal.dot(on_q) - p.face_offset(face);
        if signed_distance > self.max_distance {
            return Verdict::Separated(SeparatingAxis {
                axis: normal,
                separation: signed_distance,
                ids: [p.face_vertex(face, 0), q_id],
            });
        }
        let certified = Proximity {
            signed_distance,
            normal,
            on_1: on_q - normal * signed_distance,
            on_2: on_q,
            features: [Feature::Face(face), Feature::Vertex(q_id)],
        };
        if self.is_certified(cso, &certified, face, flush) {
            return Verdict::Certified(certified);
        }
        let (apex, depth) = (cso.center(), -signed_distance - self.tolerance);
        let corners = p.face_points(face).map(|corner| corner - on_q);
        let inset = match inset_of_origin(corners.clone(), normal, self.tolerance) {
            Ok(inset) => inset,
            Err(side) => {
                let ends = map_pair(side.ends, |i| [p.face_vertex(face, i), q_id]);
                return Verdict::OutsideEdge(FacetEdge::new(ends, side.along, normal));
            }
        };
        if signed_distance >= 0.0 || pyramid_contains_ball(corners, apex, depth) {
            return Verdict::Certified(certified);
        }
        Verdict::Undecided(certified, inset)
    }

    /// Whether the face alone proves a shallow depth or a distance, or flush faces do. The cheaper proof comes first.
    #[inline]
    fn is_certified<P: Polytope, Q: Polytope>(
        &self,
        cso: &Cso<'_, P, Q>,
        near: &Proximity,
        face: FaceId,
        flush: &mut dyn FnMut() -> Option<FlushFaces>,
    ) -> bool {
        let (signed_distance, normal, on_2) = (near.signed_distance, near.normal, near.on_2);
        let depth = -signed_distance - self.tolerance;
        // The difference contains a copy of the first shape around the vertex of the second one.
        let ball = if depth > 0.0 { on_2 } else { near.on_1 };
        let planes = cso.shape_1.face_planes();
        let holds = |center, r| planes.is_some_and(|planes| planes.hold_ball(face, center, r));
        if holds(ball, depth.max(0.0)) {
            return true;
        }
        if depth >= SHALLOW * cso.shape_1.radius() {
            return are_deep_boxes(cso, depth) && holds(near.on_1, 0.0);
        }
        let (corners, radius) = (cso.shape_1.face_corners(face), cso.shape_1.radius());
        let mut flush_faces_prove = |is_over: bool| {
            flush().is_some_and(|flush| {
                let faces = [face, flush.faces[1]];
                let flush = FlushFaces { faces, ..flush };
                flush.prove_vertex(cso, (on_2, is_over), signed_distance, -depth)
            })
        };
        let has_many_sides = corners.count() > MANY_SIDES;
        if has_many_sides && flush_faces_prove(false) {
            return true;
        }
        let inset = inset(corners, radius, normal, on_2, signed_distance);
        let is_over = inset > 0.0;
        is_over
            && (depth <= 0.0
                || cone_contains_ball(inset, depth, cso.center(), normal)
                || are_deep_boxes(cso, depth))
            || !has_many_sides && flush_faces_prove(is_over)
    }

    /// Two edges that cross; everything in frame 1.
    #[inline]
    fn edges<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        features: [Feature; 2],
        ends_1: [VertexId; 2],
        ends_2: [VertexId; 2],
        cost: &mut Cost,
    ) -> Verdict {
        let [a0, a1] = map_pair(ends_1, |v| cso.shape_1.vertex(v));
        let [b0, b1] = map_pair(ends_2, |v| cso.pose.point_to_1(cso.shape_2.vertex(v)));
        let (along_1, along_2) = (a1 - a0, b1 - b0);
        let (center, offset) = (cso.center(), a0 - b0);
        let Some(plane) = EdgePlane::new(along_1, along_2, offset - center) else {
            return Verdict::Degenerate;
        };
        let normal = plane.normal;
        // This comes before the support: the facet is left whether or not the two edges still span one.
        let corners =
            || parallelogram([[a0, a1], [b0, b1]], [ends_1, ends_2], plane.is_along_cross);
        let [s, t] = crossing(offset, along_1, along_2);
        let is_inside = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
        if !is_inside {
            let corners = corners();
            let points = corners.iter().map(|corner| corner.w);
            if let Err(side) = inset_of_origin(points, normal, self.tolerance) {
                let ends = map_pair(side.ends, |i| corners[i].ids);
                return Verdict::OutsideEdge(FacetEdge::new(ends, side.along, normal));
            }
        }
        let extreme = cso.support(normal, [ends_1[0], ends_2[0]], cost);
        let signed_distance = -normal.dot(extreme.w);
        if signed_distance > self.max_distance {
            return Verdict::Separated(SeparatingAxis {
                axis: normal,
                separation: signed_distance,
                ids: extreme.ids,
            });
        }
        if -normal.dot(offset) - signed_distance > self.tolerance {
            return Verdict::NotSupporting(extreme, normal);
        }
        let on_1 = a0 + along_1 * s;
        let proximity = Proximity {
            signed_distance,
            normal,
            on_1,
            on_2: on_1 + normal * signed_distance,
            features,
        };
        let depth = -signed_distance - self.tolerance;
        let inset = s.min(1.0 - s).min(t).min(1.0 - t) * plane.least_height;
        if signed_distance >= 0.0
            || cone_contains_ball(inset, depth, center, normal)
            || are_deep_boxes(cso, depth)
            || pyramid_contains_ball(corners().iter().map(|corner| corner.w), center, depth)
        {
            return Verdict::Certified(proximity);
        }
        Verdict::Undecided(proximity, inset)
    }
}

/// The plane of the facet that two edges span.
struct EdgePlane {
    /// Out of the difference.
    normal: DVec3,
    /// Whether the normal is along the cross product of the edges' directions, not against it.
    is_along_cross: bool,
    /// The smaller height of the parallelogram. Its sides are along the edges.
    least_height: f64,
}

impl EdgePlane {
    /// `None` for parallel edges. `outward` is any vector from inside the difference to the facet.
    #[inline]
    fn new(along_1: DVec3, along_2: DVec3, outward: DVec3) -> Option<Self> {
        let cross = along_1.cross(along_2);
        let area_squared = cross.length_squared();
        let (squared_1, squared_2) = (along_1.length_squared(), along_2.length_squared());
        let angle = area_squared.partial_cmp(&(PARALLEL_EDGES * (squared_1 * squared_2)));
        if angle != Some(Ordering::Greater) {
            return None;
        }
        let area = area_squared.sqrt();
        let is_along_cross = cross.dot(outward) >= 0.0;
        let sign = if is_along_cross { 1.0 } else { -1.0 };
        Some(Self {
            normal: cross * (sign / area),
            is_along_cross,
            least_height: area / squared_1.max(squared_2).sqrt(),
        })
    }
}

/// The corners of the facet that two edges span, counter-clockwise seen from outside. `along` is whether the
/// outward normal is along the cross product of their directions, not against it.
#[inline]
fn parallelogram(
    [edge_1, edge_2]: [[DVec3; 2]; 2],
    [ends_1, ends_2]: [[VertexId; 2]; 2],
    along: bool,
) -> [CsoVertex; 4] {
    let corner = |a: usize, b: usize| CsoVertex {
        w: edge_1[a] - edge_2[b],
        on_1: edge_1[a],
        ids: [ends_1[a], ends_2[b]],
    };
    // The first edge forwards, then the second backwards, turn clockwise about the cross product.
    let (from, to) = if along { (1, 0) } else { (0, 1) };
    [
        corner(0, from),
        corner(1, from),
        corner(1, to),
        corner(0, to),
    ]
}
