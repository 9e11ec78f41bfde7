//! Where outlines of flat sides cross each other, or a line.

use glam::DVec3;

use super::outline::{chord, circle_crossings};
use super::patch::Patch;
use super::piece::{Generator, Piece};
use super::place::by_shape;
use crate::query::Disc;

/// Where two outlines cross, seen along the contact normal.
pub(super) struct OutlineCrossing {
    /// On both surfaces.
    pub points: [DVec3; 2],
    /// The unit normal that is perpendicular to both outlines, from shape 1 to shape 2.
    pub normal: DVec3,
    /// The middle of a line, as far as it is over a flat side.
    pub middle: Option<DVec3>,
}

/// The deepest of the crossings so far.
struct DeepestCrossing {
    normal: DVec3,
    gap: f64,
    points: [DVec3; 2],
    /// Along both outlines.
    tangents: [DVec3; 2],
    middle: Option<DVec3>,
}

impl DeepestCrossing {
    fn consider(&mut self, points: [DVec3; 2], tangents: [DVec3; 2]) {
        let gap = self.normal.dot(points[1] - points[0]);
        if gap < self.gap {
            *self = Self {
                gap,
                points,
                tangents,
                ..*self
            };
        }
    }

    fn found(&self) -> Option<OutlineCrossing> {
        let [a, b] = self.tangents;
        let normal = a.cross(b).try_normalize()?;
        let turned = normal.dot(self.normal);
        Some(OutlineCrossing {
            points: self.points,
            normal: normal * turned.signum(),
            middle: self.middle,
        })
    }
}

impl Patch {
    /// The deepest place where the outlines of both pieces cross.
    pub(super) fn deepest_crossing(&self) -> Option<OutlineCrossing> {
        let mut deepest = DeepestCrossing {
            normal: self.normal(),
            gap: f64::INFINITY,
            points: [DVec3::ZERO; 2],
            tangents: [DVec3::ZERO; 2],
            middle: None,
        };
        match &self.pieces {
            [Piece::Flat(_), Piece::Line(line)] => self.cross_line(1, line, &mut deepest),
            [Piece::Line(line), Piece::Flat(_)] => self.cross_line(0, line, &mut deepest),
            [Piece::Flat(a), Piece::Flat(b)] => match [a, b].map(|flat| flat.outline.circle()) {
                [Some(first), Some(second)] => {
                    self.cross_circles([first, second], &mut deepest);
                }
                [Some(circle), None] => self.cross_polygon(0, circle, &mut deepest),
                [None, Some(circle)] => self.cross_polygon(1, circle, &mut deepest),
                [None, None] => {}
            },
            _ => {}
        }
        deepest.found()
    }

    /// The circle of one shape and the polygon of the other.
    fn cross_polygon(
        &self,
        shape: usize,
        (center, radius): (DVec3, f64),
        deepest: &mut DeepestCrossing,
    ) {
        let Some(disc) = self.flat(shape) else { return };
        let corners = &self.corners[1 - shape];
        let Some(&(mut from, _)) = corners.last() else {
            return;
        };
        for &(to, _) in corners {
            let [a, b] = [from, to].map(|p| disc.project(p));
            let shares = circle_crossings(a - center, b - a, radius);
            for share in shares.into_iter().flatten() {
                if (0.0..=1.0).contains(&share) {
                    let on_rim = a.lerp(b, share);
                    let rim = disc.side.normal.cross(on_rim - center);
                    let points = by_shape(shape, [on_rim, from.lerp(to, share)]);
                    deepest.consider(points, [rim, to - from]);
                }
            }
            from = to;
        }
    }

    fn cross_circles(
        &self,
        [(c1, r1), (c2, r2)]: [(DVec3, f64); 2],
        deepest: &mut DeepestCrossing,
    ) {
        let [Some(first), Some(second)] = [self.flat(0), self.flat(1)] else {
            return;
        };
        let offset = first.project(c2) - c1;
        let distance = offset.length();
        let [along, squared] = chord([r1, r2], distance);
        let half_chord = squared.sqrt();
        // It is NaN for circles that do not cross, as concentric ones.
        if half_chord.is_nan() || half_chord == 0.0 {
            return;
        }
        let way = offset / distance;
        let beside = first.side.normal.cross(way) * half_chord;
        for sign in [-1.0, 1.0] {
            let on_1 = c1 + way * along + beside * sign;
            let on_2 = second.project(on_1);
            let rims = [
                first.side.normal.cross(on_1 - c1),
                second.side.normal.cross(on_2 - c2),
            ];
            deepest.consider([on_1, on_2], rims);
        }
    }

    /// A line of one shape and the outline of the other.
    fn cross_line(&self, shape: usize, line: &Generator, deepest: &mut DeepestCrossing) {
        let Some(flat) = self.flat(1 - shape) else {
            return;
        };
        let [a, b] = line.ends;
        let Some(shares) = flat.clip([a, b]) else {
            return;
        };
        deepest.middle = Some(a.lerp(b, 0.5 * (shares[0] + shares[1])));
        for share in shares {
            if share > 0.0 && share < 1.0 {
                let on_line = a.lerp(b, share);
                let on_flat = flat.project(on_line);
                let outline = flat.direction_at(on_flat);
                deepest.consider(by_shape(shape, [on_line, on_flat]), [b - a, outline]);
            }
        }
    }

    /// Differences of points of both pieces around a place that is over both of them.
    pub(super) fn disc_around(&self, p: DVec3) -> Option<Disc> {
        let normal = self.normal();
        let mut heights = [0.0; 2];
        let (mut radius, mut lift) = (0.0, 0.0);
        for (shape, height) in heights.iter_mut().enumerate() {
            *height = self.height_over(shape, p)?;
            if let Some(flat) = self.flat(shape) {
                let inset = flat.inset(p)?;
                radius += inset * flat.side.normal.dot(normal).abs();
                lift += inset * flat.side.normal.cross(normal).length();
            }
        }
        Some(Disc {
            radius,
            highest: heights[1] - heights[0] + lift,
        })
    }
}
