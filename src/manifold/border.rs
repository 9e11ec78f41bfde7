//! Contacts of rounded shapes, moved from the faces of the cores onto the borders around them.
//!
//! The border of a face is a plate over it, cylinders around its sides and balls around its corners. Seen along a
//! contact normal that is not the face's, the last of these is higher over a point of the face than the border is wide.

use glam::{DVec3, Vec3};

use super::contacts::Contacts;
use crate::query::Feature;
use crate::simd::f32x4;
use crate::support::{Cso, FaceId, Polytope};
use crate::tuning::EDGE_ON;

impl Contacts {
    /// Moves the points so that they are on the borders once each has been moved by the border's width along its
    /// normal, and measures the distances anew, which are at least `least`. `features` are those at the witness. The
    /// normals point out of the shapes, each in the frame of its shape.
    #[cold]
    #[inline(never)]
    pub fn fit_to_borders<A: Polytope, B: Polytope>(
        &mut self,
        cso: &Cso<'_, A, B>,
        features: [Feature; 2],
        normals: [DVec3; 2],
        widths: [f64; 2],
        least: f64,
    ) {
        let border_1 = Border {
            core: cso.shape_1,
            normal: normals[0],
            width: widths[0],
        };
        let border_2 = Border {
            core: cso.shape_2,
            normal: normals[1],
            width: widths[1],
        };
        self.lift_all(least, |contacts, lane| {
            let [own_1, own_2] = contacts.features[lane];
            let lift_1 = border_1.lift([features[0], own_1], &mut contacts.on_1, lane);
            let lift_2 = border_2.lift([features[1], own_2], &mut contacts.on_2, lane);
            lift_1 + lift_2
        });
    }

    /// The same for the first shape over a half-space.
    #[cold]
    #[inline(never)]
    pub fn fit_to_border(
        &mut self,
        core: &impl Polytope,
        feature: Feature,
        normal: DVec3,
        width: f64,
        least: f64,
    ) {
        let border = Border {
            core,
            normal,
            width,
        };
        self.lift_all(least, |contacts, lane| {
            let [own, _] = contacts.features[lane];
            border.lift([feature, own], &mut contacts.on_1, lane)
        });
    }

    /// Moves the points of each contact by `lift`, which returns how much less their distance is.
    fn lift_all(&mut self, least: f64, lift: impl Fn(&mut Self, usize) -> f64) {
        let mut distances = self.distance.to_array();
        for (lane, distance) in distances.iter_mut().enumerate().take(self.len) {
            *distance = (f64::from(*distance) - lift(self, lane)).max(least) as f32;
        }
        self.distance = f32x4::new(distances);
    }
}

/// The border around a core, seen along a normal.
struct Border<'a, S> {
    core: &'a S,
    normal: DVec3,
    width: f64,
}

impl<S: Polytope> Border<'_, S> {
    /// Moves a point of the core outwards by what the border around some features is higher over it than wide.
    /// Returns this height.
    fn lift(&self, features: [Feature; 2], points: &mut [f32x4; 3], lane: usize) -> f64 {
        if self.width == 0.0 {
            return 0.0;
        }
        let mut rows = points.map(f32x4::to_array);
        let point = Vec3::from(rows.map(|row| row[lane])).as_dvec3();
        let [face, own] = features.map(|feature| feature.face(self.core, self.normal));
        let mut height = self.height_over(face, point);
        if own != face {
            height = height.max(self.height_over(own, point));
        }
        let lift = height - self.width;
        if lift <= 0.0 {
            return 0.0;
        }
        let lifted = (point + self.normal * lift).as_vec3().to_array();
        for (row, lifted) in rows.iter_mut().zip(lifted) {
            row[lane] = lifted;
        }
        *points = rows.map(f32x4::new);
        lift
    }

    /// How high the border of a face reaches over a point.
    fn height_over(&self, face: FaceId, point: DVec3) -> f64 {
        let around = sides(self.core, face).map(|ends| {
            let ends = ends.map(|end| end - point);
            let ball = last_crossing(ends[0], self.normal, self.width).unwrap_or(0.0);
            ball.max(self.cylinder_over_origin(ends))
        });
        around.fold(self.plate_over(face, point), f64::max)
    }

    /// How high the plate over a face reaches over a point; 0 if it is not over it.
    fn plate_over(&self, face: FaceId, point: DVec3) -> f64 {
        let outward = self.core.face_normal(face);
        let cos = outward.dot(self.normal);
        if cos < EDGE_ON {
            return 0.0;
        }
        let beneath = self.core.face_offset(face) - outward.dot(point);
        let height = (self.width + beneath) / cos;
        let foot = point + self.normal * height - outward * self.width;
        let is_inside = sides(self.core, face)
            .all(|[from, to]| outward.dot((to - from).cross(foot - from)) >= 0.0);
        if is_inside { height } else { 0.0 }
    }

    /// How high the cylinder between two points reaches over the origin; 0 if it is not over it.
    fn cylinder_over_origin(&self, [from, to]: [DVec3; 2]) -> f64 {
        let along = to - from;
        let length_squared = along.length_squared();
        let across = |v: DVec3| v - along * (v.dot(along) / length_squared);
        let height = last_crossing(across(from), across(self.normal), self.width);
        height
            .filter(|height| {
                let share = (self.normal * *height - from).dot(along);
                (0.0..=length_squared).contains(&share)
            })
            .unwrap_or(0.0)
    }
}

/// The sides of a face.
fn sides(shape: &impl Polytope, face: FaceId) -> impl Iterator<Item = [DVec3; 2]> {
    let corners = shape.face_points(face);
    let next = corners.clone().cycle().skip(1);
    corners.zip(next).map(|(from, to)| [from, to])
}

/// The greatest `t` at which `t * way` is at this distance from a point.
fn last_crossing(from: DVec3, way: DVec3, distance: f64) -> Option<f64> {
    let (squared, nearest) = (way.length_squared(), from.dot(way));
    let rest = nearest * nearest - squared * (from.length_squared() - distance * distance);
    let crossing = (nearest + rest.sqrt()) / squared;
    crossing.is_finite().then_some(crossing)
}
