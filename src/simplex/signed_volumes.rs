//! Signed volumes: which faces of the simplex the projected origin lies beyond.

use glam::{DVec2, DVec3};

use super::faces::{self, nearest_edge, nearest_in_sliver, normal, normalized};
use super::{DistanceSubalgorithm, Nearest};

/// Signs of sub-volumes, recursing on the faces the origin lies beyond (M. Montanari, N. Petrinic,
/// E. Barbieri, *Improving the GJK Algorithm for Faster and More Reliable Distance Queries Between
/// Convex Objects*, ACM Transactions on Graphics 36(3), 2017).
pub struct SignedVolumes;

impl DistanceSubalgorithm for SignedVolumes {
    #[inline]
    fn nearest(points: &[DVec3]) -> Nearest {
        faces::nearest(points, triangle)
    }
}

/// The nearest point of a triangle. Areas are measured in the coordinate plane on which the
/// triangle is largest: no products of more than two lengths, hence little cancellation.
#[inline]
fn triangle(y: [DVec3; 3]) -> [f64; 3] {
    let (n, sliver) = normal(y);
    let origin = n * (y[0].dot(n) / n.length_squared());
    let [a, b, c] = flatten(n, y.map(|vertex| vertex - origin));
    let areas = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)];
    if sliver {
        return nearest_in_sliver(y, areas);
    }
    let beyond =
        areas.map(|area| !matches!(area.partial_cmp(&0.0), Some(std::cmp::Ordering::Greater)));
    if beyond == [false; 3] {
        normalized(areas)
    } else {
        nearest_edge(y, beyond)
    }
}

/// Drops the coordinate in which the normal is largest; counter-clockwise about the normal stays
/// counter-clockwise.
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
