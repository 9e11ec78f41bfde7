//! Contacts of discs with polygons and with each other.

use glam::DVec3;

use super::outline::{chord, circle_crossings};
use super::patch::Patch;
use super::piece::{FlatSide, Outline, Piece, across};
use super::place::{PiecePoint, Spot, by_shape};
use crate::tolerance::{LEVEL, ON_OUTLINE};
use crate::tuning::SMALL_SHIFT;

/// Cosines and sines of eighths of a turn.
const SECTORS: [[f64; 2]; 8] = {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    [
        [1.0, 0.0],
        [half, half],
        [0.0, 1.0],
        [-half, half],
        [-1.0, 0.0],
        [-half, -half],
        [0.0, -1.0],
        [half, -half],
    ]
};

impl Patch {
    /// The direction in the plane of a flat side in which its contacts become deeper. `None` if both sides
    /// are parallel.
    pub(super) fn lean(&self, shape: usize, flat: &FlatSide) -> Option<DVec3> {
        let Piece::Flat(other) = &self.pieces[1 - shape] else {
            return None;
        };
        let steepest = other.normal / other.normal.dot(self.normal());
        let gradient = if shape == 0 { -steepest } else { steepest };
        let in_plane = -gradient.reject_from_normalized(flat.normal);
        (in_plane.length() > LEVEL).then(|| in_plane.normalize())
    }

    /// A disc on a polygon: the corners of a square in the disc, or those of the part over the polygon. The
    /// square is fixed in the frame of the polygon, unless the disc is tilted: then one corner is the deepest
    /// point.
    pub(super) fn add_disc(
        &mut self,
        shape: usize,
        flat: &FlatSide,
        (center, radius): (DVec3, f64),
        with_corners: bool,
    ) {
        let still = across(self.reference(1 - shape), flat.normal);
        let u = self.lean(shape, flat).or(still);
        let u = u.unwrap_or_else(|| flat.normal.any_orthonormal_vector());
        let v = flat.normal.cross(u);
        let rim = |sector: usize| {
            let [cos, sin] = SECTORS[sector];
            center + (u * cos + v * sin) * radius
        };
        let push_sector = |patch: &mut Self, sector: usize, is_over: bool| {
            let point = PiecePoint {
                at: rim(sector),
                spots: by_shape(shape, [Spot::Arc(sector), Spot::Inside]),
            };
            match patch.flat(1 - shape) {
                Some(other) if is_over => {
                    let height = other.height(point.at);
                    patch.push(point, by_shape(shape, [0.0, height]));
                }
                _ => patch.push_over(shape, point),
            }
        };
        let is_over = self.is_whole_over(1 - shape, center, radius);
        let before = self.places.len();
        for sector in [0, 2, 4, 6] {
            push_sector(self, sector, is_over);
        }
        let between = [1, 3, 5, 7];
        let is_on = |sector: usize| self.height_over(1 - shape, rim(sector)).is_some();
        let is_whole = is_over || self.places.len() == before + 4 && between.into_iter().all(is_on);
        if is_whole || !with_corners {
            return;
        }
        for sector in between {
            push_sector(self, sector, false);
        }
        self.add_polygon_over_disc(1 - shape, center, radius);
    }

    /// Whether a whole disc is over a flat side. The tilts of both sides bound how much its radius grows,
    /// seen along the normal.
    pub(super) fn is_whole_over(&self, shape: usize, center: DVec3, radius: f64) -> bool {
        self.flat(shape).is_some_and(|flat| {
            let lean = flat.side.normal.dot(self.normal()).abs();
            let inset = flat.inset(center).unwrap_or(0.0);
            inset * lean * lean * (1.0 - ON_OUTLINE) > radius * (1.0 + ON_OUTLINE)
        })
    }

    /// The corners of a polygon over a disc, and the points where its edges cross the circle.
    fn add_polygon_over_disc(&mut self, shape: usize, center: DVec3, radius: f64) {
        let count = self.corners[shape].len();
        for i in 0..count {
            let (from, id) = self.corners[shape][i];
            let (to, _) = self.corners[shape][(i + 1) % count];
            let spots = by_shape(shape, [Spot::Corner(id), Spot::Inside]);
            self.push_over(shape, PiecePoint { at: from, spots });
            let Some(disc) = self.flat(1 - shape) else {
                return;
            };
            let [a, b] = [from, to].map(|p| disc.project(p));
            let Some(shares) = circle_crossings(a - center, b - a, radius) else {
                continue;
            };
            for (number, share) in shares.into_iter().enumerate() {
                if (0.0..=1.0).contains(&share) {
                    let spots = by_shape(shape, [Spot::Side(id), Spot::Crossing(number)]);
                    let at = from.lerp(to, share);
                    self.push_over(shape, PiecePoint { at, spots });
                }
            }
        }
    }

    /// Two discs: a square in the smaller one if it is within the other, or the ends of the lens in which
    /// they overlap.
    pub(super) fn add_two_discs(&mut self, flats: [&FlatSide; 2], circles: [(DVec3, f64); 2]) {
        let [(c1, r1), (c2, r2)] = circles;
        let smaller = usize::from(r2 < r1);
        let least = r1.min(r2);
        let (m1, offset) = (flats[0].normal, c2 - c1);
        let across = offset - self.normal() * (m1.dot(offset) / m1.dot(self.normal()));
        let distance = across.length();
        if distance + least <= r1.max(r2) {
            self.add_disc(smaller, flats[smaller], circles[smaller], false);
            return;
        }
        // The circle within the lens.
        let inner = 0.5 * (r1 + r2 - distance);
        if inner >= (1.0 - SMALL_SHIFT) * least {
            let toward = across / distance;
            let middle = c1 + toward * (r1 - inner);
            self.add_disc(0, flats[0], (middle, inner), false);
        } else if inner > 0.0 {
            self.add_lens(flats, circles, across / distance, distance);
        }
        // If the discs are tilted, the deepest point may be on either rim.
        for shape in 0..2 {
            if let Some(down) = self.lean(shape, flats[shape]) {
                let (center, radius) = circles[shape];
                let at = center + down * radius;
                let spots = by_shape(shape, [Spot::Arc(0), Spot::Inside]);
                self.push_over(shape, PiecePoint { at, spots });
            }
        }
    }

    /// The two points where the circles cross, and the middles of the arcs between them.
    fn add_lens(
        &mut self,
        flats: [&FlatSide; 2],
        [(c1, r1), (c2, r2)]: [(DVec3, f64); 2],
        way: DVec3,
        distance: f64,
    ) {
        let [u1, u2] =
            flats.map(|flat| way.reject_from_normalized(flat.normal).normalize_or_zero());
        let [along, squared] = chord([r1, r2], distance);
        let half_chord = squared.max(0.0).sqrt();
        let beside = flats[0].normal.cross(u1);
        // Slightly inside, so that rounding does not put them outside of either disc.
        let hair = 1.0 - ON_OUTLINE;
        for (number, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let at = c1 + (u1 * along + beside * (sign * half_chord)) * hair;
            let spots = [Spot::Crossing(number); 2];
            self.push_near_rim(at, spots);
        }
        self.push_over(
            0,
            PiecePoint {
                at: c1 + u1 * r1,
                spots: [Spot::Arc(0), Spot::Inside],
            },
        );
        self.push_over(
            1,
            PiecePoint {
                at: c2 - u2 * r2,
                spots: [Spot::Inside, Spot::Arc(0)],
            },
        );
    }

    /// A place where two circles cross, in the plane of the first one. Seen along a tilted normal, the second
    /// circle is slightly narrower.
    fn push_near_rim(&mut self, at: DVec3, spots: [Spot; 2]) {
        let Some(second) = self.flat(1) else { return };
        let Outline::Disc { center, radius } = second.side.outline else {
            return;
        };
        let over = second.project(at) - center;
        let excess = over.length() / radius;
        let (at, shape) = if excess > 1.0 {
            (center + over / excess, 1)
        } else {
            (at, 0)
        };
        self.push_over(shape, PiecePoint { at, spots });
    }
}
