//! Intersection of two convex polygons in the plane, with the origin of each corner.
//!
//! Each side of the window lies on a line that the other polygon crosses twice or not at all (Cyrus, Beck,
//! *Generalized two- and three-dimensional clipping*, Computers & Graphics 3(1), 1978). So the heights of one
//! polygon's corners over the other's sides show which corners are inside and where sides cross. The corners
//! of the result are in no particular order, and where corners of both polygons meet, one may occur twice.
//!
//! It is not predictable which corners are inside and which sides cross, and a mispredicted branch costs more
//! than all the arithmetic for four corners. So everything is computed in fours for all possible corners, and
//! then the actual ones are gathered.

use crate::simd::f32x4;

use super::clip_vertices::ClipVertices;
use super::polygon::{EdgeLanes, PolygonRows};
use super::sectors;
use crate::simd::LANES;
use crate::support::VertexId;

/// If there are more pairs of sides than this, only near ones are compared.
const MANY: usize = 1200;

/// The origin of a corner of the intersection. Indices are those of the given polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VertexOrigin {
    /// A corner of the clipped polygon.
    Subject(u16),
    /// A corner of the window.
    Window(u16),
    /// The crossing of a side of the window and a side of the clipped polygon.
    Crossing(u16, u16),
    /// A vertex of the first or the second shape, of a face beside the one in contact.
    Beside(usize, VertexId),
}

/// The two polygons, and the corners of their intersection.
#[derive(Clone, Debug, Default)]
pub(super) struct Clipper {
    /// Counter-clockwise.
    pub window: PolygonRows,
    /// Clockwise, as a face of the second shape appears. It may be only the two ends of a line.
    pub subject: PolygonRows,
    /// The corners of the last intersection.
    pub corners: ClipVertices,
    /// Vertices that were added to the corners.
    beside: Vec<(usize, VertexId)>,
}

impl Clipper {
    /// Finds the corners of the intersection of window and subject.
    #[inline]
    pub fn intersect(&mut self) {
        let subject = self.subject.count;
        self.corners.count = 0;
        self.beside.clear();
        if self.window.count <= LANES && (3..=LANES).contains(&subject) {
            self.intersect_few();
        } else if self.window.count * subject < MANY || !self.intersect_sectors() {
            self.intersect_many();
        }
    }

    /// Compares only near corners and sides. Returns `false` for polygons that are too thin for that.
    #[inline(never)]
    fn intersect_sectors(&mut self) -> bool {
        let is_area = self.window.count > 2 && self.subject.count > 2;
        is_area && sectors::intersect(&self.window, &self.subject, &mut self.corners)
    }

    /// Gathers all corners together.
    #[inline(always)]
    fn intersect_few(&mut self) {
        let (window, subject) = (&self.window.rows()[0], &mut self.subject.rows_mut()[0]);
        let [mut x, mut y] = [[f32x4::ZERO; LANES + 2]; 2];
        let (mut there, mut inside) = (0, 0);
        for i in 0..self.window.count.min(LANES) {
            let side = EdgeLanes::new(window, i);
            inside |= u32::from(subject.contains(side.x, side.y)) << i;
            let crossings = side.clip_row(subject);
            (x[i], y[i]) = (crossings.x, crossings.y);
            there |= crossings.there << (LANES * i);
        }
        let corners = subject.inside.to_bitmask();
        [x[LANES], x[LANES + 1]] = [subject.x, window.x];
        [y[LANES], y[LANES + 1]] = [subject.y, window.y];
        let subject = corners & self.subject.vertex_mask(0);
        there |= (subject | inside << LANES) << (LANES * LANES);
        self.corners.push_masked(there, 0, &x, &y);
    }

    /// Gathers corners as they are found: in large polygons most possible corners do not exist.
    #[inline(never)]
    fn intersect_many(&mut self) {
        let Self {
            window,
            subject,
            corners,
            ..
        } = self;
        let width = subject.width();
        let subject_source = window.width() * width;
        let window_source = subject_source + width;
        // A line of two corners has no side back and no interior.
        let is_line = subject.count == 2;
        for i in 0..window.count {
            let row = &window.rows()[i / LANES];
            let side = EdgeLanes::new(row, i % LANES);
            let mut is_inside = !is_line;
            for (r, other) in subject.rows_mut().iter_mut().enumerate() {
                is_inside &= other.contains(side.x, side.y);
                let crossings = side.clip_row(other);
                let there = crossings.there & if is_line { 1 } else { !0 };
                let source = i * width + r * LANES;
                corners.push_masked(there, source, &[crossings.x], &[crossings.y]);
            }
            let there = u32::from(is_inside) << (i % LANES);
            let source = window_source + i / LANES * LANES;
            corners.push_masked(there, source, &[row.x], &[row.y]);
        }
        for (r, row) in subject.rows().iter().enumerate() {
            let there = row.inside.to_bitmask() & subject.vertex_mask(r);
            let source = subject_source + r * LANES;
            corners.push_masked(there, source, &[row.x], &[row.y]);
        }
    }

    /// Adds a vertex of one shape at a position in the contact plane, if that is inside the other shape's
    /// polygon.
    pub fn add_beside(&mut self, side: usize, vertex: VertexId, [x, y]: [f32x4; 2]) {
        let is_inside = if side == 0 {
            self.subject.count > 2 && self.subject.rows().iter().all(|row| row.contains(x, y))
        } else {
            let rows = self.window.rows();
            rows.iter().all(|row| row.contains_as_window(x, y))
        };
        if is_inside {
            let source = self.first_beside() + self.beside.len();
            self.beside.push((side, vertex));
            self.corners.push_masked(1, source, &[x], &[y]);
        }
    }

    /// The source of the first vertex that is added.
    fn first_beside(&self) -> usize {
        let (window, subject) = (self.window.width(), self.subject.width());
        window * subject + subject + window
    }

    /// The origin of a corner of the intersection.
    #[inline]
    pub fn origin(&self, corner: usize) -> VertexOrigin {
        let source = self.corners.sources[corner] as usize;
        let width = self.subject.width();
        let crossings = self.window.width() * width;
        if source < crossings {
            VertexOrigin::Crossing((source / width) as u16, (source % width) as u16)
        } else if source - crossings < width {
            VertexOrigin::Subject((source - crossings) as u16)
        } else if source < self.first_beside() {
            VertexOrigin::Window((source - crossings - width) as u16)
        } else {
            let (side, vertex) = self.beside[source - self.first_beside()];
            VertexOrigin::Beside(side, vertex)
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, Vec2};

    use super::*;

    const SQUARE: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn polygon(corners: &[Vec2]) -> PolygonRows {
        let mut polygon = PolygonRows::default();
        polygon.set(corners.len(), |numbers| {
            let corners = numbers.map(|i| corners[i]);
            [corners.map(|p| p.x).into(), corners.map(|p| p.y).into()]
        });
        polygon
    }

    fn intersection(window: &[Vec2], subject: &[Vec2]) -> Vec<(Vec2, VertexOrigin)> {
        let mut clipper = Clipper {
            window: polygon(window),
            subject: polygon(subject),
            ..Clipper::default()
        };
        clipper.intersect();
        let corners = 0..clipper.corners.count;
        corners
            .map(|i| (clipper.corners.at(i), clipper.origin(i)))
            .collect()
    }

    /// Both polygons counter-clockwise.
    fn clip(window: &[Vec2], polygon: &[Vec2]) -> Vec<(Vec2, VertexOrigin)> {
        let clockwise: Vec<Vec2> = polygon.iter().rev().copied().collect();
        intersection(window, &clockwise)
    }

    fn clip_square(polygon: [[f32; 2]; 4]) -> Vec<(Vec2, VertexOrigin)> {
        let mut corners = clip(&SQUARE.map(Vec2::from), &polygon.map(Vec2::from));
        corners.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.0.y.total_cmp(&b.0.y)));
        corners
    }

    #[test]
    fn shifted_squares_meet_in_a_corner_of_each_and_two_crossings() {
        assert_eq!(
            clip_square(SQUARE.map(|[x, y]| [x + 0.5, y + 0.5])),
            [
                (Vec2::new(0.5, 0.5), VertexOrigin::Subject(3)),
                (Vec2::new(0.5, 1.0), VertexOrigin::Crossing(2, 3)),
                (Vec2::new(1.0, 0.5), VertexOrigin::Crossing(1, 2)),
                (Vec2::new(1.0, 1.0), VertexOrigin::Window(2)),
            ]
        );
    }

    #[test]
    fn a_window_inside_of_the_polygon_is_the_intersection() {
        let corners = clip_square(SQUARE.map(|[x, y]| [4.0 * x - 2.0, 4.0 * y - 2.0]));
        let tags: Vec<VertexOrigin> = corners.iter().map(|corner| corner.1).collect();
        assert_eq!(tags, [0, 3, 1, 2].map(VertexOrigin::Window));
    }

    #[test]
    fn disjoint_polygons_do_not_meet() {
        assert!(clip_square(SQUARE.map(|[x, y]| [x + 3.0, y])).is_empty());
    }

    #[test]
    fn a_line_keeps_its_inner_part() {
        let clip_line =
            |line: [[f32; 2]; 2]| intersection(&SQUARE.map(Vec2::from), &line.map(Vec2::from));
        assert_eq!(
            clip_line([[-0.5, 0.5], [0.5, 0.5]]),
            [
                (Vec2::new(0.0, 0.5), VertexOrigin::Crossing(3, 0)),
                (Vec2::new(0.5, 0.5), VertexOrigin::Subject(1))
            ]
        );
        assert_eq!(
            clip_line([[0.25, 2.0], [0.25, -2.0]]),
            [
                (Vec2::new(0.25, 0.0), VertexOrigin::Crossing(0, 0)),
                (Vec2::new(0.25, 1.0), VertexOrigin::Crossing(2, 0))
            ]
        );
        assert!(clip_line([[-1.0, 2.0], [2.0, 2.0]]).is_empty());
        assert!(clip_line([[-1.0, 0.5], [0.5, 2.0]]).is_empty());
    }

    fn ellipse(count: usize, rng: &mut oorandom::Rand64) -> Vec<Vec2> {
        let [x, y, a, b, turn] = [(); 5].map(|()| rng.rand_float() as f32);
        (0..count)
            .map(|i| {
                let angle = std::f32::consts::TAU * (i as f32 / count as f32 + turn);
                let (sin, cos) = angle.sin_cos();
                Vec2::new(x + (0.2 + a) * cos, y + (0.2 + b) * sin)
            })
            .collect()
    }

    fn is_inside(p: DVec2, polygon: &[Vec2], slack: f64) -> bool {
        let corners = polygon.iter().map(|corner| corner.as_dvec2());
        let ends = corners.clone().cycle().skip(1);
        let mut sides = corners.zip(ends);
        sides.all(|(a, b)| (b - a).perp_dot(p - a) >= -slack * (b - a).length())
    }

    /// All possible corners of the intersection, from every pair of sides.
    fn candidates(a: &[Vec2], b: &[Vec2]) -> Vec<DVec2> {
        let side = |p: &[Vec2], i: usize| [p[i], p[(i + 1) % p.len()]].map(|v| v.as_dvec2());
        let mut found: Vec<DVec2> = a.iter().chain(b).map(|v| v.as_dvec2()).collect();
        for i in 0..a.len() {
            for j in 0..b.len() {
                let ([p, p2], [q, q2]) = (side(a, i), side(b, j));
                let (d, e) = (p2 - p, q2 - q);
                // Nearly parallel sides may cross anywhere.
                if d.perp_dot(e).abs() > 1e-4 * d.length() * e.length() {
                    found.push(p + d * ((q - p).perp_dot(e) / d.perp_dot(e)));
                }
            }
        }
        found.retain(|&p| is_inside(p, a, 1e-12) && is_inside(p, b, 1e-12));
        found
    }

    /// Divides each side of an outline into `times` parts, like a divided flat end.
    fn divided(outline: &[Vec2], times: usize) -> Vec<Vec2> {
        let ends = outline.iter().cycle().skip(1);
        let along = |(a, b): (&Vec2, &Vec2)| {
            let (a, b) = (*a, *b);
            (0..times).map(move |i| a.lerp(b, i as f32 / times as f32))
        };
        outline.iter().zip(ends).flat_map(along).collect()
    }

    /// Ellipses; in some rounds one of them is equal, divided or thin.
    fn many_corners(round: u32, rng: &mut oorandom::Rand64) -> [Vec<Vec2>; 2] {
        let counts = [(); 2].map(|()| rng.rand_range(3..90) as usize);
        let [mut window, mut subject] = counts.map(|count| ellipse(count, rng));
        let tiny = Vec2::splat(6e-8 * (round % 7) as f32);
        match round % 6 {
            0 => subject = window.iter().map(|&p| p + tiny).collect(),
            1 => window = divided(&SQUARE.map(Vec2::from), 20),
            2 => {
                window = divided(&window[..3], 30);
                subject = divided(&subject[..3], 25);
            }
            3 => subject.iter_mut().for_each(|p| p.y = 0.3 + 1e-3 * p.y),
            4 => {
                let turn = Vec2::from_angle(rng.rand_float() as f32);
                window = divided(&SQUARE.map(Vec2::from), 20);
                window.iter_mut().for_each(|p| *p = p.rotate(turn));
                subject = window.iter().map(|p| *p + tiny).collect();
            }
            _ => {}
        }
        [window, subject]
    }

    /// Polygons of many corners, of which only near sides are compared: also thin and equal ones, and such
    /// with straight runs. No corner is missing that is found by comparing all sides.
    #[test]
    fn near_sides_are_enough() {
        let mut rng = oorandom::Rand64::new(3);
        let mut by_sectors = 0;
        for round in 0..600 {
            let [window, mut subject] = many_corners(round, &mut rng);
            subject.reverse();
            let mut clipper = Clipper {
                window: polygon(&window),
                subject: polygon(&subject),
                ..Clipper::default()
            };
            let found = |clipper: &Clipper| -> Vec<(Vec2, VertexOrigin)> {
                let corners = 0..clipper.corners.count;
                let corner = |i| (clipper.corners.at(i), clipper.origin(i));
                corners.map(corner).collect()
            };
            if !clipper.intersect_sectors() {
                continue;
            }
            by_sectors += 1;
            let near = found(&clipper);
            clipper.corners.count = 0;
            clipper.intersect_many();
            let all = found(&clipper);
            let is_found = |at: Vec2| near.iter().any(|other| other.0.distance(at) < 2e-6);
            let missing = all.iter().find(|corner| !is_found(corner.0));
            assert_eq!(missing, None, "round {round}");
            // Far sides in a straight run may reject a corner by rounding.
            subject.reverse();
            for (at, tag) in near {
                let inside = |polygon| is_inside(at.as_dvec2(), polygon, 4e-6);
                assert!(
                    inside(&window) && inside(&subject),
                    "round {round}: {at} of {tag:?}"
                );
            }
        }
        assert!(by_sectors > 500, "only {by_sectors}");
    }

    /// Against brute force in f64. Includes equal polygons, and polygons that are turned or shifted by a
    /// rounding, with few corners (one row) and with more.
    #[test]
    fn the_corners_are_those_of_the_intersection() {
        let mut rng = oorandom::Rand64::new(2);
        for round in 0..4000 {
            let most = if round % 8 < 4 { 5 } else { 14 };
            let counts = [(); 2].map(|()| rng.rand_range(3..most) as usize);
            let window = ellipse(counts[0], &mut rng);
            let tiny = Vec2::splat(6e-8 * (round % 7) as f32);
            let polygon = match round % 4 {
                0 => window.iter().map(|&p| p + tiny).collect(),
                1 => window
                    .iter()
                    .map(|p| p.rotate(Vec2::from_angle(tiny.x)))
                    .collect(),
                _ => ellipse(counts[1], &mut rng),
            };
            let corners = clip(&window, &polygon);
            for (at, tag) in &corners {
                for polygon in [&window, &polygon] {
                    let inside = is_inside(at.as_dvec2(), polygon, 4e-6);
                    assert!(inside, "round {round}: {at} of {tag:?} is outside");
                }
            }
            for p in candidates(&window, &polygon) {
                let near = |(at, _): &(Vec2, VertexOrigin)| at.as_dvec2().distance(p) < 1e-4;
                assert!(corners.iter().any(near), "round {round}: {p} is missing");
            }
        }
    }
}
