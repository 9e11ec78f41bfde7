//! Contacts of lines of ruled surfaces with flat sides and with each other.

use glam::DVec3;

use super::patch::Patch;
use super::piece::Generator;
use super::place::{PiecePoint, Spot, by_shape};
use crate::primitive::{common_stretch, middle_direction, stretch_beside};
use crate::tolerance::ON_OUTLINE;
use crate::tuning::SHORT_LINE;

impl Patch {
    /// The ends of the part of a line that is over a flat side.
    pub(super) fn add_line(&mut self, shape: usize, line: &Generator) {
        let Some(flat) = self.flat(1 - shape) else {
            return;
        };
        let Some(shares) = flat.clip(line.ends) else {
            return;
        };
        let [a, b] = line.ends;
        for (number, share) in shares.into_iter().enumerate() {
            let at = a.lerp(b, share);
            let height = self
                .flat(1 - shape)
                .map_or(f64::NAN, |flat| flat.height(at));
            let spots = by_shape(shape, [Spot::End(number), Spot::Inside]);
            self.push(PiecePoint { at, spots }, by_shape(shape, [0.0, height]));
        }
    }

    /// Where two lines cross, seen along the normal.
    pub(super) fn add_crossing(&mut self, lines: [&Generator; 2]) {
        let [u, v] = lines.map(|line| line.ends[1] - line.ends[0]);
        let beside = self.normal().cross(u);
        let (length_squared, slope) = (beside.length_squared(), beside.dot(v));
        if slope * slope <= ON_OUTLINE * ON_OUTLINE * length_squared * v.length_squared() {
            return;
        }
        // Solve for the crossing, as a fraction of either line.
        let offset = lines[1].ends[0] - lines[0].ends[0];
        let t = -beside.dot(offset) / slope;
        let along = beside.cross(self.normal());
        let s = along.dot(offset + v * t) / length_squared;
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            let spots = [Spot::Inside; 2];
            let [at, other] = [lines[0].ends[0] + u * s, lines[1].ends[0] + v * t];
            let height = self.normal().dot(other - at);
            self.push(PiecePoint { at, spots }, [0.0, height]);
        }
    }

    /// Beside where two lines cross: a place on either side, at most as far as their common part reaches.
    pub(super) fn add_beside_crossing(&mut self, lines: [&Generator; 2]) {
        let directions = lines.map(|line| line.ends[1] - line.ends[0]);
        if let Some(along) = middle_direction(directions, self.normal()) {
            self.add_common_line(lines, along);
        }
    }

    fn add_common_line(&mut self, lines: [&Generator; 2], along: DVec3) {
        let axes = [along, self.normal().cross(along)];
        let Some([low, high]) = near_stretch(lines, axes) else {
            return;
        };
        let rounding = ON_OUTLINE * self.size();
        for (number, towards) in [low - high, high - low].into_iter().enumerate() {
            let mut at = [low, high][number];
            // If the normal is tilted, the surface point over a place is farther along the line than the place.
            for _ in 0..3 {
                let Some(found) = self.across_lines(lines, axes, at) else {
                    break;
                };
                let beyond = |towards| self.beyond_ends(lines, &found, along, towards);
                let over = beyond(towards);
                if over > rounding {
                    at -= 1.01 * over * towards.signum();
                    continue;
                }
                // Of lines that cross beyond their ends, one may begin farther on.
                if beyond(-towards) <= rounding {
                    let spots = [Spot::End(number), Spot::End(number)];
                    self.push(PiecePoint { at: found.0, spots }, found.1);
                }
                break;
            }
        }
    }

    /// A place between two lines at a coordinate along them, and the heights of both surfaces above it along
    /// the normal.
    fn across_lines(
        &self,
        lines: [&Generator; 2],
        [along, beside]: [DVec3; 2],
        at: f64,
    ) -> Option<(DVec3, [f64; 2])> {
        let [p1, p2] = at_coordinate(lines, along, at);
        let [radius, other] = radii(lines, [p1, p2]);
        let total = radius + other;
        let share = if total > 0.0 { radius / total } else { 0.5 };
        // The surfaces are nearest where the way between the axes is divided in proportion to the radii.
        let place = p1 + beside * (beside.dot(p2 - p1) * share);
        let out = lines[0].exit(place, self.normal())?;
        let back = lines[1].exit(place, -self.normal())?;
        Some((place, [out, -back]))
    }

    /// How far the points of a place are beyond the ends of their lines, on the side `towards`.
    fn beyond_ends(
        &self,
        lines: [&Generator; 2],
        (place, heights): &(DVec3, [f64; 2]),
        along: DVec3,
        towards: f64,
    ) -> f64 {
        let beyond = [0, 1].map(|shape| {
            let at = *place + self.normal() * heights[shape];
            let Generator {
                ends: [a, b],
                surface,
                ..
            } = lines[shape];
            let farther = if along.dot(*b - *a) * towards > 0.0 {
                b
            } else {
                a
            };
            let outward = surface.axis * surface.axis.dot(along).signum() * towards.signum();
            outward.dot(at - *farther)
        });
        beyond[0].max(beyond[1])
    }
}

/// From where to where two lines are near each other, along the first axis. The second one is square to it.
fn near_stretch(lines: [&Generator; 2], [along, beside]: [DVec3; 2]) -> Option<[f64; 2]> {
    let ends = lines.map(|line| line.ends.map(|end| end.dot(along)));
    let [low, high] = common_stretch(ends);
    let [length_1, length_2] = ends.map(|[a, b]| (b - a).abs());
    if high - low < SHORT_LINE * length_1.min(length_2) {
        return None;
    }
    let beside_first = |at| {
        let [p1, p2] = at_coordinate(lines, along, at);
        beside.dot(p2 - p1)
    };
    let total_radius = |at| {
        let [radius_1, radius_2] = radii(lines, at_coordinate(lines, along, at));
        radius_1 + radius_2
    };
    Some(stretch_beside([low, high], beside_first, total_radius))
}

/// The points of lines at a coordinate along them.
fn at_coordinate(lines: [&Generator; 2], along: DVec3, at: f64) -> [DVec3; 2] {
    lines.map(|line| {
        let [a, b] = line.ends.map(|end| end.dot(along));
        line.ends[0].lerp(line.ends[1], (at - a) / (b - a))
    })
}

/// The radii of the surfaces at points of their lines.
fn radii([first, second]: [&Generator; 2], [p1, p2]: [DVec3; 2]) -> [f64; 2] {
    [
        first.surface.radius_at(p1).max(0.0),
        second.surface.radius_at(p2).max(0.0),
    ]
}
