//! Voronoi regions: which vertex, edge or face of the simplex the origin projects on.

use glam::DVec3;

use super::faces::{self, nearest_in_sliver, normal, normalized};
use super::{DistanceSubalgorithm, Nearest};

/// Case analysis of the Voronoi regions (C. Ericson, *Real-Time Collision Detection*, 2004, ch. 5).
pub struct Voronoi;

impl DistanceSubalgorithm for Voronoi {
    #[inline]
    fn nearest(points: &[DVec3]) -> Nearest {
        faces::nearest(points, triangle)
    }
}

/// The nearest point of a triangle: vertex regions first, then edges, then the face.
#[inline]
fn triangle(y: [DVec3; 3]) -> [f64; 3] {
    let [a, b, c] = y;
    let (ab, bc, ca) = (b - a, c - b, a - c);
    // How far the origin lies along each edge, seen from either end: `ab_a` from a towards b.
    let (ab_a, ab_b) = (-a.dot(ab), b.dot(ab));
    let (bc_b, bc_c) = (-b.dot(bc), c.dot(bc));
    let (ca_c, ca_a) = (-c.dot(ca), a.dot(ca));
    if ab_a <= 0.0 && ca_a <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    if ab_b <= 0.0 && bc_b <= 0.0 {
        return [0.0, 1.0, 0.0];
    }
    if bc_c <= 0.0 && ca_c <= 0.0 {
        return [0.0, 0.0, 1.0];
    }
    // Areas of the projected origin with each edge, times twice the triangle's.
    let (n, sliver) = normal(y);
    let areas = [n.dot(b.cross(bc)), n.dot(c.cross(ca)), n.dot(a.cross(ab))];
    if sliver {
        return nearest_in_sliver(y, areas);
    }
    if areas[2] <= 0.0 && ab_a >= 0.0 && ab_b >= 0.0 {
        let [p, q] = normalized([ab_b, ab_a]);
        return [p, q, 0.0];
    }
    if areas[0] <= 0.0 && bc_b >= 0.0 && bc_c >= 0.0 {
        let [p, q] = normalized([bc_c, bc_b]);
        return [0.0, p, q];
    }
    if areas[1] <= 0.0 && ca_c >= 0.0 && ca_a >= 0.0 {
        let [p, q] = normalized([ca_a, ca_c]);
        return [q, 0.0, p];
    }
    if areas.iter().all(|&area| area > 0.0) {
        return normalized(areas);
    }
    // Rounding left a gap between the regions.
    nearest_in_sliver(y, areas)
}
