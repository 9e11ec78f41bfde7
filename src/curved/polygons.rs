//! Contacts of polygons with each other.

use std::mem;

use glam::DVec3;

use super::patch::Patch;
use super::place::{PiecePoint, Spot, by_shape};

impl Patch {
    /// The corners of each polygon over the other one, and the points where the outlines cross.
    pub(super) fn add_two_polygons(&mut self) {
        for shape in 0..2 {
            for i in 0..self.corners[shape].len() {
                let (at, id) = self.corners[shape][i];
                let spots = by_shape(shape, [Spot::Corner(id), Spot::Inside]);
                self.push_over(shape, PiecePoint { at, spots });
            }
        }
        let count = self.corners[1].len();
        for i in 0..count {
            let [from, to] = [i, (i + 1) % count].map(|i| self.corners[1][i].0);
            self.add_crossings(i, [from, to]);
        }
    }

    /// Moves the places of the cores along the normal, onto borders of these widths.
    pub(super) fn lift_onto_borders(&mut self, widths: [f64; 2]) {
        let mut places = mem::take(&mut self.places);
        for place in &mut places {
            let height = |shape: usize, point| {
                let flat = self.flat(shape)?;
                let border = flat.border(widths[shape]);
                Some(border.height_over(point, self.outward(shape)))
            };
            let (Some(first), Some(second)) = (height(0, place.on_1), height(1, place.on_2)) else {
                continue;
            };
            place.on_1 += self.normal * first;
            place.on_2 -= self.normal * second;
            place.distance -= first + second;
        }
        self.places = places;
    }

    /// The points where an edge of the second polygon crosses the outline of the first.
    fn add_crossings(&mut self, edge: usize, [from, to]: [DVec3; 2]) {
        let Some(shares) = self.flat(0).and_then(|flat| flat.clip([from, to])) else {
            return;
        };
        for (end, share) in shares.into_iter().enumerate() {
            if share > 0.0 && share < 1.0 {
                let at = from.lerp(to, share);
                let height = self.flat(0).map_or(f64::NAN, |flat| flat.height(at));
                let spots = [Spot::Inside, Spot::Crossing(2 * edge + end)];
                self.push(PiecePoint { at, spots }, [height, 0.0]);
            }
        }
    }
}
