//! The contact patch: where two pieces of surface overlap, seen along a normal.

use std::ops::RangeInclusive;

use glam::DVec3;

use super::outline::Flat;
use super::piece::Piece;
use super::place::{PiecePoint, Spot};
use crate::query::Feature;
use crate::support::{CsoVertex, VertexId};

pub use super::place::ContactPlace;

/// The pieces of both surfaces along a normal, and the places where both meet. In frame 1.
#[derive(Clone, Debug)]
pub struct Patch {
    pub(super) pieces: [Piece; 2],
    pub(super) corners: [Vec<(DVec3, VertexId)>; 2],
    pub(super) places: Vec<ContactPlace>,
    pub(super) normal: DVec3,
    pub(super) border_radii: [f64; 2],
    /// Directions in the planes of flat sides that are fixed in the frames of their shapes.
    pub(super) references: [DVec3; 2],
    /// The length to which rounding errors are relative.
    pub(super) size: f64,
    pub(super) extreme: CsoVertex,
    pub(super) found: Found,
    /// The number of places that come from the previous contacts. They only serve as proofs.
    pub(super) guesses: usize,
}

/// How much of a patch is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// Only its normal is known.
    Normal,
    /// And the extreme points along it.
    Extreme,
    /// And the pieces without borders.
    Pieces,
    /// And the extreme points that are over both pieces.
    Extremes,
    /// All places.
    All,
}

impl Default for Patch {
    fn default() -> Self {
        Self {
            pieces: [Piece::Point(DVec3::ZERO); 2],
            corners: [Vec::new(), Vec::new()],
            places: Vec::new(),
            normal: DVec3::Z,
            border_radii: [0.0; 2],
            references: [DVec3::X; 2],
            size: 0.0,
            extreme: CsoVertex::default(),
            found: Found::Normal,
            guesses: 0,
        }
    }
}

impl Patch {
    /// Starts a new patch along `normal`, with `extreme` as its extreme vertex.
    pub(super) fn aim(&mut self, normal: DVec3, extreme: &CsoVertex) {
        self.places.clear();
        self.normal = normal;
        self.extreme = *extreme;
        self.found = Found::Extreme;
        self.guesses = 0;
    }

    /// Starts a new patch along `normal`, with nothing else known.
    pub(super) fn aim_along(&mut self, normal: DVec3) {
        self.normal = normal;
        self.found = Found::Normal;
    }

    /// Adds a point of the first shape as a place for proofs only, if it is over both pieces.
    pub(super) fn add_guess(&mut self, at: DVec3) {
        if let (Some(first), Some(second)) = (self.height_over(0, at), self.height_over(1, at)) {
            let spots = [Spot::Inside; 2];
            self.push(PiecePoint { at, spots }, [first, second]);
        }
        self.guesses = self.places.len();
    }

    /// Adds the extreme points that are over both pieces. They suffice for most proofs.
    pub(super) fn find_extremes(&mut self) {
        self.add_extremes();
        self.found = Found::Extremes;
    }

    /// Drops the places whose distance is not in `range`.
    pub fn retain(&mut self, range: RangeInclusive<f64>) {
        self.places.retain(|place| range.contains(&place.distance));
    }

    /// Leaves out corners of a flat side beside the line of a ruled surface: the ends of the line are the deepest
    /// places over the side. Along a corrected normal, a corner that the line does not reach is beside the lowest
    /// line of what rolls towards it.
    pub fn leave_out_corners_beside_lines(&mut self) {
        let side = match self.pieces {
            [Piece::Flat(_), Piece::Line(_)] => 0,
            [Piece::Line(_), Piece::Flat(_)] => 1,
            _ => return,
        };
        let is_corner = |place: &ContactPlace| matches!(place.features[side], Feature::Vertex(_));
        self.places.retain(|place| !is_corner(place));
    }

    /// The point of the first shape where the gap is narrowest, and its width.
    pub fn deepest_point(&self) -> Option<(DVec3, f64)> {
        self.deepest().map(|place| (place.on_1, place.distance))
    }

    /// Whether both pieces are polygons.
    pub(super) fn is_of_polygons(&self) -> bool {
        let is_polygon =
            |piece: &Piece| matches!(piece, Piece::Flat(flat) if flat.outline.circle().is_none());
        self.pieces.iter().all(is_polygon)
    }

    /// A direction in the plane of a flat side that is fixed in the frame of its shape.
    pub(super) fn reference(&self, shape: usize) -> DVec3 {
        self.references[shape]
    }

    /// The length to which rounding errors are relative.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    pub(super) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The direction of the normal that points out of a shape.
    pub(super) fn outward(&self, shape: usize) -> DVec3 {
        if shape == 0 {
            self.normal
        } else {
            -self.normal
        }
    }

    pub(super) fn border(&self, shape: usize) -> f64 {
        self.border_radii[shape]
    }

    /// The heights of the borders above the extreme points of the cores, along the normal.
    pub(super) fn border_heights(&self) -> [f64; 2] {
        [self.border_radii[0], -self.border_radii[1]]
    }

    /// The sum of the widths of both borders.
    pub(super) fn borders(&self) -> f64 {
        self.border_radii[0] + self.border_radii[1]
    }

    pub(super) fn flat(&self, shape: usize) -> Option<Flat<'_>> {
        match &self.pieces[shape] {
            Piece::Flat(flat) => Some(Flat {
                side: flat,
                corners: &self.corners[shape],
                along: self.normal,
            }),
            _ => None,
        }
    }
}
