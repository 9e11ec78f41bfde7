//! Cells of directions: spherical triangles with an extreme point for each corner.

use glam::DVec3;

/// A unit direction, and a point of the difference that is farthest along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extreme {
    pub direction: DVec3,
    pub point: DVec3,
}

impl Extreme {
    /// How far the difference reaches along the direction.
    pub fn reach(&self) -> f64 {
        self.direction.dot(self.point)
    }
}

/// The directions between three others.
pub(super) struct Cell(pub [Extreme; 3]);

impl Cell {
    /// A lower bound of the reach along all directions of the cell.
    ///
    /// A mean `p` of the three points is a point of the difference, so that the reach along n is at least n·p.
    /// Since n is a combination of the corners with positive weights, n·p is at least the smallest c·p of the
    /// corners c; where that is negative, divided by the least length of a mean of the corners.
    pub fn least_reach(&self) -> f64 {
        let products = self
            .0
            .map(|corner| self.0.map(|other| other.direction.dot(corner.point)));
        let best = best_mean(products);
        if best >= 0.0 {
            best
        } else {
            best / self.flatness()
        }
    }

    /// The distance of the origin from the plane of the corners.
    fn flatness(&self) -> f64 {
        let [a, b, c] = self.0.map(|corner| corner.direction);
        (b - a).cross(c - a).normalize().dot(a)
    }

    /// Directions in which the difference may reach least, near its three points' nearest to the origin.
    pub fn guesses(&self) -> impl Iterator<Item = DVec3> {
        let [a, b, c] = self.0.map(|corner| corner.point);
        let middle: DVec3 = self.0.iter().map(|corner| corner.direction).sum();
        let nearest = nearest_of_triangle([a, b, c]);
        let normal = (b - a).cross(c - a);
        let facing = move |v: DVec3| (v * v.dot(middle)).try_normalize();
        [nearest, normal].into_iter().filter_map(facing)
    }

    /// A point of the difference near the origin.
    pub fn nearest_point(&self) -> DVec3 {
        nearest_of_triangle(self.0.map(|corner| corner.point))
    }
}

/// The largest value that the least of three rows can have for a mean of three columns.
fn best_mean(columns: [[f64; 3]; 3]) -> f64 {
    let pairs = [[0, 1], [1, 2], [2, 0]].map(|pair| best_of_pair(pair.map(|i| columns[i])));
    let best = pairs.into_iter().fold(f64::NEG_INFINITY, f64::max);
    best.max(level_mean(columns).unwrap_or(best))
}

/// The same for a mean of two columns: the best share is 0, 1, or one at which two rows are equal.
fn best_of_pair([from, to]: [[f64; 3]; 2]) -> f64 {
    let value = |share: f64| {
        let row = |i: usize| from[i] + share * (to[i] - from[i]);
        row(0).min(row(1)).min(row(2))
    };
    let crossing = |[i, j]: [usize; 2]| {
        let (at_start, at_end) = (from[i] - from[j], to[i] - to[j]);
        at_start / (at_start - at_end)
    };
    let crossings = [[0, 1], [1, 2], [2, 0]].map(crossing);
    let inside = crossings
        .into_iter()
        .filter(|share| *share > 0.0 && *share < 1.0);
    inside
        .chain([0.0, 1.0])
        .map(value)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// The value of that mean of three columns for which all rows are equal.
fn level_mean(columns: [[f64; 3]; 3]) -> Option<f64> {
    let [a, b, c] = columns.map(DVec3::from);
    // Both differences of rows vanish for these weights.
    let first = DVec3::new(a.x - a.y, b.x - b.y, c.x - c.y);
    let second = DVec3::new(a.y - a.z, b.y - b.z, c.y - c.z);
    let weights = first.cross(second);
    let sum = weights.element_sum();
    let share = weights / sum;
    (sum != 0.0 && share.min_element() >= 0.0).then(|| {
        let mean = a * share.x + b * share.y + c * share.z;
        mean.min_element()
    })
}

/// The point of a triangle that is nearest to the origin.
fn nearest_of_triangle([a, b, c]: [DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let is_left = |p: DVec3, q: DVec3| normal.dot(p.cross(q)) >= 0.0;
    if normal != DVec3::ZERO && is_left(a, b) && is_left(b, c) && is_left(c, a) {
        return normal * (normal.dot(a) / normal.length_squared());
    }
    let foot = |p: DVec3, q: DVec3| {
        let way = q - p;
        let share = -p.dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
        p + way * share.clamp(0.0, 1.0)
    };
    let shorter = |p: DVec3, q: DVec3| {
        if p.length_squared() <= q.length_squared() {
            p
        } else {
            q
        }
    };
    shorter(shorter(foot(a, b), foot(b, c)), foot(c, a))
}
