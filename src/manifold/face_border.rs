//! The border of a face: a plate over it, cylinders around its sides and balls around its corners. Seen along a contact
//! normal that is not the face's, the last of these is higher over a point of the face than the border is wide.

use glam::DVec3;

use crate::primitive::exit_from_ball;
use crate::tuning::EDGE_ON;

/// The border around a face of a core. `sides` are the ends of its sides, counter-clockwise seen from outside.
pub struct FaceBorder<I> {
    /// Both ends of each side.
    pub sides: I,
    /// The outward unit normal of the face.
    pub outward: DVec3,
    /// `outward · p` of its points.
    pub offset: f64,
    /// How wide the border is.
    pub width: f64,
}

/// How high a border reaches, and the part of the face that is nearest there.
#[derive(Clone, Copy)]
pub struct Reach {
    pub height: f64,
    pub nearest: NearestPart,
}

/// A part of a face.
#[derive(Clone, Copy)]
pub enum NearestPart {
    /// Its inside.
    Inside,
    /// The side of this number.
    Side(usize),
    /// The corner where this side begins.
    Corner(usize),
}

impl<I: Iterator<Item = [DVec3; 2]> + Clone> FaceBorder<I> {
    /// How high the border reaches over a point along a unit vector, and at least how wide it is.
    pub fn height_over(&self, point: DVec3, normal: DVec3) -> f64 {
        self.reach_over(point, normal).height
    }

    /// The same, with the part of the face that is nearest there.
    ///
    /// The line along the vector leaves the border at one place. Beside the face, this is between the place that the line
    /// has in the plane of the plate and that of the point, so only sides with one of these beyond them are near it.
    pub fn reach_over(&self, point: DVec3, normal: DVec3) -> Reach {
        let outward = self.outward;
        let cos = outward.dot(normal);
        if cos < EDGE_ON {
            return self.reach_around(point, normal, |_| true);
        }
        let on_plate = (self.width + self.offset - outward.dot(point)) / cos;
        let foot = point + normal * on_plate;
        let is_within =
            |p: DVec3, [from, to]: &[DVec3; 2]| outward.cross(to - from).dot(p - from) >= 0.0;
        if self.sides.clone().all(|side| is_within(foot, &side)) {
            return Reach {
                height: on_plate.max(self.width),
                nearest: NearestPart::Inside,
            };
        }
        let is_near = |side: &_| !(is_within(foot, side) && is_within(point, side));
        self.reach_around(point, normal, is_near)
    }

    /// How high the cylinders around some sides, and the balls around their ends, reach over a point.
    fn reach_around(
        &self,
        point: DVec3,
        normal: DVec3,
        is_near: impl Fn(&[DVec3; 2]) -> bool,
    ) -> Reach {
        let mut reach = Reach {
            height: 0.0,
            nearest: NearestPart::Inside,
        };
        let count = self.sides.clone().count();
        // A segment has its only side in both directions.
        let sides = self.sides.clone().take(if count == 2 { 1 } else { count });
        for (i, ends) in sides.enumerate().filter(|(_, ends)| is_near(ends)) {
            let next = if i + 1 < count { i + 1 } else { 0 };
            let ends = ends.map(|end| end - point);
            let [first, last] =
                ends.map(|end| exit_from_ball(normal, -end, self.width).unwrap_or(0.0));
            let cylinder = self.cylinder_over_origin(ends, normal);
            for (height, nearest) in [
                (first, NearestPart::Corner(i)),
                (last, NearestPart::Corner(next)),
                (cylinder, NearestPart::Side(i)),
            ] {
                if height > reach.height {
                    reach = Reach { height, nearest };
                }
            }
        }
        reach.height = reach.height.max(self.width);
        reach
    }

    /// How high the cylinder between two points reaches over the origin; 0 if it is not over it.
    fn cylinder_over_origin(&self, [from, to]: [DVec3; 2], normal: DVec3) -> f64 {
        let along = to - from;
        let length_squared = along.length_squared();
        let across = |v: DVec3| v - along * (v.dot(along) / length_squared);
        let height = exit_from_ball(across(normal), -across(from), self.width);
        height
            .filter(|height| {
                let share = (normal * *height - from).dot(along);
                (0.0..=length_squared).contains(&share)
            })
            .unwrap_or(0.0)
    }
}
