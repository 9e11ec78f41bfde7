//! Why a hull could not be built.

use std::fmt;

/// Why points or triangles are not a hull. Numbers are indices into the points or triangles that were given.
///
/// ```
/// use glam::Vec3;
/// use isa_gjk::{HullError, HullShape};
///
/// let square = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
/// let error = HullShape::from_points(&square).unwrap_err();
/// assert_eq!(error, HullError::Flat);
/// assert_eq!(error.to_string(), "the points span no volume");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HullError {
    /// Fewer than four points.
    TooFewPoints,
    /// More than 32,768 vertices. Their faces would not fit into 16-bit ids. Points inside the hull do not
    /// count.
    TooManyPoints,
    /// The point with this index has a NaN or infinite coordinate.
    NotFinite(usize),
    /// All points lie in a plane, on a line or in one place, or nearly so.
    Flat,
    /// A triangle refers to a vertex that does not exist, or twice to the same one.
    BadTriangle(usize),
    /// The vertex with this index is in the same place as an earlier one: the mesh is not welded.
    DuplicateVertex(usize),
    /// The vertex with this index belongs to no triangle.
    LooseVertex(usize),
    /// The surface is not closed, or an edge has more than two triangles, or two surfaces touch.
    NotManifold,
    /// The triangles turn clockwise seen from outside.
    InsideOut,
    /// The surface is not convex: this vertex lies above the plane of a neighbouring triangle, or
    /// is a corner of a triangle that faces inwards or lies over another one.
    NotConvex(usize),
    /// parry could not build its polyhedron, which rapier saves and draws, from the surface.
    BuilderFailed,
}

impl fmt::Display for HullError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewPoints => write!(f, "a hull needs at least four points"),
            Self::TooManyPoints => write!(f, "a hull may have at most 32768 vertices"),
            Self::NotFinite(i) => write!(f, "point {i} is not finite"),
            Self::Flat => write!(f, "the points span no volume"),
            Self::BadTriangle(i) => write!(f, "triangle {i} has missing or repeated vertices"),
            Self::DuplicateVertex(i) => write!(f, "vertex {i} repeats an earlier one"),
            Self::LooseVertex(i) => write!(f, "vertex {i} belongs to no triangle"),
            Self::NotManifold => write!(f, "the triangles do not form one closed surface"),
            Self::InsideOut => write!(f, "the triangles turn clockwise seen from outside"),
            Self::NotConvex(i) => write!(f, "the surface is not convex at vertex {i}"),
            Self::BuilderFailed => write!(f, "parry makes no polyhedron of the surface"),
        }
    }
}

impl std::error::Error for HullError {}
