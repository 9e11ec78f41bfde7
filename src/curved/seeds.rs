//! Points of the Minkowski difference at which the search for the depth starts.

use glam::DVec3;

use super::patch::Patch;
use super::piece::{FlatSide, Outline, Piece};
use crate::support::{CsoVertex, VertexId};

impl Patch {
    /// Corners of each piece minus the extreme point of the other shape. They outline the surface of the
    /// difference along the normal.
    pub(super) fn outline_differences(&self, differences: &mut Vec<CsoVertex>) {
        differences.clear();
        for shape in 0..2 {
            let id = self.extreme.ids[shape];
            match &self.pieces[shape] {
                Piece::Flat(FlatSide {
                    normal,
                    outline: Outline::Disc { center, radius },
                    ..
                }) => {
                    let (u, v) = normal.any_orthonormal_pair();
                    let rim = [u, v, -u, -v].map(|outward| *center + outward * *radius);
                    differences.extend(rim.map(|at| self.difference(shape, at, id)));
                }
                Piece::Flat(_) => {
                    let corners = self.corners[shape].iter();
                    differences.extend(corners.map(|(at, id)| self.difference(shape, *at, *id)));
                }
                Piece::Line(line) => {
                    differences.extend(line.ends.map(|at| self.difference(shape, at, id)));
                }
                Piece::Point(_) => {}
            }
        }
    }

    /// A point of one shape minus the extreme point of the other.
    fn difference(&self, shape: usize, at: DVec3, id: VertexId) -> CsoVertex {
        let extreme = &self.extreme;
        if shape == 0 {
            CsoVertex {
                w: at - extreme.on_2(),
                on_1: at,
                ids: [id, extreme.ids[1]],
            }
        } else {
            CsoVertex {
                w: extreme.on_1 - at,
                on_1: extreme.on_1,
                ids: [extreme.ids[0], id],
            }
        }
    }
}
