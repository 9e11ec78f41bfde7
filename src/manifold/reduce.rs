//! The choice of the corners of the contact patch that become contacts, in fours.

use std::ops::RangeInclusive;

use glam::Vec2;

use super::clip_vertices::ClipVertices;
use super::contacts::MAX_POINTS;
use crate::arg_max::ArgMax4;
use crate::at::to_u32;
use crate::simd::{LANES, f32x4, first_lanes, lane_mask, u32x4};
use crate::tuning::CORNER_RISE;

/// Corners to choose from, by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    /// The rows. There may be more than are in use.
    fours: Vec<CandidateRow>,
    rows: usize,
}

/// Four corners. The last ones may be padding.
#[derive(Clone, Copy, Debug, Default)]
struct CandidateRow {
    x: f32x4,
    y: f32x4,
    /// The distance from the first face to the second, along the contact normal.
    distance: f32x4,
    /// A mask of the corners within the wanted range.
    near: f32x4,
    /// A mask of the corners beyond it.
    beyond: f32x4,
}

/// A summary of the candidates.
pub(super) struct CandidateSummary {
    /// The corner where the faces are nearest or overlap most.
    pub deepest: Option<usize>,
    /// Whether a corner is at the origin of the contact plane.
    pub at_origin: bool,
}

/// The ids of the corners in a row. They count from 1; the id 0 means no corner.
#[inline(always)]
fn ids(row: usize) -> u32x4 {
    u32x4::splat(to_u32(LANES * row)) + u32x4::new([1, 2, 3, 4])
}

/// The number of the corner with the greatest measure.
#[inline(always)]
fn corner(greatest: ArgMax4<f32x4>) -> Option<usize> {
    greatest.finish().id.checked_sub(1)
}

impl Candidates {
    /// Takes the corners, and computes the `distances` of each row. Corners within `range` are candidates,
    /// farther ones are fallbacks, and nearer ones are dropped. A corner nearer than `same` to the origin
    /// counts as being there.
    #[inline(always)]
    pub fn set(
        &mut self,
        corners: &ClipVertices,
        distances: impl Fn(usize, f32x4, f32x4) -> f32x4,
        range: RangeInclusive<f32>,
        same: f32,
    ) -> CandidateSummary {
        self.rows = corners.count.div_ceil(LANES);
        if self.fours.len() < self.rows {
            self.fours.resize(self.rows, CandidateRow::default());
        }
        let (least, most) = (f32x4::splat(*range.start()), f32x4::splat(*range.end()));
        let mut deepest = ArgMax4::new(f32::NEG_INFINITY);
        let mut at_origin = f32x4::ZERO;
        for (row, (four, [x, y])) in self.fours.iter_mut().zip(corners.fours()).enumerate() {
            let distance = distances(row, x, y);
            let corners = lane_mask(first_lanes(corners.count - LANES * row));
            let there = corners & distance.simd_ge(least);
            let near = there & distance.simd_le(most);
            deepest.update_where(near, -distance, ids(row));
            at_origin |= near & (x * x + y * y).simd_le(f32x4::splat(same * same));
            *four = CandidateRow {
                x,
                y,
                distance,
                near,
                beyond: there ^ near,
            };
        }
        CandidateSummary {
            deepest: corner(deepest),
            at_origin: at_origin.any(),
        }
    }

    #[inline(always)]
    fn fours(&self) -> impl Iterator<Item = &CandidateRow> {
        self.fours[..self.rows].iter()
    }

    /// The distance of the faces at a corner; some number if there is no such corner.
    #[inline(always)]
    pub fn distance(&self, corner: usize) -> f32 {
        let [_, _, distance] = self.corner(corner);
        distance
    }

    /// The position of a corner, and the distance of the faces there; some numbers if there is no such corner.
    #[inline(always)]
    pub fn corner(&self, corner: usize) -> [f32; 3] {
        let four = self.fours.get(corner / LANES);
        let of_lane = |row: &f32x4| row.as_array()[corner % LANES];
        four.map_or([0.0; 3], |four| {
            [&four.x, &four.y, &four.distance].map(of_lane)
        })
    }

    /// Removes and returns the nearest of the corners beyond the range.
    #[inline(always)]
    pub fn pop_beyond_range(&mut self) -> Option<usize> {
        let mut nearest = ArgMax4::new(f32::NEG_INFINITY);
        for (row, four) in self.fours().enumerate() {
            nearest.update_where(four.beyond, -four.distance, ids(row));
        }
        let corner = corner(nearest)?;
        self.fours[corner / LANES].beyond &= lane_mask(!(1 << (corner % LANES)));
        Some(corner)
    }

    /// Corners that, with the contact at `first`, span a large area: the farthest from it, the farthest from the
    /// line through both, and the farthest on its other side. None of them is nearer than `same` to another. Low
    /// corners come first: each counts as nearer by [`CORNER_RISE`] times its height above `level`, which is that of
    /// the first, or above the line.
    #[inline(always)]
    pub fn spread_out(
        &self,
        corners: &ClipVertices,
        (first, level): (Vec2, f32),
        same: f32,
    ) -> [Option<usize>; MAX_POINTS - 1] {
        // Of four corners all are chosen, and their order stays.
        let has_choice = corners.count > MAX_POINTS;
        let mut base = Base {
            first,
            level,
            slope: Vec2::ZERO,
            rise: if has_choice { CORNER_RISE } else { 0.0 },
            same,
        };
        let Some(far) = self.farthest(&base, 1.0, |x, y| (x * x + y * y).sqrt()) else {
            return [None; MAX_POINTS - 1];
        };
        let line = corners.at(far) - first;
        // The areas over the line are distances times its length.
        let length = line.length();
        base.slope = line * ((self.distance(far) - level) / (length * length));
        let left = self.farthest(&base, length, |x, y| y * line.x - x * line.y);
        let right = self.farthest(&base, length, |x, y| x * line.y - y * line.x);
        match (left, right) {
            // If the patch is on one side of the line, the last corner adds most area to the triangle.
            (Some(side), None) | (None, Some(side)) => {
                let apex = corners.at(side) - first;
                let third = self.farthest(&base, length, |x, y| added_area(x, y, line, apex));
                [Some(far), Some(side), third]
            }
            (left, right) => [Some(far), left, right],
        }
    }

    /// The corner with the greatest measure, which is its distance from something times `length`. Its position is
    /// relative to the first contact.
    #[inline(always)]
    fn farthest(
        &self,
        base: &Base,
        length: f32,
        measure: impl Fn(f32x4, f32x4) -> f32x4,
    ) -> Option<usize> {
        let mut greatest = ArgMax4::new(f32::NEG_INFINITY);
        let (least, per_height) = (base.same * length, base.rise * length);
        for (row, four) in self.fours().enumerate() {
            let (x, y) = (four.x - base.first.x, four.y - base.first.y);
            let far = measure(x, y);
            let level = x * base.slope.x + y * base.slope.y + base.level;
            let rise = (four.distance - level).fast_max(f32x4::ZERO);
            let is_other = four.near & far.simd_gt(f32x4::splat(least));
            greatest.update_where(is_other, far - rise * per_height, ids(row));
        }
        corner(greatest)
    }
}

/// From where the other corners are seen.
struct Base {
    /// The first contact, and the distance of the faces there.
    first: Vec2,
    level: f32,
    /// By how much the distance grows along the line to the second contact.
    slope: Vec2,
    /// How much nearer a corner counts for its height.
    rise: f32,
    /// Corners that are nearer than this count as one.
    same: f32,
}

/// Twice the area that points add to the triangle of the origin, `a` and `b`, beyond one of its two edges at
/// `b`.
#[inline(always)]
fn added_area(x: f32x4, y: f32x4, a: Vec2, b: Vec2) -> f32x4 {
    // Positive beyond the edges, if the triangle is counter-clockwise.
    let turn = if a.perp_dot(b) > 0.0 { 1.0 } else { -1.0 };
    let (ab, bo) = ((b - a) * turn, b * turn);
    let beyond_ab = (x - a.x) * ab.y - (y - a.y) * ab.x;
    let beyond_bo = y * bo.x - x * bo.y;
    beyond_ab.fast_max(beyond_bo)
}

/// The corners of the contact patch that become contacts. `None` is the witness of the query.
#[derive(Default)]
pub(super) struct Selection {
    pub corners: [Option<usize>; MAX_POINTS],
    pub len: usize,
}

impl Selection {
    #[inline(always)]
    pub fn push(&mut self, corner: Option<usize>) {
        debug_assert!(
            self.len < MAX_POINTS,
            "more contacts than there is room for"
        );
        self.corners[self.len] = corner;
        self.len += 1;
    }

    /// The numbers of the corners. Unused entries mean nothing.
    #[inline(always)]
    pub fn numbers(&self) -> [usize; MAX_POINTS] {
        let [a, b, c, d] = self.corners;
        [
            a.unwrap_or(0),
            b.unwrap_or(0),
            c.unwrap_or(0),
            d.unwrap_or(0),
        ]
    }

    /// Adds the nearest corners beyond the range while there is room.
    #[inline(always)]
    pub fn fill_up(&mut self, candidates: &mut Candidates) {
        while self.len < MAX_POINTS
            && let Some(corner) = candidates.pop_beyond_range()
        {
            self.push(Some(corner));
        }
    }

    /// Adds the corners that are not `None`. It has no branches, since it is not predictable which these are.
    #[inline(always)]
    pub fn push_all(&mut self, corners: [Option<usize>; MAX_POINTS - 1]) {
        for corner in corners {
            self.corners[self.len] = corner;
            self.len += usize::from(corner.is_some());
        }
    }
}
