//! The faces and edges that a user's own shape tells.

use glam::DVec3;
use parry3d::shape::{PackedFeatureId, PolygonalFeature};

use super::shape::{CustomShape, extreme, rounded};
use crate::mix::extended;
use crate::support::{Support, VertexId};
use crate::tuning::SMALL_TURN;

/// parry's features have no more corners.
pub(super) const MAX_CORNERS: usize = 4;

/// The face or the edge that is extreme along a direction.
#[derive(Clone, Copy)]
pub(super) struct ExtremeFeature {
    corners: [(DVec3, VertexId); MAX_CORNERS],
    count: usize,
}

impl ExtremeFeature {
    pub fn triangle([a, b, c]: [(DVec3, VertexId); 3]) -> Self {
        Self {
            corners: [a, b, c, c],
            count: 3,
        }
    }

    pub fn corners(&self) -> &[(DVec3, VertexId)] {
        &self.corners[..self.count]
    }

    /// Its sides, counter-clockwise if it is a face. An edge is the same from both ends.
    pub fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let corners = self.corners();
        let next = move |i: usize| corners[(i + 1) % corners.len()].0;
        (0..corners.len()).map(move |i| [corners[i].0, next(i)])
    }

    /// The same seen from the other side.
    pub fn reversed(mut self) -> Self {
        self.corners[..self.count].reverse();
        self
    }

    /// How far inside of a face the line along `normal` through a point is. The face is counter-clockwise seen against
    /// `normal`.
    pub fn inset(&self, normal: DVec3, p: DVec3) -> f64 {
        let insets = self.edges().map(|[a, b]| {
            let inward = normal.cross(b - a).normalize_or_zero();
            inward.dot(p - a)
        });
        insets.fold(f64::INFINITY, f64::min)
    }

    /// The area vector, which is perpendicular to a face.
    pub fn area(&self) -> DVec3 {
        let origin = self.corners[0].0;
        let triangles = self.edges().map(|[a, b]| (a - origin).cross(b - origin));
        triangles.sum()
    }
}

impl CustomShape<'_> {
    /// The face or edge that is extreme along `dir`, if it has at least so many corners.
    pub(super) fn feature(&self, dir: DVec3, least: usize) -> Option<ExtremeFeature> {
        let mut feature = PolygonalFeature::default();
        self.features?
            .local_support_feature(rounded(dir), &mut feature);
        let corner = |i: usize| (feature.vertices[i].as_dvec3(), vertex_id(feature.vids[i]));
        let count = feature.num_vertices;
        (least..=MAX_CORNERS)
            .contains(&count)
            .then(|| ExtremeFeature {
                corners: std::array::from_fn(corner),
                count,
            })
    }

    /// Of the edges of the face that is extreme along `dir`, the one that is extreme.
    pub(super) fn extreme_edge(&self, dir: DVec3) -> Option<[DVec3; 2]> {
        let lower_end = |[a, b]: &[DVec3; 2]| dir.dot(*a).min(dir.dot(*b));
        let feature = self.feature(dir, 2)?;
        let edges = feature.edges();
        edges.max_by(|a, b| lower_end(a).total_cmp(&lower_end(b)))
    }

    /// Whether an edge is extreme along `dir`, and along directions a little to both sides of it: then the border goes
    /// around it. The line of a round side is no such edge.
    pub(super) fn is_sharp(&self, [a, b]: [DVec3; 2], dir: DVec3) -> bool {
        let Some(axis) = (b - a).try_normalize() else {
            return false;
        };
        let outward = dir.reject_from_normalized(axis).normalize_or_zero();
        [-SMALL_TURN, SMALL_TURN].into_iter().all(|turn| {
            let turned = outward + axis.cross(outward) * turn;
            let highest = turned.dot(extreme(self.support, turned));
            highest - turned.dot(a) <= self.rounding()
        })
    }
}

/// As many bits of an id as fit into a manifold's memory.
const ID_BITS: u32 = f32::MANTISSA_DIGITS;

fn vertex_id(id: PackedFeatureId) -> VertexId {
    VertexId::from(id.0 % (1 << ID_BITS))
}

/// The id of a corner that the shape has not told.
pub(super) fn id_by_place(corner: DVec3) -> VertexId {
    let words = corner.to_array().map(f64::to_bits);
    let hash = words.into_iter().fold(0, extended);
    VertexId::from((hash >> (u64::BITS - ID_BITS)) as u32)
}
