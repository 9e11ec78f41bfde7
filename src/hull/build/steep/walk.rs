//! The walks around the vertices, which find the edge graph.

use super::around::{EDGES, EdgeBetweenFaces};
use super::builder::SteepBuilder;
use crate::hull::build::adjacency::{VERTICES, index, row};
use crate::hull::build::graph::GraphBuilder;
use crate::hull::faces::HAS_SIMILAR_NEIGHBOR;
use crate::hull::graph::EdgeGraph;
use crate::tolerance::{CLUSTER_ANGLE_COS, NEARLY_FLAT_COS, STEEP_EDGE};

impl SteepBuilder {
    /// The neighbours of all vertices. `None` if an edge is not steep, or has not got two triangles.
    pub fn walk_around_all(&mut self, count: usize, radius: f64) -> Option<EdgeGraph> {
        let mut graph = GraphBuilder::new(count);
        let (mut spokes, mut edges) = (0, 0);
        for vertex in (0..).take(count) {
            let around = if self.has_polygons {
                self.walk_around::<true>(vertex, &mut edges)?
            } else {
                self.walk_around::<false>(vertex, &mut edges)?
            };
            spokes += around;
            self.around.push_to(&mut graph, around);
        }
        // Otherwise there are other triangles at some vertex, which the walk around it did not reach.
        let are_all = spokes == 3 * self.matrix.triangles().len();
        (are_all && self.are_steep(edges, STEEP_EDGE * radius)).then(|| graph.finish())
    }

    /// Lists the neighbours of a vertex, clockwise seen from outside, from the lowest on, and the edges to the higher
    /// ones. Returns how many neighbours there are. `None` if an edge has not got two triangles.
    #[inline]
    fn walk_around<const MERGED: bool>(&mut self, from: u8, edges: &mut usize) -> Option<usize> {
        let lowest = self.matrix.lowest_neighbor(from);
        let (mut to, mut left) = (lowest, self.matrix.left(from, lowest));
        let mut left_face = self.matrix.face_of(left, MERGED);
        // Unused slots of the first block.
        self.around.fill_block(lowest.into(), left_face.into());
        let mut has_all = true;
        for (slot, place) in (0..).zip(0..VERTICES) {
            has_all &= self.matrix.has(to, from);
            let spoke = self.matrix.spoke(from, to, slot);
            let right_face = self.matrix.face_of(spoke.right, MERGED);
            self.around.to[place] = to.into();
            self.around.left[place] = left_face.into();
            // Which end is higher is not predictable: otherwise the next edge takes its place.
            self.around.edges[*edges % EDGES] = EdgeBetweenFaces {
                from,
                left,
                right: spoke.right,
                right_corner: spoke.next,
            };
            let is_between = to > from && (!MERGED || left_face != right_face);
            *edges += usize::from(is_between);
            (to, left, left_face) = (spoke.next, spoke.right, right_face);
            if to == lowest {
                return has_all.then_some(place + 1);
            }
        }
        None
    }

    /// Whether the surface bends clearly at all edges between faces. The two diagonals of the triangles beside an
    /// edge span at most both areas. Marks the faces beside an edge if they have about the same direction.
    fn are_steep(&mut self, edges: usize, least: f64) -> bool {
        let mut are_steep = true;
        for i in 0..edges % EDGES {
            let edge = self.around.edges[i];
            let (left, right) = (index(edge.left), index(edge.right));
            let across =
                self.points[row(edge.right_corner.into())] - self.points[row(edge.from.into())];
            let [here, there] = [left, right].map(|t| self.areas.vector(t));
            let lengths = [left, right].map(|t| self.areas.length(t));
            // As `Bends` does. No value is NaN here.
            let [one, other] = lengths;
            let longest = if one > other { one } else { other };
            are_steep &= -here.dot(across) > least * longest;
            // The normal of a polygon is not that of its triangles.
            if self.has_polygons || here.dot(there) >= NEARLY_FLAT_COS * lengths[0] * lengths[1] {
                self.mark_if_similar(edge);
            }
        }
        are_steep
    }

    #[inline(never)]
    fn mark_if_similar(&mut self, edge: EdgeBetweenFaces) {
        let [left, right] = [edge.left, edge.right]
            .map(|triangle| index(self.matrix.face_of(triangle, self.has_polygons)));
        let normal = |face: usize| self.planes[face].normal.as_dvec3();
        if normal(left).dot(normal(right)) >= CLUSTER_ANGLE_COS {
            self.planes[left].first |= HAS_SIMILAR_NEIGHBOR;
            self.planes[right].first |= HAS_SIMILAR_NEIGHBOR;
        }
    }
}
