//! The patch of a curved shape on a half-space.

use glam::DVec3;

use super::patch::{Found, Patch};
use super::piece::{FlatSide, Outline, Piece};
use super::surface_pieces::SurfacePieces;
use crate::pose::RelativePose;
use crate::stats::Cost;
use crate::tuning::WIDE_PLANE;

impl Patch {
    /// Finds the places of the second shape over the plane through the origin with this unit normal, in frame 1.
    /// Returns the deepest point of the second shape.
    pub fn find_on_plane(
        &mut self,
        normal: DVec3,
        solid: &impl SurfacePieces,
        pose: &RelativePose,
        border: f64,
    ) -> DVec3 {
        let towards = -pose.direction_to_2(normal);
        let start = solid.start_vertex(towards);
        let (deepest, vertex) = solid.support(towards, start, &mut Cost::default());
        let (center, radius) = (pose.point_to_1(solid.center()), solid.radius() + border);
        let plane = FlatSide {
            normal,
            offset: 0.0,
            outline: Outline::Disc {
                center: center - normal * normal.dot(center),
                radius: WIDE_PLANE * radius,
            },
        };
        self.aim_along(normal);
        self.places.clear();
        self.guesses = 0;
        let [_, corners] = &mut self.corners;
        corners.clear();
        let piece = solid.piece(towards, vertex, border, corners);
        self.pieces = [Piece::Flat(plane), piece.to_frame_1(pose, corners)];
        self.references = [normal.any_orthonormal_vector(), DVec3::ZERO];
        self.border_radii = [0.0, border];
        self.size = radius + center.length();
        self.add_common();
        self.found = Found::All;
        pose.point_to_1(deepest) - normal * border
    }
}
