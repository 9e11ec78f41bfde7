//! Bodies at rest: what their contacts lay on proves the answer without a patch.

use glam::DVec3;

use super::query::{CurvedAnswer, CurvedQuery};
use super::surface_pieces::SurfacePieces;
use crate::tuning::STILL;

/// The signed distance of cores, proved up to the tolerance.
pub(super) struct AtRest {
    pub signed_distance: f64,
    /// From shape 1 to shape 2.
    pub normal: DVec3,
    /// Where they are nearest or overlap most: on shape 1.
    pub on_1: DVec3,
}

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// The answer by the flat or ruled sides that gave the last normals, if the contacts hardly moved. The normals
    /// are outward, each in the frame of its shape.
    pub(super) fn at_rest(&mut self, normals: [DVec3; 2]) -> Option<CurvedAnswer> {
        let last = self.last?;
        if !last.are_within(normals[0], STILL * self.cso.min_radius()) {
            return None;
        }
        let AtRest {
            signed_distance,
            normal,
            on_1,
        } = self.on_sides(last, normals)?;
        if signed_distance > self.max_distance {
            return None;
        }
        self.scratch.patch.aim_along(normal);
        Some(CurvedAnswer::Near {
            signed_distance,
            normal,
            on_1: on_1 + normal * self.border_radii[0],
        })
    }
}
