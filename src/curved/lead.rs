//! A contact ahead of a disc that rolls on its rim.
//!
//! A solver pushes for a whole step where the shapes touched at its start. The lowest place of a coin that wobbles runs
//! around its rim meanwhile, and behind it the rim rises: what pushes there feeds the coin with energy. So where the
//! rim will be lowest if it goes on like that, there is a second contact, at its true distance.

use glam::DVec3;

use super::patch::Patch;
use super::place::{PiecePoint, Spot, by_shape};
use crate::primitive::turn_about;
use crate::tuning::{LEAST_LEAD, MOST_LEAD};

/// The cosines and sines of a third and of two thirds of a turn.
const THIRDS: [[f64; 2]; 2] = {
    let sin = 0.866_025_403_784_438_6;
    [[-0.5, sin], [-0.5, -sin]]
};

impl Patch {
    /// If a disc leans on a flat side and has rolled on its rim, the places beside its deepest one become one
    /// ahead of that, and two that keep the disc from tipping over. `before` are the outward normals of both shapes
    /// when the contacts were chosen last, turned with the shapes.
    pub fn lead(&mut self, before: [DVec3; 2], max_distance: f64) {
        for (shape, before) in before.into_iter().enumerate() {
            if let Some([center, down, aside, ahead]) =
                self.rolling_rim(shape, before, max_distance)
            {
                // That of a rounded disc is beside its flat side, and the query gives it.
                let is_place = self.border(shape) == 0.0;
                let deepest = self.deepest().filter(|_| is_place).copied();
                self.places.clear();
                self.places.extend(deepest);
                let thirds = THIRDS.map(|[cos, sin]| down * cos + aside * sin);
                for (sector, arm) in [(1, ahead), (3, thirds[0]), (5, thirds[1])] {
                    let spots = by_shape(shape, [Spot::Arc(sector), Spot::Inside]);
                    let at = center + arm;
                    self.push_over(shape, PiecePoint { at, spots });
                }
            }
        }
    }

    /// The centre of a disc that rolls on its rim, and from there the ways to its deepest place, a quarter of a turn
    /// beside it, and to where the deepest place will be.
    fn rolling_rim(&self, shape: usize, before: DVec3, max_distance: f64) -> Option<[DVec3; 4]> {
        let flat = self.flat(shape)?.side;
        let (center, radius) = flat.outline.circle()?;
        let turn = turn_about(flat.normal, before, self.outward(shape))?;
        if turn.abs() < LEAST_LEAD {
            return None;
        }
        let down = self.lean(shape, flat)? * radius;
        let aside = flat.normal.cross(down);
        let (sin, cos) = turn.clamp(-MOST_LEAD, MOST_LEAD).sin_cos();
        let ahead = down * cos + aside * sin;
        let height = |arm: DVec3| self.height_over(1 - shape, center + arm);
        let (_, _, far) = (height(down)?, height(ahead)?, height(-down)?);
        (far.abs() > max_distance).then_some([center, down, aside, ahead])
    }
}
