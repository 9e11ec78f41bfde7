//! Polygons in the contact plane, in rows of four corners.

use crate::simd::{ALL, LANES, f32x4, first_lanes, lane_mask};
use glam::Vec2;

use crate::tolerance::CLIP_SLACK;

/// A polygon. Its last row is filled up with its first corner.
#[derive(Clone, Debug)]
pub(super) struct PolygonRows {
    pub count: usize,
    /// The rows. There is always one, and there may be more than are in use.
    rows: Vec<Row>,
}

/// Four corners, and the sides from each of them to the next. The sides of padding have no length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub x: f32x4,
    pub y: f32x4,
    along_x: f32x4,
    along_y: f32x4,
    /// How far below the sides still counts as inside. Heights are multiplied by the lengths of the sides.
    slack: f32x4,
    /// Which corners are inside all sides of the other polygon so far.
    pub inside: f32x4,
}

impl Default for PolygonRows {
    fn default() -> Self {
        Self {
            count: 0,
            rows: vec![Row::NONE],
        }
    }
}

impl PolygonRows {
    /// Sets the polygon to this number of corners, which `corners` returns four at a time.
    #[inline(always)]
    pub fn set(&mut self, count: usize, corners: impl Fn([usize; LANES]) -> [f32x4; 2]) {
        self.count = count;
        if count > LANES {
            return self.set_many(&corners);
        }
        let or_first = |i: usize| if i < count { i } else { 0 };
        let mut row = Row::new(corners([0, or_first(1), or_first(2), or_first(3)]));
        row.add_sides(row.first());
        self.rows[0] = row;
    }

    /// Separate from the single row that most polygons have, so that this needs no loop.
    #[inline(never)]
    fn set_many(&mut self, corners: &dyn Fn([usize; LANES]) -> [f32x4; 2]) {
        let rows = self.count.div_ceil(LANES);
        if self.rows.len() < rows {
            self.rows.resize(rows, Row::NONE);
        }
        for r in 0..rows {
            let or_first = |i: usize| if i < self.count { i } else { 0 };
            let numbers = [0, 1, 2, 3].map(|lane| or_first(LANES * r + lane));
            let row = Row::new(corners(numbers));
            if r > 0 {
                self.rows[r - 1].add_sides(row.first());
            }
            self.rows[r] = row;
        }
        let start = self.rows[0].first();
        self.rows[rows - 1].add_sides(start);
    }

    #[inline(always)]
    pub fn rows(&self) -> &[Row] {
        &self.rows[..self.count.div_ceil(LANES)]
    }

    #[inline(always)]
    pub fn rows_mut(&mut self) -> &mut [Row] {
        &mut self.rows[..self.count.div_ceil(LANES)]
    }

    /// The number of corners, padding included.
    #[inline(always)]
    pub fn width(&self) -> usize {
        self.count.next_multiple_of(LANES)
    }

    #[inline(always)]
    pub fn corner(&self, corner: usize) -> Vec2 {
        let (row, lane) = (&self.rows[corner / LANES], corner % LANES);
        Vec2::new(row.x.as_array()[lane], row.y.as_array()[lane])
    }

    /// The side that starts at a corner.
    #[inline(always)]
    pub fn side(&self, corner: usize) -> Line {
        let (row, lane) = (&self.rows[corner / LANES], corner % LANES);
        let of_lane = |row: &f32x4| row.as_array()[lane];
        Line {
            at: Vec2::new(of_lane(&row.x), of_lane(&row.y)),
            along: Vec2::new(of_lane(&row.along_x), of_lane(&row.along_y)),
            slack: of_lane(&row.slack),
        }
    }

    /// The bits of a row's corners, without padding.
    #[inline(always)]
    pub fn vertex_mask(&self, row: usize) -> u32 {
        first_lanes(self.count - LANES * row)
    }
}

impl Row {
    const NONE: Self = Self {
        x: f32x4::ZERO,
        y: f32x4::ZERO,
        along_x: f32x4::ZERO,
        along_y: f32x4::ZERO,
        slack: f32x4::ZERO,
        inside: f32x4::ZERO,
    };

    /// A row without sides.
    #[inline(always)]
    fn new([x, y]: [f32x4; 2]) -> Self {
        let inside = lane_mask(ALL);
        Self {
            x,
            y,
            inside,
            ..Self::NONE
        }
    }

    #[inline(always)]
    fn first(&self) -> Vec2 {
        Vec2::new(self.x.to_array()[0], self.y.to_array()[0])
    }

    /// Computes the sides. The last one ends at `next`.
    #[inline(always)]
    fn add_sides(&mut self, next: Vec2) {
        let along = |row: f32x4, next: f32| {
            let [_, b, c, d] = row.to_array();
            f32x4::new([b, c, d, next]) - row
        };
        self.along_x = along(self.x, next.x);
        self.along_y = along(self.y, next.y);
        // The sum of coordinates is at least the length.
        let length = self.along_x.abs() + self.along_y.abs();
        self.slack = (length + self.x.abs() + self.y.abs()) * length * CLIP_SLACK;
    }

    /// Whether a point is inside these sides of a clockwise polygon.
    #[inline(always)]
    pub fn contains(&self, x: f32x4, y: f32x4) -> bool {
        self.heights(x, y).simd_ge(-self.slack).all()
    }

    /// Whether a point is inside these sides of a counter-clockwise polygon.
    #[inline]
    pub fn contains_as_window(&self, x: f32x4, y: f32x4) -> bool {
        self.heights(x, y).simd_le(self.slack).all()
    }

    /// The heights of a point over the sides of a clockwise polygon, times their lengths.
    #[inline(always)]
    fn heights(&self, x: f32x4, y: f32x4) -> f32x4 {
        (x - self.x) * self.along_y - (y - self.y) * self.along_x
    }
}

/// A side of a polygon, or the line through it.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub at: Vec2,
    pub along: Vec2,
    /// How far below the side still counts as inside. Heights are multiplied by the length of the side.
    pub slack: f32,
}

impl Line {
    /// How far left of the side a point is, multiplied by its length.
    #[inline(always)]
    pub fn height(&self, p: Vec2) -> f32 {
        self.along.perp_dot(p - self.at)
    }

    /// Where the side `other` crosses this one.
    #[inline(always)]
    pub fn crossing(&self, other: &Self) -> Option<Vec2> {
        let from = other.at - self.at;
        let heights = [from, from + other.along].map(|p| self.along.perp_dot(p));
        if (heights[0] < 0.0) == (heights[1] < 0.0) {
            return None;
        }
        let at = from + other.along * (heights[0] / (heights[0] - heights[1]));
        // The position along this side, from 0 to its squared length.
        let place = at.dot(self.along);
        let end = self.along.length_squared() + self.slack;
        (place >= -self.slack && place <= end).then_some(self.at + at)
    }
}

/// A side of a polygon, in all lanes.
pub(super) struct EdgeLanes {
    pub x: f32x4,
    pub y: f32x4,
    along_x: f32x4,
    along_y: f32x4,
    slack: f32x4,
}

/// Crossings with a row of sides. Only lanes whose bits are set count.
pub(super) struct Crossings {
    pub x: f32x4,
    pub y: f32x4,
    pub there: u32,
}

impl EdgeLanes {
    /// The lane of a corner in a row.
    #[inline(always)]
    pub fn new(row: &Row, lane: usize) -> Self {
        let of_lane = |row: &f32x4| f32x4::splat(row.as_array()[lane]);
        Self {
            x: of_lane(&row.x),
            y: of_lane(&row.y),
            along_x: of_lane(&row.along_x),
            along_y: of_lane(&row.along_y),
            slack: of_lane(&row.slack),
        }
    }

    /// Marks the other polygon's corners below this side as outside, and returns where its sides cross this
    /// one.
    #[inline(always)]
    pub fn clip_row(&self, other: &mut Row) -> Crossings {
        let (from_x, from_y) = (other.x - self.x, other.y - self.y);
        let (to_x, to_y) = (from_x + other.along_x, from_y + other.along_y);
        let from = from_y * self.along_x - from_x * self.along_y;
        let to = to_y * self.along_x - to_x * self.along_y;
        other.inside &= from.simd_ge(-self.slack);
        let crosses = from.simd_lt(f32x4::ZERO) ^ to.simd_lt(f32x4::ZERO);
        let share = from / (from - to);
        let x = from_x + other.along_x * share;
        let y = from_y + other.along_y * share;
        // The position along the side, from 0 to its squared length.
        let place = x * self.along_x + y * self.along_y;
        let end = self.along_x * self.along_x + self.along_y * self.along_y + self.slack;
        let on_side = place.simd_ge(-self.slack) & place.simd_le(end);
        Crossings {
            x: self.x + x,
            y: self.y + y,
            there: (crosses & on_side).to_bitmask(),
        }
    }
}
