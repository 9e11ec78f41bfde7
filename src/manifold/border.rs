//! Contacts of rounded shapes, moved from the faces of the cores onto the borders around them.

use glam::{DVec3, Vec3};

use super::contacts::Contacts;
use super::face_border::FaceBorder;
use crate::query::Feature;
use crate::simd::f32x4;
use crate::support::{Cso, FaceId, Polytope};

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
        let border = FaceBorder {
            sides: sides(self.core, face),
            outward: self.core.face_normal(face),
            offset: self.core.face_offset(face),
            width: self.width,
        };
        border.height_over(point, self.normal)
    }
}

/// The sides of a face.
fn sides(shape: &impl Polytope, face: FaceId) -> impl Iterator<Item = [DVec3; 2]> + Clone {
    let corners = shape.face_points(face);
    let next = corners.clone().cycle().skip(1);
    corners.zip(next).map(|(from, to)| [from, to])
}
