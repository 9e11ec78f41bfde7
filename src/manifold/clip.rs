//! Intersection of two convex polygons in the plane, keeping track of what each corner is made of.
//!
//! Each side of the window is a line that the other polygon crosses twice or not at all (Cyrus,
//! Beck, *Generalized two- and three-dimensional clipping*, Computers & Graphics 3(1), 1978). So
//! one pass over the heights of its corners above these lines tells which of them are inside,
//! where sides cross, and which corners of the window are between two crossings. The corners come
//! in no order, and where the polygons' corners meet there may be two for one.

use glam::DVec2;

/// Where a corner of the intersection comes from. Indices are into the polygons as given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tag {
    /// A corner of the clipped polygon.
    Corner(u16),
    /// A corner of the window.
    Window(u16),
    /// A side of the window crossing a side of the clipped polygon.
    Crossing(u16, u16),
}

/// A corner of the intersection: its place in the contact plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipVertex {
    pub at: DVec2,
    /// From the first face to the second, along the contact normal.
    pub distance: f64,
    pub tag: Tag,
}

impl ClipVertex {
    pub fn new(at: DVec2, tag: Tag) -> Self {
        Self {
            at,
            distance: 0.0,
            tag,
        }
    }
}

/// The two polygons, and memory for clipping one by the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Polygons {
    /// Counter-clockwise.
    pub window: Vec<DVec2>,
    /// Clockwise, as a second shape's face is seen; perhaps only the two ends of a line.
    pub subject: Vec<DVec2>,
    /// The corners of the intersection.
    pub corners: Vec<ClipVertex>,
    inside: Vec<bool>,
}

/// Leaves the intersection of window and subject in the corners. What lies outside by less than
/// `slack` counts as inside, so that corners that meet up to rounding are never lost.
pub(super) fn intersect(polygons: &mut Polygons, slack: f64) {
    let Polygons {
        window,
        subject,
        corners,
        inside,
    } = polygons;
    corners.clear();
    inside.clear();
    inside.extend(subject.iter().map(|_| true));
    let ends = window.iter().cycle().skip(1);
    for (i, (&from, &to)) in window.iter().zip(ends).enumerate() {
        let side = Side::new(from, to, slack);
        side.cut(i as u16, subject, inside, corners);
    }
    for (j, (&at, &inside)) in subject.iter().zip(&*inside).enumerate() {
        if inside {
            corners.push(ClipVertex::new(at, Tag::Corner(j as u16)));
        }
    }
}

/// A side of the window.
struct Side {
    from: DVec2,
    along: DVec2,
    length_squared: f64,
    /// What still counts as inside: in heights, and along the side.
    slack: f64,
}

impl Side {
    fn new(from: DVec2, to: DVec2, slack: f64) -> Self {
        let along = to - from;
        // Heights are multiplied by the length; the sum of coordinates is not shorter.
        let length = along.x.abs() + along.y.abs();
        Self {
            from,
            along,
            length_squared: along.length_squared(),
            slack: slack * length,
        }
    }

    /// The place of a point along the side, from 0 to the length squared, and its height over it,
    /// positive inside.
    fn place(&self, p: DVec2) -> DVec2 {
        let from = p - self.from;
        DVec2::new(self.along.dot(from), self.along.perp_dot(from))
    }

    /// Strikes the subject's corners below this side from `inside`, and adds what the `i`-th
    /// side has of the intersection's corners.
    fn cut(&self, i: u16, subject: &[DVec2], inside: &mut [bool], corners: &mut Vec<ClipVertex>) {
        // Whether the line enters or leaves the subject before the side's start, and after it.
        let (mut before, mut after) = (false, false);
        // A line of two corners has no side back.
        let mut j = if subject.len() == 2 {
            0
        } else {
            subject.len() - 1
        };
        let mut last = self.place(subject[j]);
        for (next, (&corner, inside)) in subject.iter().zip(inside).enumerate() {
            let place = self.place(corner);
            *inside &= place.y >= -self.slack;
            if (place.y < 0.0) != (last.y < 0.0) {
                // Where the line is crossed, as a fraction: no division for what is not needed.
                let fall = last.y - place.y;
                let (share, whole) = (
                    (last.y * place.x - place.y * last.x) * fall.signum(),
                    fall.abs(),
                );
                before |= share <= 0.0;
                after |= share >= 0.0;
                if share >= -self.slack * whole
                    && share <= (self.length_squared + self.slack) * whole
                {
                    let at = subject[j].lerp(corner, last.y / fall);
                    corners.push(ClipVertex::new(at, Tag::Crossing(i, j as u16)));
                }
            }
            (last, j) = (place, next);
        }
        if before && after {
            corners.push(ClipVertex::new(self.from, Tag::Window(i)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLACK: f64 = 1e-9;
    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    /// Both polygons counter-clockwise.
    fn clip(window: &[DVec2], polygon: &[DVec2]) -> Vec<ClipVertex> {
        let mut polygons = Polygons {
            window: window.to_vec(),
            subject: polygon.iter().rev().copied().collect(),
            ..Default::default()
        };
        intersect(&mut polygons, SLACK);
        polygons.corners
    }

    fn clip_square(polygon: [[f64; 2]; 4]) -> Vec<(DVec2, Tag)> {
        let corners = clip(&SQUARE.map(DVec2::from), &polygon.map(DVec2::from));
        let mut corners: Vec<_> = corners.iter().map(|v| (v.at, v.tag)).collect();
        corners.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.0.y.total_cmp(&b.0.y)));
        corners
    }

    #[test]
    fn shifted_squares_meet_in_a_corner_of_each_and_two_crossings() {
        assert_eq!(
            clip_square(SQUARE.map(|[x, y]| [x + 0.5, y + 0.5])),
            [
                (DVec2::new(0.5, 0.5), Tag::Corner(3)),
                (DVec2::new(0.5, 1.0), Tag::Crossing(2, 3)),
                (DVec2::new(1.0, 0.5), Tag::Crossing(1, 2)),
                (DVec2::new(1.0, 1.0), Tag::Window(2)),
            ]
        );
    }

    #[test]
    fn a_window_inside_of_the_polygon_is_the_intersection() {
        let corners = clip_square(SQUARE.map(|[x, y]| [4.0 * x - 2.0, 4.0 * y - 2.0]));
        let tags: Vec<Tag> = corners.iter().map(|corner| corner.1).collect();
        assert_eq!(tags, [0, 3, 1, 2].map(Tag::Window));
    }

    #[test]
    fn disjoint_polygons_do_not_meet() {
        assert!(clip_square(SQUARE.map(|[x, y]| [x + 3.0, y])).is_empty());
    }

    #[test]
    fn a_line_keeps_its_inner_part() {
        let clip_line = |line: [[f64; 2]; 2]| {
            let mut polygons = Polygons {
                window: SQUARE.map(DVec2::from).into(),
                subject: line.map(DVec2::from).into(),
                ..Default::default()
            };
            intersect(&mut polygons, SLACK);
            let corners = polygons.corners.iter();
            corners
                .map(|v| (v.at.to_array(), v.tag))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            clip_line([[-0.5, 0.5], [0.5, 0.5]]),
            [
                ([0.0, 0.5], Tag::Crossing(3, 0)),
                ([0.5, 0.5], Tag::Corner(1))
            ]
        );
        assert_eq!(
            clip_line([[0.25, 2.0], [0.25, -2.0]]),
            [
                ([0.25, 0.0], Tag::Crossing(0, 0)),
                ([0.25, 1.0], Tag::Crossing(2, 0))
            ]
        );
        assert!(clip_line([[-1.0, 2.0], [2.0, 2.0]]).is_empty());
        assert!(clip_line([[-1.0, 0.5], [0.5, 2.0]]).is_empty());
    }

    fn ellipse(count: usize, dice: &mut oorandom::Rand64) -> Vec<DVec2> {
        let [x, y, a, b, turn] = [(); 5].map(|()| dice.rand_float());
        (0..count)
            .map(|i| {
                let angle = std::f64::consts::TAU * (i as f64 / count as f64 + turn);
                let (sin, cos) = angle.sin_cos();
                DVec2::new(x + (0.2 + a) * cos, y + (0.2 + b) * sin)
            })
            .collect()
    }

    fn is_inside(p: DVec2, polygon: &[DVec2], slack: f64) -> bool {
        let ends = polygon.iter().cycle().skip(1);
        let mut sides = polygon.iter().zip(ends);
        sides.all(|(&a, &b)| (b - a).perp_dot(p - a) >= -slack * (b - a).length())
    }

    /// All corners that the intersection can have, by trying every pair of sides.
    fn candidates(a: &[DVec2], b: &[DVec2]) -> Vec<DVec2> {
        let side = |p: &[DVec2], i: usize| (p[i], p[(i + 1) % p.len()]);
        let mut found: Vec<DVec2> = a.iter().chain(b).copied().collect();
        for i in 0..a.len() {
            for j in 0..b.len() {
                let ((p, p2), (q, q2)) = (side(a, i), side(b, j));
                let (d, e) = (p2 - p, q2 - q);
                if d.perp_dot(e).abs() > 1e-12 {
                    found.push(p + d * ((q - p).perp_dot(e) / d.perp_dot(e)));
                }
            }
        }
        found.retain(|&p| is_inside(p, a, 1e-12) && is_inside(p, b, 1e-12));
        found
    }

    /// Against brute force; also for equal polygons, and those that are turned or shifted by a
    /// rounding.
    #[test]
    fn the_corners_are_those_of_the_intersection() {
        let mut dice = oorandom::Rand64::new(2);
        for round in 0..2000 {
            let counts = [(); 2].map(|()| dice.rand_range(3..12) as usize);
            let window = ellipse(counts[0], &mut dice);
            let tiny = DVec2::splat(1e-16 * (round % 7) as f64);
            let polygon = match round % 4 {
                0 => window.iter().map(|&p| p + tiny).collect(),
                1 => window
                    .iter()
                    .map(|p| p.rotate(DVec2::from_angle(tiny.x)))
                    .collect(),
                _ => ellipse(counts[1], &mut dice),
            };
            let corners = clip(&window, &polygon);
            for corner in &corners {
                assert!(is_inside(corner.at, &window, 2.0 * SLACK));
                assert!(is_inside(corner.at, &polygon, 2.0 * SLACK));
            }
            for p in candidates(&window, &polygon) {
                let near = |v: &ClipVertex| v.at.distance(p) < 1e-6;
                assert!(corners.iter().any(near), "round {round}: {p} is missing");
            }
        }
    }
}
