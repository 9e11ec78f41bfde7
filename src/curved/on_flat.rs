//! Bodies at rest on a flat side: a point of the other shape over or under it proves the answer.

use glam::DVec3;

use super::at_rest::AtRest;
use super::piece::FlatSide;
use super::query::CurvedQuery;
use super::surface_pieces::SurfacePieces;
use crate::query::{LastContacts, cone_contains_ball};
use crate::stats::Cost;
use crate::support::Cso;
use crate::tolerance::SAME_NORMAL;
use crate::tuning::FLUSH_TIE;

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// What the flat side of the first shape with this normal proves.
    pub(super) fn on_first_flat(&mut self, last: &LastContacts, normal: DVec3) -> Option<AtRest> {
        let tolerance = self.tolerance();
        let flat = flat_side(self.cso.shape_1, normal, self.cost)?;
        let side = OnFlatSide::new(self.cso, flat, self.cost);
        let middle = || last.middle_of_deepest(flat.normal, FLUSH_TIE * tolerance);
        let middle = || self.cso.pose.point_to_2(middle());
        let [on_1, _] = side.proved(tolerance, middle, self.cost)?;
        Some(AtRest {
            signed_distance: side.separation,
            normal: flat.normal,
            on_1,
        })
    }

    /// The same of the second shape, whose normal is outward in its frame.
    pub(super) fn on_second_flat(&mut self, last: &LastContacts, outward: DVec3) -> Option<AtRest> {
        let (cso, tolerance) = (self.cso, self.tolerance());
        let flat = flat_side(cso.shape_2, outward, self.cost)?;
        let inverse = cso.pose.inverse();
        let reversed = cso.reversed(&inverse);
        let normal = -cso.pose.direction_to_1(flat.normal);
        let side = OnFlatSide::new(&reversed, flat, self.cost);
        let middle = || last.middle_of_deepest(normal, FLUSH_TIE * tolerance);
        let [_, on_1] = side.proved(tolerance, middle, self.cost)?;
        Some(AtRest {
            signed_distance: side.separation,
            normal,
            on_1,
        })
    }
}

/// The flat side of a shape that has this normal.
fn flat_side(shape: &impl SurfacePieces, normal: DVec3, cost: &mut Cost) -> Option<FlatSide> {
    let (_, vertex) = shape.support(normal, shape.start_vertex(normal), cost);
    let flat = shape.flat(normal, vertex)?;
    (flat.normal.distance_squared(normal) < SAME_NORMAL * SAME_NORMAL).then_some(flat)
}

/// A flat side of the first shape, and the point of the second one that is nearest to its plane, or deepest under it.
struct OnFlatSide<'a, 'c, A, B> {
    cso: &'a Cso<'c, A, B>,
    flat: FlatSide,
    /// In the frame of the second shape.
    nearest: DVec3,
    separation: f64,
}

impl<'a, 'c, A: SurfacePieces, B: SurfacePieces> OnFlatSide<'a, 'c, A, B> {
    fn new(cso: &'a Cso<'c, A, B>, flat: FlatSide, cost: &mut Cost) -> Self {
        let towards = -cso.pose.direction_to_2(flat.normal);
        let start = cso.shape_2.start_vertex(towards);
        let (nearest, _) = cso.shape_2.support(towards, start, cost);
        let height = flat.normal.dot(cso.pose.point_to_1(nearest));
        Self {
            cso,
            flat,
            nearest,
            separation: height - flat.offset,
        }
    }

    /// Points of both shapes, each in its frame, that prove the separation to be the signed distance up to the
    /// tolerance. That of the second one is nearest, or near the `middle` of the contacts.
    fn proved(
        &self,
        tolerance: f64,
        middle: impl FnOnce() -> DVec3,
        cost: &mut Cost,
    ) -> Option<[DVec3; 2]> {
        if let Some(on_1) = self.proves(self.nearest, tolerance) {
            return Some([on_1, self.nearest]);
        }
        let Cso { shape_2, pose, .. } = self.cso;
        let towards = -pose.direction_to_2(self.flat.normal);
        let on_2 = shape_2.point_on_side(towards, middle(), cost)?;
        self.proves(on_2, tolerance).map(|on_1| [on_1, on_2])
    }

    /// The point of the flat side beside a point of the second shape, if they prove the signed distance. Where the
    /// shapes overlap, there is a disc in the difference, around this point minus the other.
    fn proves(&self, on_2: DVec3, tolerance: f64) -> Option<DVec3> {
        let normal = self.flat.normal;
        let at = self.cso.pose.point_to_1(on_2);
        let height = normal.dot(at) - self.flat.offset;
        let on_1 = at - normal * height;
        let inset = self.cso.shape_1.inset(&self.flat, on_1);
        let most = self.separation + tolerance;
        let is_proved = height <= most
            && inset > 0.0
            && (most >= 0.0 || cone_contains_ball(inset, -most, self.cso.center(), normal));
        is_proved.then_some(on_1)
    }
}
