//! The two surfaces in contact, seen along the contact normal.

use glam::{DVec3, Vec2, Vec3};
use wide::f32x4;

use super::Chosen;
use super::clip::{Polygons, Tag};
use super::contacts::{Contacts, MAX_POINTS};
use super::polygon::{LANES, lanes};
use super::reduce::Candidates;
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
    base: f32,
    slope: Vec2,
}

impl FacePlane {
    #[inline(always)]
    fn heights(&self, x: f32x4, y: f32x4) -> f32x4 {
        x * self.slope.x + y * self.slope.y + self.base
    }

    #[inline(always)]
    fn height(&self, at: Vec2) -> f32 {
        at.x * self.slope.x + at.y * self.slope.y + self.base
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
    sign: f32,
}

impl Surface<'_> {
    /// Of planes around a convex shape, the innermost is the surface.
    #[inline(always)]
    fn heights(&self, x: f32x4, y: f32x4) -> f32x4 {
        let mut heights = self.plane.heights(x, y);
        for plane in self.more {
            let others = plane.heights(x, y) * self.sign;
            heights = others.fast_min(heights * self.sign) * self.sign;
        }
        heights
    }

    /// The face that the surface is in one place.
    #[inline(always)]
    fn face_at(&self, at: Vec2) -> FaceId {
        let mut height = self.plane.height(at);
        let mut face = self.plane.face;
        for plane in self.more {
            let other = plane.height(at);
            if other * self.sign < height * self.sign {
                (height, face) = (other, plane.face);
            }
        }
        face
    }
}

/// The contact plane as a shape sees it. Its origin is the witness point of shape 1.
pub(super) struct Frame {
    origin: DVec3,
    normal: DVec3,
    axes: [DVec3; 2],
}

impl Frame {
    #[inline(always)]
    pub fn new(origin: DVec3, normal: DVec3) -> Self {
        let u = normal.any_orthonormal_vector();
        Self {
            origin,
            normal,
            axes: [u, normal.cross(u)],
        }
    }

    /// The same plane in the frame of shape 2.
    #[inline(always)]
    fn seen_from_2(&self, pose: &RelativePose) -> Self {
        Self {
            origin: pose.point_to_2(self.origin),
            normal: pose.direction_to_2(self.normal),
            axes: both(self.axes, |axis| pose.direction_to_2(axis)),
        }
    }

    /// A face with this outward normal whose plane is `offset` beyond the origin; none if it is seen
    /// from behind or edge-on.
    #[inline(always)]
    fn plane(&self, face: FaceId, outward: DVec3, offset: f64, sign: f32) -> Option<FacePlane> {
        let along = outward.dot(self.normal);
        let slope = |axis| (-outward.dot(axis) / along) as f32;
        (along * f64::from(sign) > EDGE_ON).then(|| FacePlane {
            face,
            base: (offset / along) as f32,
            slope: Vec2::from(both(self.axes, slope)),
        })
    }

    #[inline(always)]
    pub fn chart(&self) -> Chart {
        let origin = self.origin.as_vec3();
        Chart {
            origin,
            rest: (self.origin - origin.as_dvec3()).as_vec3(),
            normal: self.normal.as_vec3(),
            axes: both(self.axes, |axis| axis.as_vec3()),
        }
    }
}

/// Between a shape's space and the contact plane, in f32: beside the witness coordinates are small, and
/// errors are no larger than those of f32 vertices.
pub(super) struct Chart {
    /// The plane's origin in two parts: what f32 holds of it, and the rest. So what is near loses
    /// nothing where the shape is large.
    origin: Vec3,
    rest: Vec3,
    normal: Vec3,
    axes: [Vec3; 2],
}

impl Chart {
    /// Four points into the plane, coordinate by coordinate.
    #[inline(always)]
    pub fn flatten(&self, points: [Vec3; LANES]) -> [f32x4; 2] {
        let [a, b, c, d] = points;
        let from_origin = |p: [f32; LANES], origin: f32, rest: f32| f32x4::new(p) - origin - rest;
        let x = from_origin([a.x, b.x, c.x, d.x], self.origin.x, self.rest.x);
        let y = from_origin([a.y, b.y, c.y, d.y], self.origin.y, self.rest.y);
        let z = from_origin([a.z, b.z, c.z, d.z], self.origin.z, self.rest.z);
        both(self.axes, |axis| x * axis.x + y * axis.y + z * axis.z)
    }

    /// The points over places in the plane.
    #[inline(always)]
    fn points(&self, x: f32x4, y: f32x4, height: f32x4) -> [f32x4; 3] {
        let [u, v] = self.axes;
        let coordinate = |axis: usize| {
            let from_origin = x * u[axis] + y * v[axis] + height * self.normal[axis];
            from_origin + self.rest[axis] + self.origin[axis]
        };
        [coordinate(0), coordinate(1), coordinate(2)]
    }
}

/// Both surfaces over the contact plane.
pub(super) struct Patch<'s> {
    /// From the spaces of both shapes.
    charts: [Chart; 2],
    surfaces: [Surface<'s>; 2],
}

impl<'s> Patch<'s> {
    pub fn new<A: Polytope, B: Polytope>(
        cso: &Cso<'_, A, B>,
        proximity: &Proximity,
        normal: DVec3,
        [more_1, more_2]: &'s mut [Vec<FacePlane>; 2],
    ) -> Option<Self> {
        let frame = Frame::new(proximity.on_1, normal);
        let frame_2 = frame.seen_from_2(cso.pose);
        let plane_1 = |face| {
            let outward = cso.shape_1.face_normal(face);
            let offset = cso.shape_1.face_offset(face) - outward.dot(frame.origin);
            frame.plane(face, outward, offset, 1.0)
        };
        let plane_2 = |face| {
            let (outward, offset) = plane_of(cso.shape_2, face, &frame_2)?;
            frame_2.plane(face, outward, offset, -1.0)
        };
        let [f1, f2] = [
            facing(cso.shape_1, proximity.features[0], normal),
            facing(cso.shape_2, proximity.features[1], -frame_2.normal),
        ];
        let surfaces = [
            surface(cso.shape_1, f1, 1.0, plane_1, more_1)?,
            surface(cso.shape_2, f2, -1.0, plane_2, more_2)?,
        ];
        let charts = [frame.chart(), frame_2.chart()];
        Some(Self { charts, surfaces })
    }

    /// The corners of the intersection of both polygons.
    #[inline]
    pub fn clip<A: Polytope, B: Polytope>(&self, cso: &Cso<'_, A, B>, polygons: &mut Polygons) {
        let [f1, f2] = self.polygons();
        let (shape_1, shape_2) = (cso.shape_1, cso.shape_2);
        let [chart_1, chart_2] = &self.charts;
        polygons.window.set(shape_1.face_len(f1), |numbers| {
            chart_1.flatten(shape_1.four_corners(f1, numbers))
        });
        polygons.subject.set(shape_2.face_len(f2), |numbers| {
            chart_2.flatten(shape_2.four_corners(f2, numbers))
        });
        polygons.intersect();
    }

    /// From the first surface to the second.
    #[inline(always)]
    pub fn distances(&self, x: f32x4, y: f32x4) -> f32x4 {
        self.surfaces[1].heights(x, y) - self.surfaces[0].heights(x, y)
    }

    /// The contacts at the chosen corners of the intersection, where the surfaces are as far apart as they
    /// were measured to be, but not less than `least`. The witness is where `features` meet, at that
    /// distance.
    #[inline(always)]
    pub fn contacts<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        (least, features): (f64, [Feature; 2]),
        (polygons, candidates): (&Polygons, &Candidates),
        chosen: &Chosen,
    ) -> Contacts {
        let [chart_1, chart_2] = &self.charts;
        let mut of_corner = 0;
        let mut contacts = [features; MAX_POINTS];
        for (lane, corner) in chosen.corners[..chosen.len].iter().enumerate() {
            if let &Some(corner) = corner {
                of_corner |= 1 << lane;
                contacts[lane] = self.features(cso, polygons, corner);
            }
        }
        let of_corner = lanes(of_corner);
        let row = |of: &dyn Fn(usize) -> f32| {
            let [a, b, c, d] = chosen.corners.map(|corner| of(corner.unwrap_or(0)));
            f32x4::new([a, b, c, d])
        };
        // The witness is the origin.
        let x = of_corner & row(&|corner| polygons.corners.at(corner).x);
        let y = of_corner & row(&|corner| polygons.corners.at(corner).y);
        let height = of_corner & self.surfaces[0].heights(x, y);
        let least = f32x4::splat(least as f32);
        let measured = row(&|corner| candidates.distance(corner));
        let distance = of_corner.bitselect(measured.fast_max(least), least);
        Contacts {
            on_1: chart_1.points(x, y, height),
            on_2: chart_2.points(x, y, height + distance),
            distance,
            features: contacts,
            len: chosen.len,
        }
    }

    /// What meets at a corner of the intersection.
    #[inline(always)]
    fn features<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        polygons: &Polygons,
        corner: usize,
    ) -> [Feature; 2] {
        let [f1, f2] = self.polygons();
        let face = |side: usize| {
            let at = polygons.corners.at(corner);
            Feature::Face(self.surfaces[side].face_at(at))
        };
        match polygons.tag(corner) {
            Tag::Corner(i) => {
                let vertex = cso.shape_2.face_vertex(f2, i.into());
                [face(0), Feature::Vertex(vertex)]
            }
            Tag::Window(i) => {
                let vertex = cso.shape_1.face_vertex(f1, i.into());
                [Feature::Vertex(vertex), face(1)]
            }
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
}

/// The plane of a face of shape 2, in the frame that is given as it sees it: its outward normal, and
/// its height over the origin of the contact plane. A segment has that of its planes which leans least
/// against the contact normal; a point has none.
#[inline]
fn plane_of(shape: &impl Polytope, face: FaceId, frame: &Frame) -> Option<(DVec3, f64)> {
    match shape.face_len(face) {
        1 => None,
        2 => {
            let [from, to] = both([0, 1], |i| shape.vertex(shape.face_vertex(face, i)));
            let along = (to - from).try_normalize()?;
            let outward = (along * along.dot(frame.normal) - frame.normal).try_normalize()?;
            Some((outward, outward.dot(from - frame.origin)))
        }
        _ => {
            let outward = shape.face_normal(face);
            Some((outward, shape.face_offset(face) - outward.dot(frame.origin)))
        }
    }
}

/// The surface around `face`; none if the face is seen edge-on.
#[inline]
fn surface<'s>(
    shape: &impl Polytope,
    face: FaceId,
    sign: f32,
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
