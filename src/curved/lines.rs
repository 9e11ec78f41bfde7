//! Contacts of lines of ruled surfaces with flat sides and with each other.

use glam::DVec3;

use super::patch::Patch;
use super::piece::Generator;
use super::place::{PiecePoint, Spot, by_shape};
use crate::tolerance::ON_OUTLINE;
use crate::tuning::{SHORT_LINE, SIDE_BY_SIDE_SINE};

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

    /// Two lines: both ends of their common part if they lie side by side, and where they cross.
    pub(super) fn add_two_lines(&mut self, lines: [&Generator; 2]) {
        let flatten = |v: DVec3| v - self.normal() * v.dot(self.normal());
        let [u, v] = lines.map(|line| flatten(line.ends[1] - line.ends[0]));
        let (Some(along), Some(other)) = (u.try_normalize(), v.try_normalize()) else {
            return;
        };
        let beside = self.normal().cross(along);
        let sine = beside.dot(other);
        let offset = lines[1].ends[0] - lines[0].ends[0];
        if sine.abs() > ON_OUTLINE {
            // Solve for the crossing, as a fraction of either line.
            let t = -beside.dot(offset) / beside.dot(v);
            let s = along.dot(offset + v * t) / u.length();
            if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
                let spots = [Spot::Inside; 2];
                let at = lines[0].ends[0].lerp(lines[0].ends[1], s);
                let height = self
                    .normal()
                    .dot(lines[1].ends[0].lerp(lines[1].ends[1], t) - at);
                self.push(PiecePoint { at, spots }, [0.0, height]);
            }
        }
        if sine.abs() <= SIDE_BY_SIDE_SINE {
            self.add_common_line(lines, along, beside);
        }
    }

    fn add_common_line(&mut self, lines: [&Generator; 2], along: DVec3, beside: DVec3) {
        let reach = lines.map(|line| {
            let [a, b] = line.ends.map(|end| end.dot(along));
            [a.min(b), a.max(b)]
        });
        let (low, high) = (reach[0][0].max(reach[1][0]), reach[0][1].min(reach[1][1]));
        let [length_1, length_2] = reach.map(|[low, high]| high - low);
        let shorter = length_1.min(length_2);
        if high - low < SHORT_LINE * shorter {
            return;
        }
        let middle = 0.5 * (low + high);
        for (number, end) in [low, high].into_iter().enumerate() {
            // If the normal is tilted, the surface point over a place is farther along the line than the place.
            let mut at = end;
            for _ in 0..3 {
                let Some(found) = self.across_lines(lines, [along, beside], at) else {
                    break;
                };
                let over = self.beyond_ends(lines, &found, along, end - middle);
                if over <= ON_OUTLINE * self.size() {
                    let spots = [Spot::End(number), Spot::End(number)];
                    self.push(PiecePoint { at: found.0, spots }, found.1);
                    break;
                }
                at -= 1.01 * over * (end - middle).signum();
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
        let [p1, p2] = lines.map(|line| {
            let [a, b] = line.ends.map(|end| end.dot(along));
            line.ends[0].lerp(line.ends[1], (at - a) / (b - a))
        });
        let local = [
            lines[0].surface.radius_at(p1).max(0.0),
            lines[1].surface.radius_at(p2).max(0.0),
        ];
        let total = local[0] + local[1];
        let share = if total > 0.0 { local[0] / total } else { 0.5 };
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
