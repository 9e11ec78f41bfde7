//! The convex hull of points (Barber, Dobkin, Huhdanpaa, *The quickhull algorithm for convex hulls*,
//! ACM Trans. Math. Softw. 22(4), 1996).
//!
//! Points are compared with planes by exact signs. So the horizon is always a single loop, the surface is
//! exactly convex, and every point is on or beneath it, even if points are coplanar, coincide, or form a thin
//! hull.

mod facet;
mod growing_hull;
mod orientation;

use glam::{DVec3, Vec3};

use crate::at::At;
use crate::hull::HullError;
use growing_hull::GrowingHull;

/// The triangulated surface of a hull.
pub(crate) struct HullTriangles {
    /// The corners, in the order of the points.
    pub vertices: Vec<Vec3>,
    /// Counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Whether some of them seem to be in one plane.
    pub seem_flat: bool,
}

/// The hull of finite points.
///
/// # Errors
/// If the points lie in a plane, or more of them are corners than a hull may have.
pub(super) fn convex_hull(points: &[Vec3]) -> Result<HullTriangles, HullError> {
    let exact: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let mut hull = GrowingHull::tetrahedron(&exact)?;
    hull.grow()?;
    let (bends, seem_flat) = hull.bends();
    // At a point in a flat side or on a straight edge, fewer than three edges bend.
    let corners: Vec<usize> = (0..points.len()).filter(|&v| bends[v] > 2).collect();
    let vertices: Vec<Vec3> = corners.iter().map(|&v| points[v]).collect();
    // The surface has more vertices than that (Euler's formula): some lie in its sides.
    if hull.facet_count() / 2 + 2 > corners.len() {
        return convex_hull(&vertices);
    }
    let mut ids = vec![0; points.len()];
    for (id, &corner) in (0..).zip(&corners) {
        ids[corner] = id;
    }
    let triangles = (hull.surface()).map(|facet| facet.vertices.map(|v| ids.at(v)));
    Ok(HullTriangles {
        vertices,
        triangles: triangles.collect(),
        seem_flat,
    })
}
