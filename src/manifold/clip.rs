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

use crate::at::to_u16;
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
    pub fn add_beside(&mut self, shape: usize, vertex: VertexId, [x, y]: [f32x4; 2]) {
        let is_inside = if shape == 0 {
            self.subject.count > 2 && self.subject.rows().iter().all(|row| row.contains(x, y))
        } else {
            let rows = self.window.rows();
            rows.iter().all(|row| row.contains_as_window(x, y))
        };
        if is_inside {
            let source = self.first_beside() + self.beside.len();
            self.beside.push((shape, vertex));
            self.corners.push_masked(1, source, &[x], &[y]);
        }
    }

    /// The source of the first vertex that is added.
    fn first_beside(&self) -> usize {
        let (window, subject) = (self.window.width(), self.subject.width());
        window * subject + subject + window
    }

    /// The origin of a corner of the intersection.
    // perf: in a call it would be stored, and told apart twice.
    #[inline(always)]
    pub fn origin(&self, corner: usize) -> VertexOrigin {
        let source = self.corners.sources[corner] as usize;
        let width = self.subject.width();
        let crossings = self.window.width() * width;
        if source < crossings {
            VertexOrigin::Crossing(to_u16(source / width), to_u16(source % width))
        } else if source - crossings < width {
            VertexOrigin::Subject(to_u16(source - crossings))
        } else if source < self.first_beside() {
            VertexOrigin::Window(to_u16(source - crossings - width))
        } else {
            let (shape, vertex) = self.beside[source - self.first_beside()];
            VertexOrigin::Beside(shape, vertex)
        }
    }
}

#[cfg(test)]
mod tests;
