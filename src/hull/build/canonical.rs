//! Hulls that depend on nothing but their points: not on the order of the triangles, and not on the diagonals of
//! flat sides.

use glam::{DVec3, Vec3};

use super::face_loops::sorted;
use super::flat_sides::FlatFaces;
use super::steep::steep_hull;
use crate::hull::Hull;
use crate::hull::lists::Rows;

/// The hull with this surface, if each edge bends, or is a diagonal of a flat side. `seems_flat` only decides what is
/// tried first.
pub(crate) fn canonical_hull(
    points: &[Vec3],
    triangles: &[[u32; 3]],
    seems_flat: bool,
) -> Option<Hull> {
    if !seems_flat && let Some(hull) = hull_that_bends(points, triangles) {
        return Some(hull);
    }
    if !points.iter().all(|p| p.is_finite()) {
        return None;
    }
    let exact: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let faces = FlatFaces::of_triangles(&exact, triangles, around_middle(points).1)?;
    hull_of_flat_faces(points, &faces)
}

/// The same if each edge bends.
fn hull_that_bends(points: &[Vec3], triangles: &[[u32; 3]]) -> Option<Hull> {
    steep_hull(points, triangles, &Rows::default()).or_else(|| {
        let triangles = sorted(triangles, points.len())?;
        Hull::from_bent_triangles(points.to_vec(), &triangles).ok()?
    })
}

/// The hull with these flat sides.
pub(super) fn hull_of_flat_faces(points: &[Vec3], faces: &FlatFaces) -> Option<Hull> {
    steep_hull(points, &faces.triangles, &faces.polygons).or_else(|| {
        let triangles = sorted(&faces.triangles, points.len())?;
        Hull::from_reordered_triangles(points.to_vec(), &triangles).ok()
    })
}

impl Hull {
    /// The faces as triangle fans.
    pub(crate) fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::with_capacity(2 * self.points.len());
        for face in self.face_ids() {
            let corners = self.faces.polygon(face);
            let at = |i: usize| u32::from(corners[i].vertex);
            triangles.extend((2..corners.len()).map(|i| [at(0), at(i - 1), at(i)]));
        }
        triangles
    }
}

/// The middle of the vertices, which is inside the hull, and the largest distance of a vertex from it.
pub(super) fn around_middle(points: &[Vec3]) -> (DVec3, f64) {
    let middle = points.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / points.len() as f64;
    let squares = points.iter().map(|p| p.as_dvec3().distance_squared(middle));
    (middle, squares.fold(0.0, f64::max).sqrt())
}
