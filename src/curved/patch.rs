//! The contact patch: where two pieces of surface overlap, seen along a normal.

use std::ops::RangeInclusive;

use glam::DVec3;

use super::outline::Flat;
use super::piece::{Outline, Piece};
use super::place::{PiecePoint, Spot};
use super::surface_pieces::SurfacePieces;
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, VertexId};
use crate::tolerance::SAME_GAP;

pub use super::place::ContactPlace;

/// The pieces of both surfaces along a normal, and the places where both meet. In frame 1.
#[derive(Clone, Debug)]
pub struct Patch {
    pub(super) pieces: [Piece; 2],
    pub(super) corners: [Vec<(DVec3, VertexId)>; 2],
    pub(super) places: Vec<ContactPlace>,
    normal: DVec3,
    border_radii: [f64; 2],
    /// Directions in the planes of flat sides that are fixed in the frames of their shapes.
    references: [DVec3; 2],
    /// The length to which rounding errors are relative.
    size: f64,
    pub(super) extreme: CsoVertex,
    found: Found,
    /// The number of places that come from the previous contacts. They only serve as proofs.
    guesses: usize,
}

/// How much of a patch is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Found {
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

    /// Finds the pieces of the cores.
    pub(super) fn find_cores<A: SurfacePieces, B: SurfacePieces>(&mut self, cso: &Cso<'_, A, B>) {
        self.find_pieces(cso, [0.0; 2]);
        self.found = Found::Pieces;
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

    /// Finds the places along `normal`.
    pub fn find<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        border_radii: [f64; 2],
    ) {
        self.aim_along(normal);
        self.complete(cso, border_radii);
    }

    /// Finds all places along the normal of the last answer, unless they are known. The deepest place of
    /// rounded shapes is that of their cores, moved along the contact normal. The other places lie on pieces
    /// that are moved along their own normals.
    pub fn complete<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        cso: &Cso<'_, A, B>,
        border_radii: [f64; 2],
    ) {
        if self.found == Found::All {
            return;
        }
        if self.found == Found::Normal {
            let start = cso.start_vertices(self.normal);
            let extreme = cso.support(self.normal, start, &mut Cost::default());
            self.aim(self.normal, &extreme);
        }
        if self.found == Found::Extreme {
            self.find_cores(cso);
        }
        if self.found == Found::Pieces {
            self.find_extremes();
        }
        self.places.drain(..self.guesses);
        self.guesses = 0;
        self.add_common_first();
        if border_radii != [0.0; 2] {
            self.find_around_cores(cso, border_radii);
        }
        self.found = Found::All;
    }

    fn find_around_cores<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        cso: &Cso<'_, A, B>,
        border_radii: [f64; 2],
    ) {
        let normal = self.normal;
        let separation = -normal.dot(self.extreme.w);
        let limit = separation + SAME_GAP * cso.min_radius();
        let deepest = self
            .deepest()
            .filter(|place| place.distance <= limit)
            .copied();
        self.places.clear();
        self.find_pieces(cso, border_radii);
        self.add_common();
        self.add_extremes();
        if let Some(core) = deepest {
            self.places.push(ContactPlace {
                on_1: core.on_1 + normal * border_radii[0],
                on_2: core.on_2 - normal * border_radii[1],
                distance: core.distance - self.borders(),
                features: [Spot::Extreme(VertexId::default()).feature(); 2],
            });
        }
    }

    fn find_pieces<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        cso: &Cso<'_, A, B>,
        border_radii: [f64; 2],
    ) {
        let [corners_1, corners_2] = &mut self.corners;
        corners_1.clear();
        corners_2.clear();
        let outward_2 = -cso.pose.direction_to_2(self.normal);
        let [id_1, id_2] = self.extreme.ids;
        let piece_1 = cso
            .shape_1
            .piece(self.normal, id_1, border_radii[0], corners_1);
        let piece_2 = cso
            .shape_2
            .piece(outward_2, id_2, border_radii[1], corners_2);
        let reference = |piece: &Piece| match piece {
            Piece::Flat(flat) => flat.normal.any_orthonormal_vector(),
            _ => DVec3::ZERO,
        };
        self.references = [
            reference(&piece_1),
            cso.pose.direction_to_1(reference(&piece_2)),
        ];
        for (corner, _) in &mut *corners_2 {
            *corner = cso.pose.point_to_1(*corner);
        }
        self.pieces = [piece_1, piece_2.to_frame_1(cso.pose)];
        self.border_radii = border_radii;
        self.size = cso.size() + cso.center().length();
    }

    /// [`add_common`](Self::add_common), with the new places before those already known.
    fn add_common_first(&mut self) {
        let extremes = self.places.len();
        self.add_common();
        self.places.rotate_left(extremes);
    }

    /// Drops the places whose distance is not in `range`.
    pub fn retain(&mut self, range: RangeInclusive<f64>) {
        self.places.retain(|place| range.contains(&place.distance));
    }

    /// The point of the first shape where the gap is narrowest, and its width.
    pub fn deepest_point(&self) -> Option<(DVec3, f64)> {
        self.deepest().map(|place| (place.on_1, place.distance))
    }

    /// A direction in the plane of a flat side that is fixed in the frame of its shape.
    pub(super) fn reference(&self, side: usize) -> DVec3 {
        self.references[side]
    }

    /// The length to which rounding errors are relative.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    pub(super) fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The direction of the normal that points out of the shape `side`.
    pub(super) fn outward(&self, side: usize) -> DVec3 {
        if side == 0 { self.normal } else { -self.normal }
    }

    pub(super) fn border(&self, side: usize) -> f64 {
        self.border_radii[side]
    }

    /// The heights of the borders above the extreme points of the cores, along the normal.
    pub(super) fn border_heights(&self) -> [f64; 2] {
        [self.border_radii[0], -self.border_radii[1]]
    }

    /// The sum of the widths of both borders.
    pub(super) fn borders(&self) -> f64 {
        self.border_radii[0] + self.border_radii[1]
    }

    pub(super) fn flat(&self, side: usize) -> Option<Flat<'_>> {
        match &self.pieces[side] {
            Piece::Flat(flat) => Some(Flat {
                side: flat,
                corners: &self.corners[side],
                along: self.normal,
            }),
            _ => None,
        }
    }

    /// Adds the places where whole pieces overlap.
    fn add_common(&mut self) {
        match self.pieces {
            [Piece::Flat(a), Piece::Flat(b)] => {
                let circles = [&a, &b].map(|flat| match flat.outline {
                    Outline::Disc { center, radius } => Some((center, radius)),
                    Outline::Polygon(_) => None,
                });
                match circles {
                    [Some(first), Some(second)] => self.add_two_discs([&a, &b], [first, second]),
                    [Some(circle), None] => self.add_disc(0, &a, circle, true),
                    [None, Some(circle)] => self.add_disc(1, &b, circle, true),
                    [None, None] => {}
                }
            }
            [Piece::Flat(_), Piece::Line(line)] => self.add_line(1, &line),
            [Piece::Line(line), Piece::Flat(_)] => self.add_line(0, &line),
            [Piece::Line(a), Piece::Line(b)] => self.add_two_lines([&a, &b]),
            _ => {}
        }
    }
}
