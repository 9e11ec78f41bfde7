//! How extreme vertices are found.

use glam::DVec3;

use super::scan::Scan;
use super::start_table::StartTable;
use crate::support::VertexId;

#[derive(Clone, Debug)]
pub(super) enum SupportSearch {
    /// A small hull: look at every vertex.
    Scan(Scan),
    /// A large hull: climb from a start vertex.
    Climb(StartTable),
}

impl SupportSearch {
    pub fn heap_bytes(&self) -> usize {
        match self {
            Self::Scan(scan) => scan.heap_bytes(),
            Self::Climb(start) => start.heap_bytes(),
        }
    }

    /// A vertex from which it is not far to the extreme one.
    #[inline]
    pub fn start_vertex(&self, dir: DVec3) -> VertexId {
        match self {
            Self::Scan(_) => VertexId::default(),
            Self::Climb(start) => start.lookup(dir),
        }
    }
}
