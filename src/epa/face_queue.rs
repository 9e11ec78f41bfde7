//! The faces of the expanding polytope, ordered by signed distance from the origin.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A heap of faces. Those that left the polytope stay until they are the nearest.
#[derive(Clone, Debug, Default)]
pub(super) struct FaceQueue(BinaryHeap<Candidate>);

impl FaceQueue {
    pub fn clear(&mut self) {
        self.0.clear();
    }

    pub fn push(&mut self, distance: f64, face: u32) {
        self.0.push(Candidate { distance, face });
    }

    pub fn nearest(&self) -> Option<u32> {
        self.0.peek().map(|nearest| nearest.face)
    }

    /// Removes the nearest face.
    pub fn pop(&mut self) {
        self.0.pop();
    }
}

/// A heap entry. The greatest is the nearest face; of equally near faces, the oldest.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    distance: f64,
    face: u32,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Candidate {}
impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        other
            .distance
            .total_cmp(&self.distance)
            .then(other.face.cmp(&self.face))
    }
}
