//! Signed volumes: which faces of the simplex the projected origin lies beyond.

use glam::{DVec2, DVec3};

use super::faces::{self, Combination, Triangle, nearest_edge, nearest_in_sliver, normal};
use super::{DistanceSubalgorithm, Nearest};

/// Signs of sub-volumes, recursing on the faces the origin lies beyond (M. Montanari, N. Petrinic,
/// E. Barbieri, *Improving the GJK Algorithm for Faster and More Reliable Distance Queries Between
/// Convex Objects*, ACM Transactions on Graphics 36(3), 2017).
pub struct SignedVolumes;

impl DistanceSubalgorithm for SignedVolumes {
    #[inline(always)]
    fn nearest(points: &[DVec3]) -> Nearest {
        faces::nearest::<Self>(points)
    }
}

impl Triangle for SignedVolumes {
    /// Areas are measured in the coordinate plane in which the triangle is largest: products of two lengths,
    /// rather than four, lose little to cancellation.
    #[inline]
    fn triangle(a: DVec3, b: DVec3, c: DVec3) -> Combination<3> {
        let (n, sliver) = normal(b - a, c - b, a - c);
        let origin = n * (a.dot(n) / n.length_squared());
        let [p, q, r] = flatten(n, [a - origin, b - origin, c - origin]);
        let areas = [q.perp_dot(r), r.perp_dot(p), p.perp_dot(q)];
        if sliver {
            return nearest_in_sliver(a, b, c, areas);
        }
        Combination::interior([a, b, c], areas).unwrap_or_else(|| {
            let inner = areas.map(|area| area > 0.0);
            nearest_edge(a, b, c, inner.map(|inner| !inner))
        })
    }
}

/// Drops the coordinate in which the normal is largest, and keeps the orientation about the normal.
#[inline]
fn flatten(n: DVec3, y: [DVec3; 3]) -> [DVec2; 3] {
    let size = n.abs();
    if size.x >= size.y && size.x >= size.z {
        y.map(|v| DVec2::new(v.y, v.z * n.x.signum()))
    } else if size.y >= size.z {
        y.map(|v| DVec2::new(v.z, v.x * n.y.signum()))
    } else {
        y.map(|v| DVec2::new(v.x, v.y * n.z.signum()))
    }
}
