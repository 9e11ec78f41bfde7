//! The order of a hull's vertices in memory. A step of a climb reads all neighbours of a vertex. In the order
//! in which hull builders number them, each neighbour is on another cache line.

use crate::at::At;
use glam::Vec3;

/// Bits per coordinate. This makes about a thousand cells along an axis, along which a hull has at most a few
/// hundred vertices.
const BITS: u32 = 10;

/// The vertices and triangles of a surface, renumbered so that neighbours in space are neighbours in memory:
/// vertices along a space-filling curve (Morton, *A computer oriented geodetic data base and a new technique
/// in file sequencing*, IBM, 1966), and triangles by their corners.
pub(in crate::hull) fn morton_order(
    points: &[Vec3],
    triangles: &[[u32; 3]],
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let low = points.iter().copied().reduce(Vec3::min).unwrap_or_default();
    let high = points.iter().copied().reduce(Vec3::max).unwrap_or_default();
    let cells = (1 << BITS) as f32 / (high - low).max_element();
    let mut order: Vec<u32> = (0..points.short_len()).collect();
    order.sort_by_cached_key(|&v| morton_code((points.at(v) - low) * cells));
    let mut number = vec![0; points.len()];
    for (new, &old) in (0..).zip(&order) {
        *number.at_mut(old) = new;
    }
    let renumbered = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|v| number.at(v));
        // The same triangle, starting at its lowest corner.
        [[a, b, c], [b, c, a], [c, a, b]].into_iter().min()
    });
    let mut triangles: Vec<[u32; 3]> = renumbered.flatten().collect();
    triangles.sort_unstable();
    let points = order.iter().map(|&v| points.at(v)).collect();
    (points, triangles)
}

/// The position of a cell along the curve: the interleaved bits of its coordinates.
fn morton_code(cell: Vec3) -> u32 {
    // Casts saturate.
    let coordinates = cell.to_array().map(|x| (x as u32).min((1 << BITS) - 1));
    (0..BITS).fold(0, |code, bit| {
        let [x, y, z] = coordinates.map(|coordinate| coordinate >> bit & 1);
        code | (x | y << 1 | z << 2) << (3 * bit)
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn sphere(count: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut rng = oorandom::Rand64::new(11);
        let mut coordinate = || 2.0 * rng.rand_float() as f32 - 1.0;
        let points: Vec<Vec3> = (0..count)
            .map(|_| Vec3::from([(); 3].map(|()| coordinate())).normalize_or(Vec3::X))
            .collect();
        parry3d::transformation::try_convex_hull(&points).expect("a hull")
    }

    fn corners(points: &[Vec3], triangles: &[[u32; 3]]) -> BTreeSet<[[u32; 3]; 3]> {
        let bits = |v: u32| points.at(v).to_array().map(f32::to_bits);
        let turned = triangles.iter().map(|t| {
            let [a, b, c] = t.map(bits);
            [[a, b, c], [b, c, a], [c, a, b]].into_iter().min()
        });
        turned.flatten().collect()
    }

    /// How many cache lines the points around a vertex lie on, on average.
    fn lines(points: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
        let mut around = vec![BTreeSet::new(); points.len()];
        for triangle in triangles {
            for &from in triangle {
                around[from as usize].extend(triangle.map(|to| to as usize * 12 / 64));
            }
        }
        around.iter().map(|lines| lines.len() as f64).sum::<f64>() / points.len() as f64
    }

    #[test]
    fn the_surface_is_the_same_and_lies_denser() {
        let (points, triangles) = sphere(1000);
        let (new_points, new_triangles) = morton_order(&points, &triangles);
        assert_eq!(new_triangles.len(), triangles.len());
        let same = corners(&points, &triangles) == corners(&new_points, &new_triangles);
        assert!(same, "other triangles");
        let [before, after] =
            [(&points, &triangles), (&new_points, &new_triangles)].map(|(p, t)| lines(p, t));
        assert!(after < 0.65 * before, "{before} lines, then {after}");
        let again = morton_order(&new_points, &new_triangles);
        assert_eq!(again, (new_points, new_triangles), "no order of its own");
    }

    #[test]
    fn any_points_have_an_order() {
        for size in [0.0, f32::MIN_POSITIVE, f32::MAX] {
            let points = [Vec3::NEG_X, Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * size);
            let (ordered, triangles) = morton_order(&points, &[[0, 1, 2], [3, 0, 2]]);
            let same = corners(&points, &[[0, 1, 2], [3, 0, 2]]) == corners(&ordered, &triangles);
            assert!(same, "of size {size}");
        }
    }
}
