//! Proofs of a signed distance: the support planes along its normal bound it from below, the patch from above.

use glam::DVec3;

use super::outline::Flat;
use super::patch::{ContactPlace, Patch};
use super::piece::{Generator, Piece};
use super::surface_pieces::SurfacePieces;
use crate::query::{Feature, cone_contains_ball};
use crate::support::Cso;
use crate::tolerance::SAME_NORMAL;

impl Patch {
    /// The place with the narrowest gap, if it proves that the signed distance of the cores is at most
    /// `separation`, up to `tolerance`. `separation` is the distance of their support planes along the
    /// normal.
    ///
    /// If the cores are apart, two of their points bound the distance. If they overlap, a ball inside the
    /// difference bounds the depth: it lies under a disc in the difference, or it is the sum of balls inside
    /// both cores that touch their surfaces at a place of contact.
    pub(super) fn proved<A: SurfacePieces, B: SurfacePieces>(
        &self,
        cso: &Cso<'_, A, B>,
        separation: f64,
        tolerance: f64,
    ) -> Option<&ContactPlace> {
        let nearest = self.deepest()?;
        self.proves(cso, nearest, separation, tolerance)
            .then_some(nearest)
    }

    fn proves<A: SurfacePieces, B: SurfacePieces>(
        &self,
        cso: &Cso<'_, A, B>,
        nearest: &ContactPlace,
        separation: f64,
        tolerance: f64,
    ) -> bool {
        let wanted = separation - self.borders();
        if nearest.distance - wanted > tolerance {
            return false;
        }
        if separation > 0.0 {
            let [p1, p2] = self.core_points(nearest);
            return p1.distance(p2) <= separation + tolerance;
        }
        let place = self.middle(wanted + tolerance);
        let depth = (-separation - tolerance).max(0.0);
        let balls: f64 = (0..2).map(|shape| self.ball(shape, place[shape])).sum();
        balls >= depth
            || (0..2).any(|shape| {
                let inset = self.disc(shape, place[shape]);
                cone_contains_ball(inset, depth, cso.center(), self.normal())
            })
    }

    /// The place with the narrowest gap.
    pub(super) fn deepest(&self) -> Option<&ContactPlace> {
        let mut places = self.places.iter();
        let first = places.next()?;
        Some(places.fold(first, |deepest, other| {
            if other.distance < deepest.distance {
                other
            } else {
                deepest
            }
        }))
    }

    /// The mean of all places with at most this distance, on both surfaces.
    fn middle(&self, distance: f64) -> [DVec3; 2] {
        let near = self
            .places
            .iter()
            .filter(|place| place.distance <= distance);
        let (mut sum, mut count) = ([DVec3::ZERO; 2], 0.0);
        for place in near {
            sum = [sum[0] + place.on_1, sum[1] + place.on_2];
            count += 1.0;
        }
        sum.map(|sum| sum / count)
    }

    /// The points of the cores from which the borders reach the place.
    fn core_points(&self, place: &ContactPlace) -> [DVec3; 2] {
        let points = [place.on_1, place.on_2];
        [0, 1].map(|shape| {
            let border = self.border(shape);
            let normal = match (&self.pieces[shape], place.features[shape]) {
                (Piece::Point(_), _) | (_, Feature::Vertex(_)) => self.outward(shape),
                (Piece::Flat(flat), _) => flat.normal,
                (Piece::Line(line), _) => line.surface.normal_at(points[shape]),
            };
            points[shape] - normal * border
        })
    }

    /// The radius of a ball inside a core that touches the surface at a point of a line.
    fn ball(&self, shape: usize, at: DVec3) -> f64 {
        let Piece::Line(Generator {
            ends,
            surface,
            ball,
            ..
        }) = &self.pieces[shape]
        else {
            return 0.0;
        };
        if (self.outward(shape).dot(surface.axis) - surface.sine()).abs() > SAME_NORMAL {
            return 0.0;
        }
        let [low, high] = ends.map(|end| end.dot(surface.axis));
        let share = (at.dot(surface.axis) - low) / (high - low);
        ball.radius(share.clamp(0.0, 1.0))
    }

    /// The radius of a disc around a point of a flat side that is perpendicular to the normal.
    fn disc(&self, shape: usize, at: DVec3) -> f64 {
        let Some(flat @ Flat { side: face, .. }) = self.flat(shape) else {
            return 0.0;
        };
        if face.normal.distance(self.outward(shape)) > SAME_NORMAL {
            return 0.0;
        }
        flat.inset(at).unwrap_or(0.0)
    }
}
