//! Bodies at rest: the flat sides of both shapes that gave the last normals.

use glam::DVec3;

use super::at_rest::AtRest;
use super::on_flat::OnFlatSide;
use super::query::CurvedQuery;
use super::surface_pieces::SurfacePieces;
use crate::query::LastContacts;
use crate::stats::Cost;
use crate::support::Cso;
use crate::tuning::FLUSH_TIE;

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// What the sides with about these normals prove, each outward in the frame of its shape.
    pub(super) fn on_sides(&mut self, last: &LastContacts, normals: [DVec3; 2]) -> Option<AtRest> {
        let (cso, tolerance) = (self.cso, self.tolerance());
        let inverse = cso.pose.inverse();
        let reversed = cso.reversed(&inverse);
        let mut sides = FlatSides {
            cso,
            tolerance,
            first: None,
            second: None,
        };
        // The extreme point of the smaller shape is mostly over the side of the larger.
        let is_first_larger = cso.shape_1.radius() > cso.shape_2.radius();
        for is_first in [is_first_larger, !is_first_larger] {
            let proved = if is_first {
                sides.first = OnFlatSide::new(cso, normals[0], self.cost);
                sides.first_at_nearest(last, self.cost)
            } else {
                sides.second = OnFlatSide::new(&reversed, normals[1], self.cost);
                sides.second_at_nearest(last, self.cost)
            };
            if proved.is_some() {
                return proved;
            }
        }
        if sides.first.is_none() && sides.second.is_none() {
            return self.on_ruled_sides(last, normals);
        }
        if !sides.are_tilted()
            && let Some(proved) = sides.at_middle(last, normals[0], self.cost)
        {
            return Some(proved);
        }
        (self.on_border(last, normals)).or_else(|| self.on_crossing(last, normals[0]))
    }
}

/// The flat sides of both shapes, if there are any.
struct FlatSides<'a, 'c, A, B> {
    cso: &'a Cso<'c, A, B>,
    tolerance: f64,
    first: Option<OnFlatSide<'a, 'c, A, B>>,
    second: Option<OnFlatSide<'a, 'a, B, A>>,
}

impl<A: SurfacePieces, B: SurfacePieces> FlatSides<'_, '_, A, B> {
    fn first_at_nearest(&self, last: &LastContacts, cost: &mut Cost) -> Option<AtRest> {
        let side = self.first.as_ref()?;
        let middle = || self.cso.pose.point_to_2(last.middle());
        let [on_1, _] = side.at_nearest(self.tolerance, middle, cost)?;
        Some(self.of_first(side, on_1))
    }

    fn second_at_nearest(&self, last: &LastContacts, cost: &mut Cost) -> Option<AtRest> {
        let side = self.second.as_ref()?;
        let [_, on_1] = side.at_nearest(self.tolerance, || last.middle(), cost)?;
        Some(self.of_second(side, on_1))
    }

    /// By a point near the middle of the deepest contacts.
    fn at_middle(&self, last: &LastContacts, normal: DVec3, cost: &mut Cost) -> Option<AtRest> {
        let middle = last.middle_of_deepest(normal, FLUSH_TIE * self.tolerance);
        if let Some(side) = &self.second
            && let Some([_, on_1]) = side.at_middle(self.tolerance, middle, cost)
        {
            return Some(self.of_second(side, on_1));
        }
        let side = self.first.as_ref()?;
        let middle = self.cso.pose.point_to_2(middle);
        let [on_1, _] = side.at_middle(self.tolerance, middle, cost)?;
        Some(self.of_first(side, on_1))
    }

    fn of_first(&self, side: &OnFlatSide<'_, '_, A, B>, on_1: DVec3) -> AtRest {
        AtRest {
            signed_distance: side.separation,
            normal: side.flat.normal,
            on_1,
        }
    }

    fn of_second(&self, side: &OnFlatSide<'_, '_, B, A>, on_1: DVec3) -> AtRest {
        AtRest {
            signed_distance: side.separation,
            normal: -self.cso.pose.direction_to_1(side.flat.normal),
            on_1,
        }
    }

    /// Whether there are two that lean against each other, so that no middle is as deep as the deepest place.
    fn are_tilted(&self) -> bool {
        let (Some(first), Some(second)) = (&self.first, &self.second) else {
            return false;
        };
        let turned = first.flat.normal + self.cso.pose.direction_to_1(second.flat.normal);
        turned.length() * self.cso.min_radius() > self.tolerance
    }
}
