//! The places of a patch, found in steps: most proofs need only the first ones.

use glam::DVec3;

use super::patch::{ContactPlace, Found, Patch};
use super::piece::Piece;
use super::place::Spot;
use super::surface_pieces::SurfacePieces;
use crate::stats::Cost;
use crate::support::{Cso, VertexId};
use crate::tolerance::SAME_GAP;

impl Patch {
    /// Finds the pieces of the cores.
    pub(super) fn find_cores<A: SurfacePieces, B: SurfacePieces>(&mut self, cso: &Cso<'_, A, B>) {
        self.find_pieces(cso, [0.0; 2]);
        self.found = Found::Pieces;
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

    /// Finds the places along the normal of the last answer, without the deepest of rounded shapes: the answer gives it.
    pub fn complete_beside_deepest<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        cso: &Cso<'_, A, B>,
        border_radii: [f64; 2],
    ) {
        if border_radii == [0.0; 2] || self.found == Found::All {
            self.complete(cso, border_radii);
            return;
        }
        self.find_extreme(cso);
        self.places.clear();
        self.find_rounded(cso, border_radii);
        self.found = Found::All;
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
        self.find_extreme(cso);
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

    fn find_extreme<A: SurfacePieces, B: SurfacePieces>(&mut self, cso: &Cso<'_, A, B>) {
        if self.found == Found::Normal {
            let start = cso.start_vertices(self.normal);
            let extreme = cso.support(self.normal, start, &mut Cost::default());
            self.aim(self.normal, &extreme);
        }
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
        self.find_rounded(cso, border_radii);
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

    /// Finds the pieces of shapes with borders, and the places where whole pieces overlap. Sides that are polygons have
    /// round edges: the places of two of them are those of the cores, on the borders over these.
    fn find_rounded<A: SurfacePieces, B: SurfacePieces>(
        &mut self,
        cso: &Cso<'_, A, B>,
        border_radii: [f64; 2],
    ) {
        self.find_pieces(cso, border_radii);
        let outward_2 = -cso.pose.direction_to_2(self.normal);
        if self.is_of_polygons()
            && cso.shape_1.ends_at_edges(self.normal)
            && cso.shape_2.ends_at_edges(outward_2)
        {
            self.find_pieces(cso, [0.0; 2]);
            self.add_common();
            self.lift_onto_borders(border_radii);
            self.find_pieces(cso, border_radii);
        } else {
            self.add_common();
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
        self.pieces = [piece_1, piece_2.to_frame_1(cso.pose, corners_2)];
        self.border_radii = border_radii;
        self.size = cso.size() + cso.center().length();
    }

    /// [`add_common`](Self::add_common), with the new places before those already known.
    fn add_common_first(&mut self) {
        let extremes = self.places.len();
        self.add_common();
        self.places.rotate_left(extremes);
    }

    /// Adds the places where whole pieces overlap.
    pub(super) fn add_common(&mut self) {
        match self.pieces {
            [Piece::Flat(a), Piece::Flat(b)] => match [a, b].map(|flat| flat.outline.circle()) {
                [Some(first), Some(second)] => self.add_two_discs([&a, &b], [first, second]),
                [Some(circle), None] => self.add_disc(0, &a, circle, true),
                [None, Some(circle)] => self.add_disc(1, &b, circle, true),
                [None, None] => self.add_two_polygons(),
            },
            [Piece::Flat(_), Piece::Line(line)] => self.add_line(1, &line),
            [Piece::Line(line), Piece::Flat(_)] => self.add_line(0, &line),
            [Piece::Line(a), Piece::Line(b)] => self.add_beside_crossing([&a, &b]),
            _ => {}
        }
    }
}
