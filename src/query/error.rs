//! Errors of queries.

use std::error::Error;
use std::fmt;

/// Why a query has no answer.
///
/// ```
/// use isa_gjk::query::{QueryError, SeparationBounds};
/// use rapier3d::prelude::*;
///
/// let ball = SharedShape::ball(0.5);
/// let bounds = SeparationBounds::between(&*ball, &*ball, &Pose::translation(3.0, 0.0, 0.0));
/// assert_eq!(bounds.unwrap_err(), QueryError::NoHull);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum QueryError {
    /// Neither shape is a hull: a `ConvexPolyhedron`, a `RoundConvexPolyhedron` or a
    /// [`HullShape`](crate::HullShape). Query shapes with parts part by part.
    NoHull,
    /// The other shape is unknown to this query, or degenerate.
    OtherShape,
    /// A plain hull is flat, not convex, too large or not finite. [`HullShape`](crate::HullShape) reports the
    /// reason.
    HullNotPrepared,
    /// The relative pose or the prediction distance is not finite, or too large to compute with.
    NotFinite,
}

impl fmt::Display for QueryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoHull => "neither shape is a convex hull",
            Self::OtherShape => "the query does not know the shape beside the hull",
            Self::HullNotPrepared => "a hull is flat, not convex, too large or not finite",
            Self::NotFinite => "the pose or the prediction distance is not finite",
        })
    }
}

impl Error for QueryError {}
