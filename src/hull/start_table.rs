//! A table from directions to extreme vertices, so that a cold climb starts near its end.

use glam::DVec3;

use crate::at::to_u16;
use crate::support::VertexId;

/// There is a cell for each vertex, up to this many cells per cube edge, which is enough for 6,000 vertices.
/// With these, half of all climbs begin where they end; with half as many cells 40 % do.
const FINEST: usize = 32;

/// The six faces of the cube of directions, `grid * grid` cells each, one vertex a cell.
#[derive(Clone, Debug)]
pub(super) struct StartTable {
    grid: usize,
    vertices: Box<[u16]>,
}

impl StartTable {
    /// Fills the table by calling `support` for the middle direction of each cell. Each call starts from the
    /// vertex of the previous cell.
    pub fn new(vertex_count: usize, mut support: impl FnMut(DVec3, VertexId) -> VertexId) -> Self {
        let grid = (vertex_count / 6).isqrt().clamp(1, FINEST);
        let mut last = VertexId::default();
        let vertices = (0..6 * grid * grid)
            .map(|cell| {
                last = support(cell_direction(grid, cell), last);
                to_u16(last.index())
            })
            .collect();
        Self { grid, vertices }
    }

    /// A vertex that is extreme in a direction near `dir`.
    #[inline]
    pub fn lookup(&self, dir: DVec3) -> VertexId {
        self.vertices[cell_of(self.grid, dir)].into()
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.vertices)
    }
}

/// The cell that contains `dir`; any cell if the direction is zero or not finite.
fn cell_of(grid: usize, dir: DVec3) -> usize {
    let size = dir.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let along = dir[axis];
    let face = 2 * axis + usize::from(along < 0.0);
    let scale = 0.5 * grid as f64 / along.abs();
    // A cast from NaN gives 0, and from beyond the range its end: always a valid cell.
    let coordinate = |i: usize| {
        let c = dir[(axis + i) % 3] * scale + 0.5 * grid as f64;
        (c as usize).min(grid - 1)
    };
    (face * grid + coordinate(1)) * grid + coordinate(2)
}

/// The middle of a cell.
fn cell_direction(grid: usize, cell: usize) -> DVec3 {
    let (face, u, v) = (cell / (grid * grid), cell / grid % grid, cell % grid);
    let middle = |i: usize| (2 * i + 1) as f64 / grid as f64 - 1.0;
    let axis = face / 2;
    let mut dir = DVec3::ZERO;
    dir[axis] = if face % 2 == 0 { 1.0 } else { -1.0 };
    dir[(axis + 1) % 3] = middle(u);
    dir[(axis + 2) % 3] = middle(v);
    dir
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_holds_its_own_middle() {
        for grid in 1..=FINEST {
            for cell in 0..6 * grid * grid {
                assert_eq!(cell_of(grid, cell_direction(grid, cell) * 3.0), cell);
            }
        }
    }

    #[test]
    fn no_direction_is_outside_of_the_table() {
        for dir in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, -DVec3::INFINITY] {
            assert!(cell_of(4, dir) < 6 * 16);
        }
    }
}
