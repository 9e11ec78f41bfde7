//! The border of a face: a plate over it, cylinders around its sides and balls around its corners. Seen along a contact
//! normal that is not the face's, the last of these is higher over a point of the face than the border is wide.

use glam::DVec3;

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
    pub fn reach_over(&self, point: DVec3, normal: DVec3) -> Reach {
        let mut reach = Reach {
            height: self.plate_over(point, normal),
            nearest: NearestPart::Inside,
        };
        for (i, ends) in self.sides.clone().enumerate() {
            let ends = ends.map(|end| end - point);
            let ball = last_crossing(ends[0], normal, self.width).unwrap_or(0.0);
            let cylinder = self.cylinder_over_origin(ends, normal);
            for (height, nearest) in [
                (ball, NearestPart::Corner(i)),
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

    /// How high the plate over the face reaches over a point; 0 if it is not over it.
    fn plate_over(&self, point: DVec3, normal: DVec3) -> f64 {
        let outward = self.outward;
        let cos = outward.dot(normal);
        if cos < EDGE_ON {
            return 0.0;
        }
        let beneath = self.offset - outward.dot(point);
        let height = (self.width + beneath) / cos;
        let foot = point + normal * height - outward * self.width;
        let mut sides = self.sides.clone();
        let is_inside = sides.all(|[from, to]| outward.dot((to - from).cross(foot - from)) >= 0.0);
        if is_inside { height } else { 0.0 }
    }

    /// How high the cylinder between two points reaches over the origin; 0 if it is not over it.
    fn cylinder_over_origin(&self, [from, to]: [DVec3; 2], normal: DVec3) -> f64 {
        let along = to - from;
        let length_squared = along.length_squared();
        let across = |v: DVec3| v - along * (v.dot(along) / length_squared);
        let height = last_crossing(across(from), across(normal), self.width);
        height
            .filter(|height| {
                let share = (normal * *height - from).dot(along);
                (0.0..=length_squared).contains(&share)
            })
            .unwrap_or(0.0)
    }
}

/// The greatest `t` at which `t * way` is at this distance from a point.
fn last_crossing(from: DVec3, way: DVec3, distance: f64) -> Option<f64> {
    let (squared, nearest) = (way.length_squared(), from.dot(way));
    let rest = nearest * nearest - squared * (from.length_squared() - distance * distance);
    let crossing = (nearest + rest.sqrt()) / squared;
    crossing.is_finite().then_some(crossing)
}
