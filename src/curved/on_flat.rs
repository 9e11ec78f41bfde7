//! Bodies at rest on a flat side: a point of the other shape over or under it proves the answer.

use glam::DVec3;

use super::piece::FlatSide;
use super::surface_pieces::SurfacePieces;
use crate::query::{Disc, cone_contains_ball};
use crate::stats::Cost;
use crate::support::Cso;
use crate::tuning::SMALL_TURN;

/// A flat side of the first shape, and the point of the second one that is nearest to its plane, or deepest under it.
pub(super) struct OnFlatSide<'a, 'c, A, B> {
    cso: &'a Cso<'c, A, B>,
    pub flat: FlatSide,
    /// In the frame of the second shape.
    nearest: DVec3,
    pub separation: f64,
}

/// A point of the second shape in its frame, and the point of the plane of a flat side under it.
struct PointOver {
    on_1: DVec3,
    on_2: DVec3,
    height: f64,
    /// How far the point of the plane is inside of the side.
    inset: f64,
}

impl<'a, 'c, A: SurfacePieces, B: SurfacePieces> OnFlatSide<'a, 'c, A, B> {
    /// The flat side of the first shape whose normal is close to this one.
    pub fn new(cso: &'a Cso<'c, A, B>, normal: DVec3, cost: &mut Cost) -> Option<Self> {
        let Cso {
            shape_1,
            shape_2,
            pose,
        } = cso;
        let flat = shape_1.flat_towards(normal, cost)?;
        if flat.normal.distance_squared(normal) > SMALL_TURN * SMALL_TURN {
            return None;
        }
        let towards = -pose.direction_to_2(flat.normal);
        let (nearest, _) = shape_2.support(towards, shape_2.start_vertex(towards), cost);
        let height = flat.normal.dot(pose.point_to_1(nearest));
        Some(Self {
            cso,
            flat,
            nearest,
            separation: height - flat.offset,
        })
    }

    /// Points of both shapes, each in its frame, that prove the separation to be the signed distance up to the
    /// tolerance: the nearest one, if it is over the side.
    ///
    /// Where the shapes overlap, there is a disc in the difference: the side around the point under the nearest one,
    /// minus this one. It proves the depth if it is wide enough. Otherwise a disc in the middle of the contacts may
    /// (T14).
    pub fn at_nearest(
        &self,
        tolerance: f64,
        middle: impl FnOnce() -> DVec3,
        cost: &mut Cost,
    ) -> Option<[DVec3; 2]> {
        let (cso, normal) = (self.cso, self.flat.normal);
        let most = self.separation + tolerance;
        let nearest = self.over(self.nearest);
        if nearest.inset <= 0.0 {
            return None;
        }
        let is_proved = most >= 0.0
            || cone_contains_ball(nearest.inset, -most, cso.center(), normal)
            || self
                .over_side(middle(), cost)
                .is_some_and(|middle| middle.disc().proves(cso, normal, nearest.height, most));
        is_proved.then_some([nearest.on_1, nearest.on_2])
    }

    /// The same by a point near the middle of the contacts.
    pub fn at_middle(&self, tolerance: f64, middle: DVec3, cost: &mut Cost) -> Option<[DVec3; 2]> {
        let most = self.separation + tolerance;
        let middle = self.over_side(middle, cost)?;
        let (disc, normal) = (middle.disc(), self.flat.normal);
        let is_proved = middle.height <= most
            && (most >= 0.0 || disc.proves(self.cso, normal, middle.height, most));
        is_proved.then_some([middle.on_1, middle.on_2])
    }

    /// A point of the second shape, in its frame.
    fn over(&self, on_2: DVec3) -> PointOver {
        let p = self.cso.pose.point_to_1(on_2);
        let height = self.flat.normal.dot(p) - self.flat.offset;
        let on_1 = p - self.flat.normal * height;
        PointOver {
            on_1,
            on_2,
            height,
            inset: self.cso.shape_1.inset(&self.flat, on_1),
        }
    }

    /// A point near `middle` of the side of the second shape in contact, if it is over the flat side.
    fn over_side(&self, middle: DVec3, cost: &mut Cost) -> Option<PointOver> {
        let towards = -self.cso.pose.direction_to_2(self.flat.normal);
        let on_2 = self.cso.shape_2.point_on_side(towards, middle, cost)?;
        let over = self.over(on_2);
        (over.inset > 0.0).then_some(over)
    }
}

impl PointOver {
    /// The points of the flat side around the lower point minus the upper one.
    fn disc(&self) -> Disc {
        Disc {
            radius: self.inset,
            highest: self.height,
        }
    }
}
