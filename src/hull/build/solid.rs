//! Building hulls from points and triangles.

use std::borrow::Cow;

use glam::Vec3;

use super::morton;
use super::quickhull::{self, HullTriangles};
use super::surface::Surface;
use super::validate::validate_finite;
use crate::hull::{Hull, HullError, scan};

/// The surface of the hull of a point cloud.
pub(crate) fn surface_of_points(points: &[Vec3]) -> Result<HullTriangles, HullError> {
    if points.len() < 4 {
        return Err(HullError::TooFewPoints);
    }
    validate_finite(points)?;
    quickhull::convex_hull(points)
}

impl Hull {
    /// The convex hull of a point cloud. It is exact: no point is left out.
    ///
    /// Vertex ids are indices into [`points`](Self::points), not into the argument: points inside the hull, its
    /// faces or its edges are dropped, equal points become one vertex, and the order changes.
    ///
    /// # Errors
    /// [`HullError`] says what is wrong with the points.
    ///
    /// ```
    /// use glam::Vec3;
    /// use isa_gjk::Hull;
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::splat(0.1)];
    /// let hull = Hull::from_points(&corners)?;
    /// assert_eq!(hull.points().len(), 4); // the last point is inside
    /// # Ok::<(), isa_gjk::HullError>(())
    /// ```
    pub fn from_points(points: &[Vec3]) -> Result<Self, HullError> {
        let surface = surface_of_points(points)?;
        Self::from_reordered_triangles(surface.vertices, &surface.triangles)
    }

    /// Like [`from_triangles`](Self::from_triangles), but reorders the vertices for faster climbs.
    pub(in crate::hull) fn from_reordered_triangles(
        points: Vec<Vec3>,
        triangles: &[[u32; 3]],
    ) -> Result<Self, HullError> {
        let (points, triangles) = reordered(points, triangles);
        Self::from_triangles(points, &triangles)
    }

    /// The same for a surface that bends at every edge; `None` for others.
    pub(in crate::hull) fn from_bent_triangles(
        points: Vec<Vec3>,
        triangles: &[[u32; 3]],
    ) -> Result<Option<Self>, HullError> {
        let (points, triangles) = reordered(points, triangles);
        let surface = Surface::new(points, &triangles)?;
        if surface.bends_everywhere() {
            surface.into_hull().map(Some)
        } else {
            Ok(None)
        }
    }

    /// From the triangulated surface of a convex polytope, counter-clockwise from outside.
    ///
    /// Vertex ids are indices into `points`.
    ///
    /// # Errors
    /// [`HullError`] says what is wrong with the surface.
    pub fn from_triangles(points: Vec<Vec3>, triangles: &[[u32; 3]]) -> Result<Self, HullError> {
        Surface::new(points, triangles)?.into_hull()
    }
}

/// Checks what [`Hull::from_triangles`] checks before it looks for faces. Returns whether the surface bends at every
/// edge.
pub(crate) fn bends_everywhere(
    points: Vec<Vec3>,
    triangles: &[[u32; 3]],
) -> Result<bool, HullError> {
    Ok(Surface::new(points, triangles)?.bends_everywhere())
}

/// The vertices and triangles of a large hull in an order for faster climbs.
fn reordered(points: Vec<Vec3>, triangles: &[[u32; 3]]) -> (Vec<Vec3>, Cow<'_, [[u32; 3]]>) {
    if points.len() <= scan::LARGEST {
        return (points, triangles.into());
    }
    let (points, triangles) = morton::morton_order(&points, triangles);
    (points, triangles.into())
}
