//! Points over both pieces of a patch.

use glam::DVec3;

use super::patch::Patch;
use super::piece::Piece;
use super::place::{ContactPlace, PiecePoint, Spot, by_shape};
use crate::tolerance::ON_OUTLINE;

impl Patch {
    /// Adds the extreme points of the cores, moved along the normal, if they are over the other piece. Where two lines
    /// cross, both surfaces are nearest although neither is extreme.
    pub(super) fn add_extremes(&mut self) {
        let extreme = self.extreme;
        let cores = [extreme.on_1, extreme.on_2()];
        for (shape, at) in cores.into_iter().enumerate() {
            let spot = Spot::Extreme(extreme.ids[shape]);
            let candidate = PiecePoint {
                at,
                spots: by_shape(shape, [spot, Spot::Inside]),
            };
            let mine = self.border_heights()[shape];
            if let Some(other) = self.height_over(1 - shape, at) {
                self.push(candidate, by_shape(shape, [mine, other]));
            }
        }
        if let [Piece::Line(first), Piece::Line(second)] = self.pieces {
            self.add_crossing([&first, &second]);
        }
    }

    /// The distance along the normal from a point to a piece, if the point is over the piece.
    pub(super) fn height_over(&self, shape: usize, p: DVec3) -> Option<f64> {
        match &self.pieces[shape] {
            Piece::Flat(_) => self.flat(shape)?.height_if_over(p),
            Piece::Line(line) => {
                let outward = self.outward(shape);
                let height = line.exit(p, outward)?;
                let at = p + outward * height;
                let [low, high] = line.ends.map(|end| line.surface.axis.dot(end - at));
                let is_between = low.min(high) <= ON_OUTLINE * self.size()
                    && low.max(high) >= -ON_OUTLINE * self.size();
                is_between.then(|| self.normal().dot(at - p))
            }
            Piece::Point(core) => {
                let height = self.normal().dot(*core - p);
                let aside = (*core - p - self.normal() * height).length();
                (aside <= ON_OUTLINE * self.size()).then(|| height + self.border_heights()[shape])
            }
        }
    }

    pub(super) fn push(&mut self, candidate: PiecePoint, heights: [f64; 2]) {
        let place = ContactPlace {
            on_1: candidate.at + self.normal() * heights[0],
            on_2: candidate.at + self.normal() * heights[1],
            distance: heights[1] - heights[0],
            features: candidate.spots.map(Spot::feature),
        };
        if place.distance.is_finite() {
            self.places.push(place);
        }
    }

    /// Adds a point of one piece, if it is over the other one.
    pub(super) fn push_over(&mut self, shape: usize, candidate: PiecePoint) {
        if let Some(height) = self.height_over(1 - shape, candidate.at) {
            self.push(candidate, by_shape(shape, [0.0, height]));
        }
    }
}
