//! The two surfaces in contact, seen along the contact normal.

use glam::{DVec2, DVec3};

use super::ContactPoint;
use super::clip::{self, ClipVertex, Polygons, Tag};
use crate::query::{Feature, Proximity};
use crate::support::{Cso, FaceId, Polytope};

/// A face seen edge-on (cosine to the contact normal) has no usable projection.
const EDGE_ON: f64 = 0.05;

/// The plane of a face over the contact plane: `height(x) = base + slope · x` along the normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct FacePlane {
    face: FaceId,
    base: f64,
    slope: DVec2,
}

impl FacePlane {
    fn height(&self, at: DVec2) -> f64 {
        self.base + self.slope.dot(at)
    }
}

/// The surface of one shape: the face in contact, or all faces of the cap that it belongs to.
struct Surface<'s> {
    /// Of the face or around the cap.
    polygon: FaceId,
    plane: FacePlane,
    /// Those of the other faces of the cap.
    more: &'s [FacePlane],
    /// Of the outward normal along the contact normal.
    sign: f64,
}

impl Surface<'_> {
    /// The plane that is the surface there: of planes around a convex shape, the innermost.
    fn plane_at(&self, at: DVec2) -> (f64, FaceId) {
        let mut height = self.plane.height(at);
        let mut face = self.plane.face;
        for plane in self.more {
            let other = plane.height(at);
            if other * self.sign < height * self.sign {
                (height, face) = (other, plane.face);
            }
        }
        (height, face)
    }
}

/// The contact plane, whose origin is the witness point of shape 1.
#[derive(Clone, Copy)]
struct Frame {
    origin: DVec3,
    normal: DVec3,
    axes: [DVec3; 2],
}

impl Frame {
    fn flatten(&self, p: DVec3) -> DVec2 {
        let p = p - self.origin;
        DVec2::new(p.dot(self.axes[0]), p.dot(self.axes[1]))
    }

    /// A face whose outward normal is `outward` in this frame's space and whose plane is `offset`
    /// beyond the origin; none if it is seen from behind or edge-on.
    fn plane(&self, face: FaceId, outward: DVec3, offset: f64, sign: f64) -> Option<FacePlane> {
        let along = outward.dot(self.normal);
        (along * sign > EDGE_ON).then(|| FacePlane {
            face,
            base: offset / along,
            slope: -DVec2::new(outward.dot(self.axes[0]), outward.dot(self.axes[1])) / along,
        })
    }
}

/// Both surfaces over the contact plane.
pub(super) struct Patch<'s> {
    frame: Frame,
    surfaces: [Surface<'s>; 2],
    /// The shape, 0 or 1, whose polygon is the window: that with fewer corners, since each of its
    /// sides is a pass over the other polygon.
    window: usize,
}

impl<'s> Patch<'s> {
    pub fn new<A: Polytope, B: Polytope>(
        cso: &Cso<'_, A, B>,
        proximity: &Proximity,
        normal: DVec3,
        [more_1, more_2]: &'s mut [Vec<FacePlane>; 2],
    ) -> Option<Self> {
        let u = normal.any_orthonormal_vector();
        let frame = Frame {
            origin: proximity.on_1,
            normal,
            axes: [u, normal.cross(u)],
        };
        let plane_1 = |face| {
            let outward = cso.shape_1.face_normal(face);
            let offset = cso.shape_1.face_offset(face) - outward.dot(frame.origin);
            frame.plane(face, outward, offset, 1.0)
        };
        let origin_2 = cso.pose.point_to_2(frame.origin);
        let plane_2 = |face| {
            let outward = cso.shape_2.face_normal(face);
            let offset = cso.shape_2.face_offset(face) - outward.dot(origin_2);
            frame.plane(face, cso.pose.direction_to_1(outward), offset, -1.0)
        };
        let outward_2 = -cso.pose.direction_to_2(normal);
        let [f1, f2] = [
            facing(cso.shape_1, proximity.features[0], normal),
            facing(cso.shape_2, proximity.features[1], outward_2),
        ];
        let surfaces = [
            surface(cso.shape_1, f1, 1.0, plane_1, more_1)?,
            surface(cso.shape_2, f2, -1.0, plane_2, more_2)?,
        ];
        let [p1, p2] = [surfaces[0].polygon, surfaces[1].polygon];
        let window = usize::from(cso.shape_2.face_len(p2) < cso.shape_1.face_len(p1));
        Some(Self {
            frame,
            surfaces,
            window,
        })
    }

    /// Leaves the intersection of both polygons in `polygons.subject`.
    pub fn clip<A: Polytope, B: Polytope>(&self, cso: &Cso<'_, A, B>, polygons: &mut Polygons) {
        let [f1, f2] = self.polygons();
        let corners_1 = (0..cso.shape_1.face_len(f1)).map(|i| {
            let corner = cso.shape_1.vertex(cso.shape_1.face_vertex(f1, i));
            self.frame.flatten(corner)
        });
        let corners_2 = (0..cso.shape_2.face_len(f2)).map(|i| {
            let corner = cso.shape_2.vertex(cso.shape_2.face_vertex(f2, i));
            self.frame.flatten(cso.pose.point_to_1(corner))
        });
        if self.window == 0 {
            polygons.fill(corners_1, corners_2);
        } else {
            // Seen along the normal, shape 2's polygon turns clockwise.
            polygons.fill(corners_2.rev(), corners_1);
        }
        clip::intersect(polygons);
    }

    /// Fills in the distances of `corners`, none of which is below `least`.
    pub fn measure(&self, corners: &mut [ClipVertex], least: f64) {
        for corner in corners {
            let [h1, h2] = self.heights(corner.at);
            corner.distance = (h2 - h1).max(least);
        }
    }

    pub fn contact<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        vertex: &ClipVertex,
    ) -> ContactPoint {
        let Frame {
            origin,
            normal,
            axes: [u, v],
        } = self.frame;
        let foot = origin + u * vertex.at.x + v * vertex.at.y;
        let on_1 = foot + normal * self.surfaces[0].plane_at(vertex.at).0;
        ContactPoint {
            on_1,
            on_2: on_1 + normal * vertex.distance,
            distance: vertex.distance,
            features: self.features(cso, vertex),
        }
    }

    /// What meets at a corner of the intersection.
    pub fn features<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        vertex: &ClipVertex,
    ) -> [Feature; 2] {
        let [f1, f2] = self.polygons();
        let corner = |side: usize, i: usize| {
            Feature::Vertex(match side {
                0 => cso.shape_1.face_vertex(f1, i),
                _ => cso.shape_2.face_vertex(f2, i),
            })
        };
        let edge = |side: usize, i: usize| match side {
            0 => edge_of(cso.shape_1, f1, i),
            _ => edge_of(cso.shape_2, f2, i),
        };
        let face = |side: usize| Feature::Face(self.surfaces[side].plane_at(vertex.at).1);
        let (window, subject) = (self.window, 1 - self.window);
        // The window of shape 2 was filled in from its end.
        let last = cso.shape_2.face_len(f2) - 1;
        let corner_of_window = |i: usize| if window == 0 { i } else { last - i };
        let side_of_window = |i: usize| match (window, i) {
            (0, i) => i,
            (_, i) if i == last => last,
            (_, i) => last - 1 - i,
        };
        let [of_window, of_subject] = match vertex.tag {
            Tag::Corner(i) => [face(window), corner(subject, i.into())],
            Tag::Window(i) => [corner(window, corner_of_window(i.into())), face(subject)],
            Tag::Crossing(i, j) => [
                edge(window, side_of_window(i.into())),
                edge(subject, j.into()),
            ],
        };
        if window == 0 {
            [of_window, of_subject]
        } else {
            [of_subject, of_window]
        }
    }

    fn polygons(&self) -> [FaceId; 2] {
        [self.surfaces[0].polygon, self.surfaces[1].polygon]
    }

    /// The heights of both surfaces at a place in the contact plane.
    fn heights(&self, at: DVec2) -> [f64; 2] {
        [
            self.surfaces[0].plane_at(at).0,
            self.surfaces[1].plane_at(at).0,
        ]
    }
}

/// The surface around `face`; none if the face is seen edge-on.
fn surface<'s>(
    shape: &impl Polytope,
    face: FaceId,
    sign: f64,
    plane: impl Fn(FaceId) -> Option<FacePlane>,
    more: &'s mut Vec<FacePlane>,
) -> Option<Surface<'s>> {
    more.clear();
    let main = plane(face)?;
    let mut polygon = face;
    if let Some((outline, faces)) = shape.cap(face) {
        polygon = outline;
        let others = faces.iter().map(|&f| FaceId::from(f));
        more.extend(others.filter(|&other| other != face).filter_map(plane));
    }
    Some(Surface {
        polygon,
        plane: main,
        more,
        sign,
    })
}

/// The face that is in contact: the feature itself, or that next to it which faces the other
/// shape most.
fn facing(shape: &impl Polytope, feature: Feature, outward: DVec3) -> FaceId {
    match feature {
        Feature::Face(face) => face,
        Feature::Vertex(vertex) => shape.face_at(vertex, outward),
        Feature::Edge(edge) => match shape.edge(edge) {
            Some(ends) => shape.face_beside(ends, outward),
            None => shape.face_at(0, outward),
        },
    }
}

/// The `i`-th side of a polygon: an edge, or its first corner where it cuts across faces.
fn edge_of(shape: &impl Polytope, polygon: FaceId, i: usize) -> Feature {
    match shape.face_edge(polygon, i) {
        Some(edge) => Feature::Edge(edge),
        None => Feature::Vertex(shape.face_vertex(polygon, i)),
    }
}
