//! Exact signs: on which side of a plane a point lies (Shewchuk, *Adaptive precision floating-point
//! arithmetic and fast robust geometric predicates*, Discrete Comput. Geom. 18, 1997).

use glam::DVec3;

use crate::tolerance::ORIENTATION_ROUNDING;
use crate::tuning::SEEMS_FLAT;

/// The most terms of a height: of f32 values, 24 products of two terms each; of differences, 6 of four.
const TERMS: usize = 48;

/// The plane of a triangle, which turns counter-clockwise seen from above.
pub(super) struct ExactPlane {
    corners: [DVec3; 3],
    /// Of twice the triangle's length.
    normal: DVec3,
    /// Heights above this one have the right sign.
    certain: f64,
}

impl ExactPlane {
    /// For points no farther from the first corner than `extent`, in each coordinate.
    pub fn new([a, b, c]: [DVec3; 3], extent: DVec3) -> Self {
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let [u, v] = [u, v].map(DVec3::abs);
        let products = DVec3::new(
            u.y * v.z + u.z * v.y,
            u.z * v.x + u.x * v.z,
            u.x * v.y + u.y * v.x,
        );
        Self {
            corners: [a, b, c],
            normal,
            certain: ORIENTATION_ROUNDING * products.dot(extent),
        }
    }

    /// How far a point lies above the plane, times twice the area of the triangle.
    ///
    /// The sign is exact if all coordinates are f32 values. The value is good up to rounding.
    #[inline]
    pub fn height(&self, p: DVec3) -> f64 {
        let height = self.normal.dot(p - self.corners[0]);
        if height.abs() > self.certain {
            return height;
        }
        exact_height(self.corners, p)
    }

    /// Whether a point of a known height seems to be in the plane, seen from the triangle.
    pub fn seems_to_contain(&self, p: DVec3, height: f64) -> bool {
        let away = self.normal.length_squared() * p.distance_squared(self.corners[0]);
        height * height <= SEEMS_FLAT * SEEMS_FLAT * away
    }
}

#[cold]
fn exact_height([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let mut sum = ExactSum::default();
    match [b, c, p].map(|q| exact_difference(q, a)) {
        [Some(u), Some(v), Some(w)] => sum.add_determinant(u, v, w),
        _ => {
            sum.add_determinant(b, c, p);
            sum.add_determinant(-a, c, p);
            sum.add_determinant(a, b, p);
            sum.add_determinant(-a, b, c);
        }
    }
    sum.largest()
}

/// The difference, if f64 holds it: of f32 values it does, unless they differ by many orders of magnitude.
fn exact_difference(p: DVec3, q: DVec3) -> Option<DVec3> {
    let is_exact = |i: usize| two_sum(p[i], -q[i]).1 == 0.0;
    (is_exact(0) && is_exact(1) && is_exact(2)).then(|| p - q)
}

/// A sum as non-overlapping numbers, ordered by magnitude.
struct ExactSum {
    terms: [f64; TERMS],
    len: usize,
}

impl Default for ExactSum {
    fn default() -> Self {
        Self {
            terms: [0.0; TERMS],
            len: 0,
        }
    }
}

impl ExactSum {
    fn add_determinant(&mut self, a: DVec3, b: DVec3, c: DVec3) {
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            self.add_product(a[i], b[j], c[k]);
            self.add_product(-a[i], b[k], c[j]);
        }
    }

    /// Adds a product of three numbers: up to four terms.
    fn add_product(&mut self, a: f64, b: f64, c: f64) {
        let (pair, error) = two_product(a, b);
        for part in [error, pair] {
            if part != 0.0 {
                let (product, error) = two_product(part, c);
                self.add(error);
                self.add(product);
            }
        }
    }

    fn add(&mut self, mut x: f64) {
        if x == 0.0 {
            return;
        }
        let mut kept = 0;
        for i in 0..self.len {
            let (sum, error) = two_sum(x, self.terms[i]);
            x = sum;
            if error != 0.0 {
                self.terms[kept] = error;
                kept += 1;
            }
        }
        if x != 0.0 {
            self.terms[kept] = x;
            kept += 1;
        }
        self.len = kept;
    }

    /// This term has the sign of the sum.
    fn largest(&self) -> f64 {
        self.terms[..self.len].last().copied().unwrap_or(0.0)
    }
}

/// A product and its rounding error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

/// A sum and its rounding error (Knuth, *The Art of Computer Programming* 2, 4.2.2).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_the_last_digit_decides() {
        let place = |x: f32, y: f32, z: f32| DVec3::new(x.into(), y.into(), z.into());
        // In the plane x + y + z = 3 M, where f64 rounds the products.
        let m = 16_777_215.0_f32;
        let plane = [
            place(m, m, m),
            place(m - 1.0, m, m + 1.0),
            place(m, m - 1.0, m + 1.0),
        ];
        let inside = place(m - 3.0, m + 1.0, m + 1.0).y;
        assert_eq!(inside, f64::from(m) + 1.0);
        let extent = DVec3::splat(4.0 * f64::from(m));
        let sign = |p: DVec3| ExactPlane::new(plane, extent).height(p);
        assert_eq!(sign(place(m - 2.0, m + 1.0, m + 1.0)), 0.0);
        let tiny = f32::from_bits(1);
        let above = sign(place(m - 2.0, m + 1.0, m + 1.0) + DVec3::X * f64::from(tiny));
        assert_eq!(above, 0.0, "f64 does not hold that point");
        let flat = [
            place(0.0, 0.0, 0.0),
            place(1.0, 1.0, 3.0),
            place(1.0, 2.0, 5.0),
        ];
        let on = place(m, m, 3.0 * m);
        let over_flat = |p: DVec3| ExactPlane::new(flat, extent).height(p);
        let exact = over_flat(place(3.0, 4.0, 11.0));
        assert_eq!(exact, 0.0);
        assert_eq!(
            over_flat(on).signum(),
            (f64::from(3.0 * m) - 3.0 * f64::from(m)).signum()
        );
        assert!(over_flat(place(0.0, 0.0, tiny)) > 0.0);
        assert!(over_flat(place(0.0, 0.0, -tiny)) < 0.0);
    }

    /// Integers so large on one axis that f64 does not hold their differences, and points in a plane or beside it.
    #[test]
    fn signs_are_those_of_integers() {
        let mut rng = oorandom::Rand64::new(5);
        let mut signs = [0; 3];
        for round in 0..60_000 {
            let mut integer =
                |limit: u64| i128::from(rng.rand_range(0..2 * limit)) - i128::from(limit);
            let mut point = || {
                [
                    integer(1 << 20) << integer(55).abs(),
                    integer(400),
                    integer(400),
                ]
            };
            let [a, b, c] = [(); 3].map(|()| point());
            let along = |p: [i128; 3]| [0, 1, 2].map(|i| p[i] - a[i]);
            let (u, v) = (along(b), along(c));
            let [i, j] = [integer(3), integer(3)];
            let mut p = [0, 1, 2].map(|k| a[k] + i * u[k] + j * v[k]);
            p[round % 3] += integer(3);
            let w = along(p);
            let minor = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
            let exact = minor(1, 2) * w[0] + minor(2, 0) * w[1] + minor(0, 1) * w[2];
            let number = |x: i128| x.to_string().parse::<f32>().map_or(f64::NAN, f64::from);
            if p.iter()
                .any(|&x| format!("{:.0}", number(x)) != x.to_string())
            {
                continue;
            }
            let [a, b, c, p] = [a, b, c, p].map(|p| DVec3::from(p.map(number)));
            let extent = (b - a).abs().max((c - a).abs()).max((p - a).abs());
            let height = ExactPlane::new([a, b, c], extent).height(p);
            let sign = i128::from(height > 0.0) - i128::from(height < 0.0);
            assert_eq!(sign, exact.signum(), "round {round}");
            signs[usize::from(height > 0.0) + 2 * usize::from(height < 0.0)] += 1;
        }
        assert!(signs.iter().all(|&count| count > 1_000), "{signs:?}");
    }
}
