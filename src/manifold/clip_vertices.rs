//! The corners of an intersection, in a list.

use crate::at::to_u32;
use crate::simd::f32x4;
use glam::Vec2;

use super::polygon::PolygonRows;
use crate::map_pair::map_pair;
use crate::simd::LANES;

/// A list of corners.
#[derive(Clone, Debug, Default)]
pub(super) struct ClipVertices {
    x: Vec<f32>,
    y: Vec<f32>,
    /// The source of each corner. Crossings are numbered first, window side by window side, then the corners
    /// of the subject, and then the corners of the window, in whole rows each.
    pub sources: Vec<u32>,
    pub count: usize,
}

impl ClipVertices {
    /// Copies the corners of a polygon.
    pub fn set(&mut self, polygon: &PolygonRows) {
        self.count = 0;
        for (r, row) in polygon.rows().iter().enumerate() {
            self.push_masked(polygon.vertex_mask(r), LANES * r, &[row.x], &[row.y]);
        }
    }

    /// Adds the corners of some rows whose bits are set. The first corner of the first row has the number
    /// `source`.
    #[inline(always)]
    pub fn push_masked<const ROWS: usize>(
        &mut self,
        mut there: u32,
        source: usize,
        x: &[f32x4; ROWS],
        y: &[f32x4; ROWS],
    ) {
        if self.sources.len() < self.count + LANES * ROWS {
            self.grow(self.count + LANES * ROWS);
        }
        let (x, y): (&[f32], &[f32]) = (bytemuck::cast_slice(x), bytemuck::cast_slice(y));
        while there != 0 {
            let i = there.trailing_zeros() as usize;
            there &= there - 1;
            self.x[self.count] = x[i];
            self.y[self.count] = y[i];
            self.sources[self.count] = to_u32(source + i);
            self.count += 1;
        }
    }

    /// Adds one corner.
    #[inline(always)]
    pub fn push(&mut self, at: Vec2, source: usize) {
        if self.sources.len() <= self.count {
            self.grow(self.count + 1);
        }
        self.x[self.count] = at.x;
        self.y[self.count] = at.y;
        self.sources[self.count] = to_u32(source);
        self.count += 1;
    }

    /// Makes room for at least this many corners. They are read in fours.
    #[cold]
    fn grow(&mut self, count: usize) {
        let room = (2 * count).next_multiple_of(LANES);
        self.x.resize(room, 0.0);
        self.y.resize(room, 0.0);
        self.sources.resize(room, 0);
    }

    /// The positions, in fours.
    #[inline(always)]
    pub fn fours(&self) -> impl Iterator<Item = [f32x4; 2]> {
        let rows = self.count.div_ceil(LANES);
        let [x, y] = map_pair([&self.x, &self.y], |all| {
            all.as_chunks::<LANES>().0[..rows].iter()
        });
        x.zip(y).map(|(&x, &y)| [x.into(), y.into()])
    }

    /// The position of a corner.
    #[inline(always)]
    pub fn at(&self, corner: usize) -> Vec2 {
        Vec2::new(self.x[corner], self.y[corner])
    }
}
