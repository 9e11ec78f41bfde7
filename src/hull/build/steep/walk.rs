//! The walks around the vertices, which find the edge graph.

use super::builder::SteepBuilder;
use crate::hull::build::adjacency::{Spoke, row};
use crate::hull::build::graph::{GraphBuilder, Neighbor};
use crate::hull::faces::HAS_SIMILAR_NEIGHBOR;
use crate::hull::graph::EdgeGraph;
use crate::tolerance::{CLUSTER_ANGLE_COS, NEARLY_FLAT_COS, STEEP_EDGE};

impl SteepBuilder {
    /// The neighbours of all vertices. `None` if an edge is not steep, or has not got two triangles.
    pub fn walk_around_all(&mut self, count: usize, radius: f64) -> Option<EdgeGraph> {
        let mut graph = GraphBuilder::new(count);
        for vertex in (0..).take(count) {
            self.walk_around(vertex, STEEP_EDGE * radius)?;
            graph.push(&self.around);
        }
        Some(graph.finish())
    }

    /// Lists the neighbours of a vertex, clockwise seen from outside, from the lowest on.
    #[inline]
    fn walk_around(&mut self, from: u32, least: f64) -> Option<()> {
        self.around.clear();
        let (lowest, count) = self.matrix.neighbors(from);
        let mut to = lowest;
        for (slot, left_over) in (0..).zip((0..count).rev()) {
            let spoke = self.matrix.spoke(from, to);
            let [left, right] = spoke.sides();
            let [face, other] = [self.matrix.face_of(left), self.matrix.face_of(right)];
            self.around.push(Neighbor {
                to: to as u16,
                left: face.into(),
            });
            if to > from {
                self.matrix.set_slot(&spoke, slot);
                if face != other {
                    self.is_steep(from, &spoke, least).then_some(())?;
                    self.mark_similar_neighbors(&spoke);
                }
                self.matrix.has(to, from).then_some(())?;
            }
            to = spoke.next;
            // Otherwise there are other triangles at this vertex.
            if to == lowest && left_over > 0 {
                return None;
            }
        }
        (to == lowest && count > 0).then_some(())
    }

    /// Whether the surface bends clearly at an edge. The two diagonals of its triangles span at most both areas.
    #[inline]
    fn is_steep(&self, from: u32, spoke: &Spoke, least: f64) -> bool {
        let [left, right] = spoke.sides();
        let across = self.points[row(spoke.next)] - self.points[row(from)];
        let area = self.areas[left].length + self.areas[right].length;
        -self.areas[left].vector.dot(across) > least * area
    }

    /// Marks the faces on the sides of an edge if they have about the same direction.
    #[inline]
    fn mark_similar_neighbors(&mut self, spoke: &Spoke) {
        let [left, right] = spoke.sides();
        let (here, there) = (&self.areas[left], &self.areas[right]);
        // The normal of a polygon is not that of its triangles.
        if self.has_polygons
            || here.vector.dot(there.vector) >= NEARLY_FLAT_COS * here.length * there.length
        {
            self.mark_if_similar([left, right]);
        }
    }

    #[inline(never)]
    fn mark_if_similar(&mut self, triangles: [usize; 2]) {
        let [left, right] = triangles.map(|t| usize::from(self.matrix.face_of(t)));
        let normal = |face: usize| self.planes[face].normal.as_dvec3();
        if normal(left).dot(normal(right)) >= CLUSTER_ANGLE_COS {
            self.planes[left].first |= HAS_SIMILAR_NEIGHBOR;
            self.planes[right].first |= HAS_SIMILAR_NEIGHBOR;
        }
    }
}
