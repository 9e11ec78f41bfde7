//! The two surfaces in contact, seen along the contact normal.

use glam::{DVec3, Vec2};
use wide::f32x4;

use super::Chosen;
use super::clip::{Polygons, Tag};
use super::contacts::{Contacts, MAX_POINTS};
use super::plane::{Chart, FacePlane, Frame};
use super::polygon::lanes;
use super::reduce::Candidates;
use crate::query::{Feature, Proximity};
use crate::support::{Cso, FaceId, Polytope};
use crate::tuning::LEVEL_SLOPE;

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

impl<'s> Surface<'s> {
    /// That around `face` over the contact plane; none if the face is seen edge-on.
    #[inline(always)]
    fn new(
        frame: &Frame,
        shape: &impl Polytope,
        face: FaceId,
        sign: f32,
        more: &'s mut Vec<FacePlane>,
    ) -> Option<Self> {
        more.clear();
        let plane = frame.plane(shape, face, sign)?;
        let mut polygon = face;
        if let Some((outline, faces)) = shape.cap(face) {
            let others = faces.iter().map(|&other| FaceId::from(other));
            // Slivers have no plane, and what they cover others do.
            let mut others =
                others.filter(|&other| other != face && shape.face_normal(other) != DVec3::ZERO);
            // A cap that turns edge-on has corners at which no plane tells its height.
            let is_level = plane.slope_squared() < LEVEL_SLOPE * LEVEL_SLOPE;
            let is_whole = others.all(|other| {
                let other = frame.plane(shape, other, sign);
                more.extend(other);
                is_level || other.is_some()
            });
            if is_whole {
                polygon = outline;
            } else {
                more.clear();
            }
        }
        Some(Self {
            polygon,
            plane,
            more,
            sign,
        })
    }

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
        let [f1, f2] = [
            facing(cso.shape_1, proximity.features[0], normal),
            facing(cso.shape_2, proximity.features[1], -frame_2.normal),
        ];
        let surfaces = [
            Surface::new(&frame, cso.shape_1, f1, 1.0, more_1)?,
            Surface::new(&frame_2, cso.shape_2, f2, -1.0, more_2)?,
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
        let [a, b, c, d] = chosen.numbers();
        let at = |corner| polygons.corners.at(corner);
        let [at_a, at_b, at_c, at_d] = [at(a), at(b), at(c), at(d)];
        // The witness is the origin.
        let x = of_corner & f32x4::new([at_a.x, at_b.x, at_c.x, at_d.x]);
        let y = of_corner & f32x4::new([at_a.y, at_b.y, at_c.y, at_d.y]);
        let height = of_corner & self.surfaces[0].heights(x, y);
        let least = f32x4::splat(least as f32);
        let far = |corner| candidates.distance(corner);
        let measured = f32x4::new([far(a), far(b), far(c), far(d)]);
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

/// The face that is in contact: the feature itself, or that next to it which faces the other
/// shape most.
#[inline]
fn facing(shape: &impl Polytope, feature: Feature, outward: DVec3) -> FaceId {
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
