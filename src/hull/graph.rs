//! The edge graph of a triangulated hull in compressed rows.

use super::HullError;
use crate::support::VertexId;

/// Compressed sparse rows: the neighbours of vertex `v` are `targets[first[v]..first[v + 1]]`,
/// and the position of a neighbour names the directed edge to it.
#[derive(Clone, Debug)]
pub(super) struct EdgeGraph {
    first: Box<[u32]>,
    targets: Box<[u16]>,
}

impl EdgeGraph {
    /// From triangles, counter-clockwise seen from outside, over `count` vertices.
    pub fn new(count: usize, triangles: &[[u32; 3]]) -> Result<Self, HullError> {
        let mut first = vec![0_u32; count + 1];
        for triangle in triangles {
            for &v in triangle {
                first[v as usize + 1] += 1;
            }
        }
        if let Some(v) = first[1..].iter().position(|&degree| degree == 0) {
            return Err(HullError::LooseVertex(v));
        }
        for v in 0..count {
            first[v + 1] += first[v];
        }
        let mut targets = vec![0_u16; triangles.len() * 3];
        let mut fill = first.clone();
        for triangle in triangles {
            for k in 0..3 {
                let slot = &mut fill[triangle[k] as usize];
                targets[*slot as usize] = triangle[(k + 1) % 3] as u16;
                *slot += 1;
            }
        }
        let graph = Self {
            first: first.into(),
            targets: targets.into(),
        };
        graph.require_manifold(count)?;
        Ok(graph)
    }

    /// Every directed edge is there once and has its reverse, and the surface is a sphere.
    fn require_manifold(&self, count: usize) -> Result<(), HullError> {
        for v in 0..count as u32 {
            let around = self.neighbors(v);
            for (i, &w) in around.iter().enumerate() {
                if around[..i].contains(&w) || self.edge_id(w.into(), v).is_none() {
                    return Err(HullError::NotManifold);
                }
            }
        }
        let (edges, faces) = (self.targets.len() / 2, self.targets.len() / 3);
        let connected = self.reachable(count) == count;
        if connected && count + faces == edges + 2 {
            Ok(())
        } else {
            Err(HullError::NotManifold)
        }
    }

    fn reachable(&self, count: usize) -> usize {
        let mut seen = vec![false; count];
        let mut stack = vec![0_u32];
        seen[0] = true;
        let mut reached = 0;
        while let Some(v) = stack.pop() {
            reached += 1;
            for &w in self.neighbors(v) {
                if !std::mem::replace(&mut seen[w as usize], true) {
                    stack.push(w.into());
                }
            }
        }
        reached
    }

    #[inline]
    pub fn neighbors(&self, vertex: VertexId) -> &[u16] {
        let v = vertex as usize;
        &self.targets[self.first[v] as usize..self.first[v + 1] as usize]
    }

    /// The name of the directed edge, the same for both directions: that from the lower vertex.
    pub fn edge_id(&self, from: VertexId, to: VertexId) -> Option<u32> {
        let (low, high) = (from.min(to), from.max(to));
        let i = self
            .neighbors(low)
            .iter()
            .position(|&w| VertexId::from(w) == high)?;
        Some(self.first[low as usize] + i as u32)
    }

    /// The end vertices of an edge.
    pub fn edge(&self, id: u32) -> Option<[VertexId; 2]> {
        let to = *self.targets.get(id as usize)?;
        let from = self.first.partition_point(|&first| first <= id) - 1;
        Some([from as VertexId, to.into()])
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.first) + size_of_val(&*self.targets)
    }
}
