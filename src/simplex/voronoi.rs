//! Voronoi regions: the vertex, edge or face of the simplex onto which the origin projects.

use glam::DVec3;

use super::faces::{self, Combination, Triangle, nearest_edge, nearest_in_sliver, normal, segment};
use super::{DistanceSubalgorithm, Nearest};

/// Case analysis of the Voronoi regions (C. Ericson, *Real-Time Collision Detection*, 2004, ch. 5).
pub struct Voronoi;

impl DistanceSubalgorithm for Voronoi {
    #[inline]
    fn nearest(points: &[DVec3]) -> Nearest {
        faces::nearest::<Self>(points)
    }
}

impl Triangle for Voronoi {
    /// Vertex regions first, then edges, then the face.
    #[inline]
    fn triangle(a: DVec3, b: DVec3, c: DVec3) -> Combination<3> {
        let (ab, bc, ca) = (b - a, c - b, a - c);
        // How far the origin lies along each edge, seen from either end: `ab_a` from a towards b.
        let (ab_a, ca_a) = (-a.dot(ab), a.dot(ca));
        if ab_a <= 0.0 && ca_a <= 0.0 {
            return Combination::vertex(a, 0);
        }
        let (ab_b, bc_b) = (b.dot(ab), -b.dot(bc));
        if ab_b <= 0.0 && bc_b <= 0.0 {
            return Combination::vertex(b, 1);
        }
        let (bc_c, ca_c) = (c.dot(bc), -c.dot(ca));
        if bc_c <= 0.0 && ca_c <= 0.0 {
            return Combination::vertex(c, 2);
        }
        // The areas of the triangles of the projected origin and each edge, times twice the area of the
        // triangle.
        let (n, sliver) = normal(ab, bc, ca);
        let moment = n.cross(a);
        let (at_b, at_c) = (moment.dot(ca), moment.dot(ab));
        let at_a = n.length_squared() - at_b - at_c;
        if sliver {
            return nearest_in_sliver(a, b, c, [at_a, at_b, at_c]);
        }
        if at_c <= 0.0 && ab_a >= 0.0 && ab_b >= 0.0 {
            return segment(a, b).among(|[p, q]| [p, q, 0.0]);
        }
        if at_a <= 0.0 && bc_b >= 0.0 && bc_c >= 0.0 {
            return segment(b, c).among(|[p, q]| [0.0, p, q]);
        }
        if at_b <= 0.0 && ca_c >= 0.0 && ca_a >= 0.0 {
            return segment(c, a).among(|[p, q]| [q, 0.0, p]);
        }
        // If rounding leaves a gap between the regions, the origin projects next to an edge.
        Combination::interior([a, b, c], [at_a, at_b, at_c])
            .unwrap_or_else(|| nearest_edge(a, b, c, [true; 3]))
    }
}
