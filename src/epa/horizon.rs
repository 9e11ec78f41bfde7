//! How the expanding polytope expands: the faces that a new vertex sees give way to a cone from their horizon to it.

use glam::DVec3;

use super::polytope::{ExpandingPolytope, Face, FaceEdge, NEXT, face_edge, face_of, number};
use crate::at::At;
use crate::support::CsoVertex;

impl ExpandingPolytope {
    /// Expands the polytope to a given point of the difference, if that is outside.
    pub fn insert_if_outside(&mut self, vertex: &CsoVertex) {
        let is_outside =
            |(face, _): &(&Face, u32)| face.alive && face.height(vertex.w) > self.coplanar;
        let found = self.faces.iter().zip(0..).find(is_outside);
        if let Some((_, face)) = found {
            self.expand(face, *vertex);
        }
    }

    /// Replaces all faces that see `vertex` by a cone from their horizon to it. If rounding leaves no proper
    /// horizon, returns `false` and changes nothing.
    pub fn expand(&mut self, face: u32, vertex: CsoVertex) -> bool {
        self.find_horizon(face, vertex.w);
        if !self.horizon_is_closed() {
            for f in self.visible.drain(..) {
                self.faces.at_mut(f).alive = true;
            }
            return false;
        }
        let apex = self.vertices.short_len();
        self.vertices.push(vertex);
        let first = self.faces.short_len();
        let last = first + self.horizon.short_len() - 1;
        for (i, new) in (first..=last).enumerate() {
            let outside = self.horizon[i];
            let [a, b] = self.edge_corners(outside);
            let next = if new == last { first } else { new + 1 };
            let previous = if new == first { last } else { new - 1 };
            // As seen from the new face, the shared edge runs the other way.
            let across = [outside, face_edge(next, 2), face_edge(previous, 1)];
            self.add([b, a, apex], across);
            self.faces.at_mut(face_of(outside)).across[number(outside)] = face_edge(new, 0);
        }
        true
    }

    /// The corners where an edge starts and ends, in its own face's sense.
    fn edge_corners(&self, edge: FaceEdge) -> [u32; 2] {
        let corners = self.faces.at_ref(face_of(edge)).corners;
        let k = number(edge);
        [corners[k], corners[NEXT[k]]]
    }

    /// Collects the edges around the faces that are visible from `w`, in order, each as the remaining face sees it.
    /// Marks the visible faces as dead.
    fn find_horizon(&mut self, face: u32, w: DVec3) {
        self.horizon.clear();
        self.visible.clear();
        self.stack.clear();
        self.kill(face);
        for k in (0..3).rev() {
            self.stack.push(self.faces.at_ref(face).across[k]);
        }
        while let Some(edge) = self.stack.pop() {
            let f = self.faces.at_ref(face_of(edge));
            if !f.alive {
                continue;
            }
            if f.height(w) <= -self.coplanar {
                self.horizon.push(edge);
                continue;
            }
            let across = f.across;
            self.kill(face_of(edge));
            let k = NEXT[number(edge)];
            self.stack.push(across[NEXT[k]]);
            self.stack.push(across[k]);
        }
    }

    fn kill(&mut self, face: u32) {
        self.faces.at_mut(face).alive = false;
        self.visible.push(face);
    }

    /// Whether the horizon is one closed loop through distinct vertices.
    fn horizon_is_closed(&self) -> bool {
        let Some(&last) = self.horizon.last() else {
            return false;
        };
        // As seen from outside the visible region, the loop runs backwards.
        let [mut before, _] = self.edge_corners(last);
        self.horizon.len() >= 3
            && self.horizon.iter().all(|&edge| {
                let [start, end] = self.edge_corners(edge);
                let follows = end == before;
                before = start;
                follows
            })
    }
}
