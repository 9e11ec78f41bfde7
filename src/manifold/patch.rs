//! The two surfaces in contact, seen along the contact normal.

use glam::{DVec2, DVec3};

use super::ContactPoint;
use super::clip::{self, ClipVertex, Polygons, Tag};
use crate::both::both;
use crate::pose::RelativePose;
use crate::query::{Feature, Proximity};
use crate::support::{Cso, FaceId, Polytope};

/// A face seen edge-on (cosine to the contact normal) has no usable projection.
pub(super) const EDGE_ON: f64 = 0.05;

/// The plane of a face over the contact plane: `height(x) = base + slope · x` along the normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct FacePlane {
    face: FaceId,
    base: f64,
    slope: DVec2,
}

impl FacePlane {
    #[inline]
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
    #[inline]
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
    /// The same plane in the frame of shape 2.
    #[inline]
    fn seen_from_2(&self, pose: &RelativePose) -> Self {
        Self {
            origin: pose.point_to_2(self.origin),
            normal: pose.direction_to_2(self.normal),
            axes: both(self.axes, |axis| pose.direction_to_2(axis)),
        }
    }

    #[inline]
    fn flatten(&self, p: DVec3) -> DVec2 {
        let p = p - self.origin;
        DVec2::new(p.dot(self.axes[0]), p.dot(self.axes[1]))
    }

    /// A face whose outward normal is `outward` in this frame's space and whose plane is `offset`
    /// beyond the origin; none if it is seen from behind or edge-on.
    #[inline]
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
        let plane_2 = |face| {
            let (outward, offset) = plane_of_2(cso, face, &frame)?;
            frame.plane(face, outward, offset, -1.0)
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
        Some(Self { frame, surfaces })
    }

    /// The corners of the intersection of both polygons.
    #[inline]
    pub fn clip<'p, A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        polygons: &'p mut Polygons,
        slack: f64,
    ) -> &'p mut [ClipVertex] {
        let [f1, f2] = self.polygons();
        let frame_2 = self.frame.seen_from_2(cso.pose);
        let window = cso.shape_1.corners(f1).map(|p| self.frame.flatten(p));
        polygons.window.clear();
        polygons.window.extend(window);
        let subject = cso.shape_2.corners(f2).map(|p| frame_2.flatten(p));
        polygons.subject.clear();
        polygons.subject.extend(subject);
        clip::intersect(polygons, slack)
    }

    /// Fills in the distances of `corners`, none of which is below `least`.
    #[inline]
    pub fn measure(&self, corners: &mut [ClipVertex], least: f64) {
        for corner in corners {
            let [h1, h2] = self.heights(corner.at);
            corner.distance = (h2 - h1).max(least);
        }
    }

    #[inline]
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
    #[inline]
    pub fn features<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        vertex: &ClipVertex,
    ) -> [Feature; 2] {
        let [f1, f2] = self.polygons();
        let corner_1 = |i: u16| Feature::Vertex(cso.shape_1.face_vertex(f1, i.into()));
        let corner_2 = |i: u16| Feature::Vertex(cso.shape_2.face_vertex(f2, i.into()));
        let face = |side: usize| Feature::Face(self.surfaces[side].plane_at(vertex.at).1);
        match vertex.tag {
            Tag::Corner(i) => [face(0), corner_2(i)],
            Tag::Window(i) => [corner_1(i), face(1)],
            Tag::Crossing(i, j) => [
                edge_of(cso.shape_1, f1, i.into()),
                edge_of(cso.shape_2, f2, j.into()),
            ],
        }
    }

    #[inline]
    fn polygons(&self) -> [FaceId; 2] {
        [self.surfaces[0].polygon, self.surfaces[1].polygon]
    }

    /// The heights of both surfaces at a place in the contact plane.
    #[inline]
    fn heights(&self, at: DVec2) -> [f64; 2] {
        [
            self.surfaces[0].plane_at(at).0,
            self.surfaces[1].plane_at(at).0,
        ]
    }
}

/// The plane of a face of shape 2, in frame 1: its outward normal, and its height over the origin of
/// the contact plane. A segment has that of its planes which leans least against the contact
/// normal; a point has none.
#[inline]
fn plane_of_2<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    face: FaceId,
    frame: &Frame,
) -> Option<(DVec3, f64)> {
    let shape = cso.shape_2;
    match shape.face_len(face) {
        1 => None,
        2 => {
            let end = |i| {
                cso.pose
                    .point_to_1(shape.vertex(shape.face_vertex(face, i)))
            };
            let [from, to] = both([0, 1], end);
            let along = (to - from).try_normalize()?;
            let outward = (along * along.dot(frame.normal) - frame.normal).try_normalize()?;
            Some((outward, outward.dot(from - frame.origin)))
        }
        _ => {
            let outward = shape.face_normal(face);
            let height = shape.face_offset(face) - outward.dot(cso.pose.point_to_2(frame.origin));
            Some((cso.pose.direction_to_1(outward), height))
        }
    }
}

/// The surface around `face`; none if the face is seen edge-on.
#[inline]
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
#[inline]
pub(super) fn facing(shape: &impl Polytope, feature: Feature, outward: DVec3) -> FaceId {
    match feature {
        Feature::Face(face) => face,
        Feature::Vertex(vertex) => shape.face_at(vertex, outward),
        Feature::Edge(edge) => shape.face_beside(edge, outward),
    }
}

/// The `i`-th side of a polygon: an edge, or its first corner where it cuts across faces.
#[inline]
fn edge_of(shape: &impl Polytope, polygon: FaceId, i: usize) -> Feature {
    match shape.face_edge(polygon, i) {
        Some(edge) => Feature::Edge(edge),
        None => Feature::Vertex(shape.face_vertex(polygon, i)),
    }
}
