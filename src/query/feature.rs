//! Features: parts of a polytope's boundary. Kinds of features are distinguished here; the stages of a query
//! work with their vertices and faces.

use crate::support::{Cso, CsoVertex, EdgeId, FaceCorners, FaceId, Polytope, VertexId};
use glam::DVec3;

/// A part of a polytope's boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A vertex.
    Vertex(VertexId),
    /// An edge.
    Edge(EdgeId),
    /// A face.
    Face(FaceId),
}

/// The bits of a feature's code that hold its kind.
pub(super) const KIND: u32 = 0b11 << 30;
pub(super) const VERTEX: u32 = 0b01 << 30;
const EDGE: u32 = 0b10 << 30;
pub(super) const FACE: u32 = 0b11 << 30;

/// If a face has more corners, this many suffice.
pub(super) const CORNERS: usize = 4;

impl Feature {
    /// Kind and id in one number. parry packs its features in the same way.
    #[inline]
    pub(crate) fn code(self) -> u32 {
        let (kind, id) = match self {
            Self::Vertex(vertex) => (VERTEX, u32::from(vertex)),
            Self::Edge(edge) => (EDGE, edge.into()),
            Self::Face(face) => (FACE, face.into()),
        };
        debug_assert_eq!(id & KIND, 0, "an id of too many bits");
        kind | id
    }

    /// The feature with a code, if the code is of one of the three kinds.
    #[inline]
    pub(crate) fn from_code(code: u32) -> Option<Self> {
        let id = code & !KIND;
        match code & KIND {
            VERTEX => Some(Self::Vertex(id.into())),
            EDGE => Some(Self::Edge(id.into())),
            FACE => Some(Self::Face(id.into())),
            _ => None,
        }
    }

    /// A vertex of the feature, or some other one if `shape` has no such feature.
    #[inline]
    pub(crate) fn vertex(self, shape: &impl Polytope) -> VertexId {
        let vertex = match self {
            Self::Vertex(vertex) => vertex,
            Self::Edge(edge) => shape.edge_ends(edge).unwrap_or_default()[0],
            Self::Face(face) if shape.has_face(face) => shape.face_vertex(face, 0),
            Self::Face(_) => VertexId::default(),
        };
        shape.clamp_vertex(vertex)
    }

    /// The ends of an edge, or a vertex twice. `None` for a face, and if `shape` has no such feature.
    pub(super) fn ends(self, shape: &impl Polytope) -> Option<[VertexId; 2]> {
        match self {
            Self::Vertex(vertex) => (shape.clamp_vertex(vertex) == vertex).then_some([vertex; 2]),
            Self::Edge(edge) => shape.edge_ends(edge),
            Self::Face(_) => None,
        }
    }

    /// The corners of the feature, the last of which may be repeated, and their number. For a larger face,
    /// some corners spread around it.
    pub(super) fn corners(self, shape: &impl Polytope) -> ([VertexId; CORNERS], usize) {
        match self {
            Self::Vertex(vertex) => ([vertex; CORNERS], 1),
            Self::Edge(edge) => {
                let [from, to] = shape.edge_ends(edge).unwrap_or_default();
                ([from, to, to, to], 2)
            }
            Self::Face(face) => {
                let len = shape.face_len(face);
                let corner = |i: usize| shape.face_vertex(face, i);
                let corners = if len > CORNERS {
                    [0, 1, 2, 3].map(|i| corner(i * len / CORNERS))
                } else {
                    [0, 1, 2, 3].map(|i| corner(i.min(len - 1)))
                };
                (corners, len)
            }
        }
    }

    /// The face itself, or the face around a vertex or an edge whose normal is nearest to `dir`.
    #[inline]
    pub(crate) fn face(self, shape: &impl Polytope, dir: DVec3) -> FaceId {
        match self {
            Self::Face(face) => face,
            Self::Vertex(vertex) => shape.face_at_vertex(vertex, dir),
            Self::Edge(edge) => shape.face_at_edge(edge, dir),
        }
    }

    /// The `i`-th side of a polygon: an edge, or its first corner if the side cuts across faces.
    #[inline]
    pub(crate) fn of_side(polygon: impl FaceCorners, i: usize) -> Self {
        match polygon.edge(i) {
            Some(edge) => Self::Edge(edge),
            None => Self::Vertex(polygon.vertex(i)),
        }
    }

    /// The feature that vertices span. `outward` points away from the shape.
    fn spanned(
        shape: &impl Polytope,
        mut vertices: impl Iterator<Item = VertexId>,
        outward: DVec3,
    ) -> Self {
        let first = vertices.next().unwrap_or_default();
        let face = || Self::Face(shape.face_at_vertex(first, outward));
        let mut others = vertices.filter(|&vertex| vertex != first);
        let Some(second) = others.next() else {
            return Self::Vertex(first);
        };
        if others.any(|vertex| vertex != second) {
            return face();
        }
        // Two vertices without an edge between them are a diagonal of a face.
        shape
            .edge_between(first, second)
            .map_or_else(face, Self::Edge)
    }
}

/// The features that the vertices of a simplex span. `normal` in frame 1, from shape 1 to 2.
pub(super) fn of_simplex<'v, A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    simplex: impl Iterator<Item = &'v CsoVertex> + Clone,
    normal: DVec3,
) -> [Feature; 2] {
    let ids_2 = simplex.clone().map(|vertex| vertex.ids[1]);
    let outward_2 = -cso.pose.direction_to_2(normal);
    [
        Feature::spanned(cso.shape_1, simplex.map(|vertex| vertex.ids[0]), normal),
        Feature::spanned(cso.shape_2, ids_2, outward_2),
    ]
}

/// A vertex of each feature, valid for its shape.
pub(crate) fn vertices<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    features: [Feature; 2],
) -> [VertexId; 2] {
    [
        features[0].vertex(cso.shape_1),
        features[1].vertex(cso.shape_2),
    ]
}
