//! Contacts of rounded shapes, moved from the faces of the cores onto the borders around them.

use glam::{DVec3, Vec3};

use super::contacts::Contacts;
use super::face_border::{FaceBorder, NearestPart, Reach};
use crate::query::Feature;
use crate::simd::f32x4;
use crate::support::{Cso, FaceId, Polytope, VertexId};

impl Contacts {
    /// Moves the points so that they are on the borders once each has been moved by the border's width along its
    /// normal, and measures the distances anew, which are at least `least`. The normals point out of the shapes, each in
    /// the frame of its shape.
    #[cold]
    #[inline(never)]
    pub fn fit_to_borders<A: Polytope, B: Polytope>(
        &mut self,
        cso: &Cso<'_, A, B>,
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
            let lift_1 = border_1.lift(own_1, &mut contacts.on_1, lane);
            let lift_2 = border_2.lift(own_2, &mut contacts.on_2, lane);
            lift_1 + lift_2
        });
    }

    /// The same for the first shape over a half-space.
    #[cold]
    #[inline(never)]
    pub fn fit_to_border(&mut self, core: &impl Polytope, normal: DVec3, width: f64, least: f64) {
        let border = Border {
            core,
            normal,
            width,
        };
        self.lift_all(least, |contacts, lane| {
            let [own, _] = contacts.features[lane];
            border.lift(own, &mut contacts.on_1, lane)
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
    /// Moves a point of a feature of the core outwards by what the border is higher over it than wide. Returns this
    /// height.
    fn lift(&self, feature: Feature, points: &mut [f32x4; 3], lane: usize) -> f64 {
        if self.width == 0.0 {
            return 0.0;
        }
        let mut rows = points.map(f32x4::to_array);
        let point = Vec3::from(rows.map(|row| row[lane])).as_dvec3();
        let height = match self.core.height_of_border(point, self.normal, self.width) {
            Some(height) => height,
            None => self.height_over(feature.face(self.core, self.normal), point),
        };
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

    /// How high the border reaches over a point of a face. It may be that of another face there, far from the point
    /// if the normal leans.
    ///
    /// The border of a face is highest of all unless something of the core is nearer to where the normal leaves it
    /// than the face is. Then a face beyond the nearest side or corner is, and its border reaches higher.
    fn height_over(&self, mut face: FaceId, point: DVec3) -> f64 {
        let mut reach = self.reach_over(face, point);
        while let Some(next) = self.face_beyond(face, &reach, point) {
            let beyond = self.reach_over(next, point);
            if beyond.height <= reach.height {
                break;
            }
            (face, reach) = (next, beyond);
        }
        reach.height
    }

    /// How high the border of a face reaches over a point.
    fn reach_over(&self, face: FaceId, point: DVec3) -> Reach {
        let border = FaceBorder {
            sides: sides(self.core, face),
            outward: self.core.face_normal(face),
            offset: self.core.face_offset(face),
            width: self.width,
        };
        border.reach_over(point, self.normal)
    }

    /// The face beyond the side or the corner that is nearest to where the normal leaves the border of a face: the
    /// only one that may be nearer.
    fn face_beyond(&self, face: FaceId, reach: &Reach, point: DVec3) -> Option<FaceId> {
        let top = point + self.normal * reach.height;
        match reach.nearest {
            NearestPart::Inside => None,
            NearestPart::Side(i) => {
                let own = self.core.face_normal(face);
                // A sliver has no normal, and was entered from the other side.
                let dir = if own == DVec3::ZERO {
                    self.normal
                } else {
                    -own
                };
                Some(self.core.face_at_edge(self.core.face_edge(face, i)?, dir))
            }
            NearestPart::Corner(i) => {
                let corner = self.core.face_vertex(face, i);
                let from = self.core.vertex(corner);
                let rise = |&to: &VertexId| {
                    let way = self.core.vertex(to) - from;
                    way.dot(top - from) / way.length()
                };
                let neighbors = self.core.neighbors(corner);
                let to = neighbors.max_by(|a, b| rise(a).total_cmp(&rise(b)))?;
                let edge = self.core.edge_between(corner, to)?;
                Some(self.core.face_at_edge(edge, top - from))
            }
        }
    }
}

/// The sides of a face.
fn sides(shape: &impl Polytope, face: FaceId) -> impl Iterator<Item = [DVec3; 2]> + Clone {
    let corners = shape.face_points(face);
    let next = corners.clone().cycle().skip(1);
    corners.zip(next).map(|(from, to)| [from, to])
}
