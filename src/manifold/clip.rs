//! Intersection of two convex polygons in the plane, keeping track of what each corner is made of.
//!
//! Each side of the window is a line that the other polygon crosses twice or not at all (Cyrus,
//! Beck, *Generalized two- and three-dimensional clipping*, Computers & Graphics 3(1), 1978). So
//! one pass over the heights of its corners above these lines tells which of them are inside,
//! where sides cross, and which corners of the window are between two crossings. The corners come
//! in no order, and where the polygons' corners meet there may be two for one.

use std::array;

use glam::DVec2;
use wide::f64x4;

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
    #[inline]
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
    /// Room for the corners of the intersection.
    pub corners: Vec<ClipVertex>,
    /// The subject in fours, the last one filled up with its last corner.
    rows: Vec<Row>,
}

/// Corners are looked at in fours: so many are computed at once, and most faces have no more.
const LANES: usize = 4;
const ALL: u32 = (1 << LANES) - 1;

/// Some corners of the subject.
#[derive(Clone, Copy, Debug)]
struct Row {
    x: f64x4,
    y: f64x4,
    /// A bit for each that is inside of all sides so far.
    inside: u32,
    /// A bit for each that is below the present side.
    below: u32,
}

/// The corners of the intersection of window and subject. What lies outside by less than `slack`
/// counts as inside, so that corners that meet up to rounding are never lost.
///
/// What is inside and what crosses is not predictable, and a branch that goes wrong costs more
/// than all that a side computes. So corners are written where they would belong, and counted if
/// they do.
pub(super) fn intersect(polygons: &mut Polygons, slack: f64) -> &mut [ClipVertex] {
    polygons.make_room();
    let Polygons {
        window,
        subject,
        corners,
        rows,
    } = polygons;
    let mut found = Appender {
        room: corners,
        len: 0,
    };
    for (i, &from) in window.iter().enumerate() {
        let to = window[if i + 1 < window.len() { i + 1 } else { 0 }];
        Side::new(i as u16, from, to, slack).cut(subject, rows, &mut found);
    }
    for (j, &at) in subject.iter().enumerate() {
        let inside = rows[j / LANES].inside >> (j % LANES) & 1 == 1;
        found.push_if(inside, ClipVertex::new(at, Tag::Corner(j as u16)));
    }
    let count = found.len;
    &mut corners[..count]
}

impl Polygons {
    #[inline]
    fn make_room(&mut self) {
        let (sides, count) = (self.window.len(), self.subject.len());
        self.rows.clear();
        self.rows.extend(self.subject.chunks(LANES).map(|chunk| {
            let corners: [DVec2; LANES] = array::from_fn(|i| chunk[i.min(chunk.len() - 1)]);
            Row {
                x: corners.map(|corner| corner.x).into(),
                y: corners.map(|corner| corner.y).into(),
                inside: ALL,
                below: 0,
            }
        }));
        // Of each side its start, and crossings with at most all sides of the subject; and one
        // place to write to in vain.
        let most = sides * (count + 1) + count + 1;
        if self.corners.len() < most {
            let nothing = ClipVertex::new(DVec2::ZERO, Tag::Corner(0));
            self.corners.resize(most, nothing);
        }
    }
}

/// Writes corners one after the other.
struct Appender<'a> {
    room: &'a mut [ClipVertex],
    len: usize,
}

impl Appender<'_> {
    #[inline]
    fn push_if(&mut self, wanted: bool, corner: ClipVertex) {
        self.room[self.len] = corner;
        self.len += usize::from(wanted);
    }
}

/// A side of the window.
struct Side {
    index: u16,
    from: DVec2,
    along: DVec2,
    length_squared: f64,
    /// What still counts as inside: in heights, and along the side.
    slack: f64,
}

impl Side {
    #[inline]
    fn new(index: u16, from: DVec2, to: DVec2, slack: f64) -> Self {
        let along = to - from;
        // Heights are multiplied by the length; the sum of coordinates is not shorter.
        let length = along.x.abs() + along.y.abs();
        Self {
            index,
            from,
            along,
            length_squared: along.length_squared(),
            slack: slack * length,
        }
    }

    /// The place of a point along the side, from 0 to the length squared, and its height over it,
    /// positive inside.
    #[inline]
    fn place(&self, p: DVec2) -> DVec2 {
        let from = p - self.from;
        DVec2::new(self.along.dot(from), self.along.perp_dot(from))
    }

    /// Strikes the subject's corners below this side from those inside, and adds what the side has
    /// of the intersection's corners.
    #[inline]
    fn cut(&self, subject: &[DVec2], rows: &mut [Row], found: &mut Appender<'_>) {
        for row in &mut *rows {
            // As `place` computes them.
            let (x, y) = (row.x - self.from.x, row.y - self.from.y);
            let heights = y * self.along.x - x * self.along.y;
            row.inside &= !heights.simd_lt(f64x4::splat(-self.slack)).to_bitmask();
            row.below = heights.simd_lt(f64x4::ZERO).to_bitmask();
        }
        // Whether the line enters or leaves the subject before the side's start, and after it.
        let (mut before, mut after) = (false, false);
        // A line of two corners has no side back.
        let mut last = if subject.len() == 2 {
            0
        } else {
            subject.len() - 1
        };
        let mut last_below = rows[last / LANES].below >> (last % LANES) & 1;
        for (r, row) in rows.iter().enumerate() {
            let mut crosses = ((row.below << 1 | last_below) ^ row.below) & ALL;
            while crosses != 0 {
                let to = r * LANES + crosses.trailing_zeros() as usize;
                let from = if to == r * LANES { last } else { to - 1 };
                crosses &= crosses - 1;
                let ends = [self.place(subject[from]), self.place(subject[to])];
                let share = ends[0].y / (ends[0].y - ends[1].y);
                let place = ends[0].x + (ends[1].x - ends[0].x) * share;
                before |= place <= 0.0;
                after |= place >= 0.0;
                let on_side = (place >= -self.slack) & (place <= self.length_squared + self.slack);
                let at = subject[from].lerp(subject[to], share);
                let tag = Tag::Crossing(self.index, from as u16);
                found.push_if(on_side, ClipVertex::new(at, tag));
            }
            last = r * LANES + LANES - 1;
            last_below = row.below >> (LANES - 1);
        }
        let start = ClipVertex::new(self.from, Tag::Window(self.index));
        found.push_if(before & after, start);
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
        intersect(&mut polygons, SLACK).to_vec()
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
            let corners = intersect(&mut polygons, SLACK);
            corners
                .iter()
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
