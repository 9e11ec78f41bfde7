//! Two boxes, whose depth all separating axes prove together. The axis of least overlap leads to the nearest facet.

use glam::DVec3;

use crate::oriented_box::BoxFacet;
use crate::query::feature::Feature;
use crate::stats::Cost;
use crate::support::{Cso, EdgeId, Polytope, VertexId};

/// Whether the shapes are known to be boxes, and no direction has a smaller depth.
#[inline]
pub(super) fn are_deep_boxes<P: Polytope, Q: Polytope>(cso: &Cso<'_, P, Q>, depth: f64) -> bool {
    match (cso.shape_1.oriented_box(), cso.shape_2.oriented_box()) {
        (Some(first), Some(second)) => first.overlap_by(second, cso.pose, depth, cso.size()),
        _ => false,
    }
}

/// The features that span the facet along the axis of least overlap, if the shapes are known to be boxes. They still
/// need to be certified.
#[inline]
pub(in crate::query) fn nearest_facet<P: Polytope, Q: Polytope>(
    cso: &Cso<'_, P, Q>,
    cost: &mut Cost,
) -> Option<[Feature; 2]> {
    let (first, second) = (cso.shape_1.oriented_box()?, cso.shape_2.oriented_box()?);
    let (normal, facet) = first.least_overlap(second, cso.pose)?;
    features(cso, normal, facet, cost)
}

/// The features of two boxes that span a facet with this normal.
#[cold]
#[inline(never)]
fn features<P: Polytope, Q: Polytope>(
    cso: &Cso<'_, P, Q>,
    normal: DVec3,
    facet: BoxFacet,
    cost: &mut Cost,
) -> Option<[Feature; 2]> {
    let [v1, v2] = cso.support(normal, cso.start_vertices(normal), cost).ids;
    Some(match facet {
        BoxFacet::FirstFace => {
            let face = cso.shape_1.face_at_vertex(v1, normal);
            [Feature::Face(face), Feature::Vertex(v2)]
        }
        BoxFacet::SecondFace => {
            let outward = -cso.pose.direction_to_2(normal);
            let face = cso.shape_2.face_at_vertex(v2, outward);
            [Feature::Vertex(v1), Feature::Face(face)]
        }
        BoxFacet::Edges([along_1, along_2]) => [
            Feature::Edge(edge_along(cso.shape_1, v1, along_1)?),
            Feature::Edge(edge_along(cso.shape_2, v2, along_2)?),
        ],
    })
}

/// The edge at a vertex whose direction is nearest to that of a line.
fn edge_along(shape: &impl Polytope, vertex: VertexId, line: DVec3) -> Option<EdgeId> {
    let from = shape.vertex(vertex);
    let cosine = |to: VertexId| {
        let along = (shape.vertex(to) - from).normalize_or_zero();
        along.dot(line).abs()
    };
    let ends = shape.neighbors(vertex);
    let end = ends.max_by(|&a, &b| cosine(a).total_cmp(&cosine(b)))?;
    shape.edge_between(vertex, end)
}
