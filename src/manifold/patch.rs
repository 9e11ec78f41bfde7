//! The two surfaces in contact, seen along the contact normal.

use crate::simd::f32x4;
use glam::{DVec3, Vec2};

use super::beside;
use super::clip::{Clipper, VertexOrigin};
use super::contact_frame::{ContactFrame, FaceHeight, PlaneProjection};
use super::contacts::{Contacts, MAX_POINTS};
use super::reduce::{Candidates, Selection};
use crate::query::{Feature, Proximity};
use crate::simd::{LANES, lane_mask};
use crate::support::{Cso, FaceCorners, FaceId, Polytope};
use crate::tuning::LEVEL_SLOPE;

/// The surface of one shape: the face in contact, alone or with all faces of its cluster, or with the faces
/// beside it.
pub(super) struct ContactSurface<'s> {
    /// The face, or the outline of the cluster.
    polygon: FaceId,
    plane: FaceHeight,
    /// The planes of the other faces.
    more: &'s mut Vec<FaceHeight>,
    /// The sign of the outward normal along the contact normal.
    sign: f32,
}

impl<'s> ContactSurface<'s> {
    /// The surface around `face` over the contact plane; `None` if the face is seen edge-on.
    #[inline(always)]
    fn new(
        frame: &ContactFrame,
        shape: &impl Polytope,
        face: FaceId,
        sign: f32,
        more: &'s mut Vec<FaceHeight>,
    ) -> Option<Self> {
        more.clear();
        let plane = frame.plane(shape, face, sign)?;
        let mut polygon = face;
        if let Some((outline, faces)) = shape.cluster(face) {
            let others = faces.iter().map(|&other| FaceId::from(other));
            // Slivers have no plane. Other faces cover their area.
            let mut others =
                others.filter(|&other| other != face && shape.face_normal(other) != DVec3::ZERO);
            // A cluster that is nearly edge-on has corners over which no plane has a height.
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

    /// The surface of a convex shape is the innermost of its planes.
    #[inline(always)]
    pub fn heights(&self, x: f32x4, y: f32x4) -> f32x4 {
        let mut heights = self.plane.heights(x, y);
        for plane in self.more.iter() {
            let others = plane.heights(x, y) * self.sign;
            heights = others.fast_min(heights * self.sign) * self.sign;
        }
        heights
    }

    /// The face of the surface at a position.
    #[inline(always)]
    pub fn face_at(&self, at: Vec2) -> FaceId {
        let mut height = self.plane.height(at);
        let mut face = self.plane.face;
        for plane in self.more.iter() {
            let other = plane.height(at);
            if other * self.sign < height * self.sign {
                (height, face) = (other, plane.face);
            }
        }
        face
    }
}

/// Both surfaces over the contact plane.
pub(super) struct SurfacePair<'s> {
    /// The projections from the frames of both shapes.
    pub(super) projections: [PlaneProjection; 2],
    pub(super) surfaces: [ContactSurface<'s>; 2],
}

impl<'s> SurfacePair<'s> {
    pub fn new<A: Polytope, B: Polytope>(
        cso: &Cso<'_, A, B>,
        proximity: &Proximity,
        normal: DVec3,
        [more_1, more_2]: &'s mut [Vec<FaceHeight>; 2],
    ) -> Option<Self> {
        let frame = ContactFrame::new(proximity.on_1, normal);
        let frame_2 = frame.in_frame_2(cso.pose);
        let [f1, f2] = [
            proximity.features[0].face(cso.shape_1, normal),
            proximity.features[1].face(cso.shape_2, -frame_2.normal),
        ];
        let surfaces = [
            ContactSurface::new(&frame, cso.shape_1, f1, 1.0, more_1)?,
            ContactSurface::new(&frame_2, cso.shape_2, f2, -1.0, more_2)?,
        ];
        let projections = [frame.projection(), frame_2.projection()];
        Some(Self {
            projections,
            surfaces,
        })
    }

    /// The corners of the intersection of both polygons.
    #[inline]
    pub fn clip(
        &self,
        (window, subject): (impl FaceCorners, impl FaceCorners),
        clipper: &mut Clipper,
    ) {
        let [projection_1, projection_2] = &self.projections;
        clipper.window.set(window.count(), |numbers| {
            projection_1.flatten(numbers.map(|i| window.point(i)))
        });
        clipper.subject.set(subject.count(), |numbers| {
            projection_2.flatten(numbers.map(|i| subject.point(i)))
        });
        clipper.intersect();
    }

    /// Adds the faces beside those in contact to both surfaces, and their corners inside the other shape to
    /// the intersection. Returns whether there are any such corners.
    #[cold]
    #[inline(never)]
    pub fn widen<A: Polytope, B: Polytope>(
        &mut self,
        cso: &Cso<'_, A, B>,
        proximity: &Proximity,
        clipper: &mut Clipper,
    ) -> bool {
        let count = clipper.corners.count;
        let frame = ContactFrame::new(proximity.on_1, proximity.normal);
        self.widen_surface(0, &frame, cso.shape_1, clipper);
        self.widen_surface(1, &frame.in_frame_2(cso.pose), cso.shape_2, clipper);
        clipper.corners.count > count
    }

    /// Widens the surface of one shape. A cluster already has all its corners.
    fn widen_surface(
        &mut self,
        index: usize,
        frame: &ContactFrame,
        shape: &impl Polytope,
        clipper: &mut Clipper,
    ) {
        let surface = &mut self.surfaces[index];
        let face = surface.plane.face;
        if surface.polygon != face {
            return;
        }
        beside::add_planes(frame, shape, face, surface.sign, surface.more);
        for vertex in beside::corners(shape, face, self.surfaces[index].more) {
            let point = shape.vertex(vertex).as_vec3();
            let [x, y] = self.projections[index].flatten([point; LANES]);
            if self.distances(x, y).as_array()[0] < 0.0 {
                clipper.add_beside(index, vertex, [x, y]);
            }
        }
    }

    /// The distances from the first surface to the second.
    #[inline(always)]
    pub fn distances(&self, x: f32x4, y: f32x4) -> f32x4 {
        self.surfaces[1].heights(x, y) - self.surfaces[0].heights(x, y)
    }

    /// The contacts at the chosen corners of the intersection, with the measured distances between the
    /// surfaces, but at least `least`. The witness is where `features` meet, at the distance `least`.
    #[inline(always)]
    pub fn contacts(
        &self,
        polygons: (impl FaceCorners, impl FaceCorners),
        (least, features): (f64, [Feature; 2]),
        (clipper, candidates): (&Clipper, &Candidates),
        selection: &Selection,
    ) -> Contacts {
        let [projection_1, projection_2] = &self.projections;
        let mut of_corner = 0;
        let mut contacts = [features; MAX_POINTS];
        for (lane, corner) in selection.corners[..selection.len].iter().enumerate() {
            if let &Some(corner) = corner {
                of_corner |= 1 << lane;
                contacts[lane] = self.features(polygons, clipper, corner);
            }
        }
        let of_corner = lane_mask(of_corner);
        let [a, b, c, d] = selection.numbers().map(|corner| candidates.corner(corner));
        let [x, y, measured] = [0, 1, 2].map(|i| f32x4::new([a[i], b[i], c[i], d[i]]));
        // The witness is the origin.
        let (x, y) = (of_corner & x, of_corner & y);
        let height = of_corner & self.surfaces[0].heights(x, y);
        let least = f32x4::splat(least as f32);
        let distance = of_corner.bitselect(measured.fast_max(least), least);
        Contacts {
            on_1: projection_1.points(x, y, height),
            on_2: projection_2.points(x, y, height + distance),
            distance,
            features: contacts,
            len: selection.len,
        }
    }

    /// The features that meet at a corner of the intersection.
    #[inline(always)]
    pub fn features(
        &self,
        (window, subject): (impl FaceCorners, impl FaceCorners),
        clipper: &Clipper,
        corner: usize,
    ) -> [Feature; 2] {
        let face = |index: usize| {
            let at = clipper.corners.at(corner);
            Feature::Face(self.surfaces[index].face_at(at))
        };
        match clipper.origin(corner) {
            VertexOrigin::Subject(i) => [face(0), Feature::Vertex(subject.vertex(i.into()))],
            VertexOrigin::Window(i) => [Feature::Vertex(window.vertex(i.into())), face(1)],
            VertexOrigin::Beside(0, vertex) => [Feature::Vertex(vertex), face(1)],
            VertexOrigin::Beside(_, vertex) => [face(0), Feature::Vertex(vertex)],
            VertexOrigin::Crossing(i, j) => [
                Feature::of_side(window, i.into()),
                Feature::of_side(subject, j.into()),
            ],
        }
    }

    /// The faces in contact, or the outlines of their clusters.
    #[inline]
    pub fn polygons<'a, A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'a, A, B>,
    ) -> (
        impl FaceCorners + use<'a, A, B>,
        impl FaceCorners + use<'a, A, B>,
    ) {
        let [f1, f2] = [self.surfaces[0].polygon, self.surfaces[1].polygon];
        (cso.shape_1.face_corners(f1), cso.shape_2.face_corners(f2))
    }
}
