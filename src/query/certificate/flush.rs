//! Two faces that lie flush on each other, as those of bodies at rest do.
//!
//! All corners of their patch are about equally deep, and lie on the borders of both faces. So the facet of the deepest
//! corner proves little by itself: the origin projects onto its border, or a little beside it.
//!
//! But the differences of points of both faces, around a place in the middle, fill a disc across the normal. A segment
//! from the deepest vertex to that disc passes over the origin. There it is as deep as the vertex, except for the slope
//! of the faces over the distance of the vertex from the face.
//!
//! Where the shapes overlap, this also proves a depth. The flat cone from that point to the disc lies in the Minkowski
//! difference, and so does the cone from the disc to the centre. The ball of that depth sticks out of the flat cone by
//! no more than the square of the angle between the faces.

use glam::DVec3;

use super::polygon::{Corners, cone_contains_ball, distance_beside, inset_in};
use crate::map_pair::map_pair;
use crate::pose::RelativePose;
use crate::query::types::Proximity;
use crate::simd::LANES;
use crate::support::{Cso, FaceId, Polytope, Support};
use crate::tolerance::{DEPTH_GAP, KEPT_ANGLE_COS};

/// A face of each shape, and the middle of the contacts between them, in frame 1.
pub(crate) struct FlushFaces {
    pub faces: [FaceId; 2],
    pub middle: DVec3,
}

/// The points in which a line along a normal meets the planes of both faces, each in the frame of its shape.
struct PointPair {
    on_planes: [DVec3; 2],
    /// From the first to the second.
    distance: f64,
}

/// Differences of points of both shapes: a disc across a normal, around the line through the origin along it. Heights
/// are given as distances between the shapes.
pub(crate) struct Disc {
    pub radius: f64,
    /// The greatest distance in the disc.
    pub highest: f64,
}

impl FlushFaces {
    /// The same in the frame of the second shape, with the shapes in the other order.
    #[inline]
    pub fn reversed(&self, pose: &RelativePose) -> Self {
        let [face_1, face_2] = self.faces;
        Self {
            faces: [face_2, face_1],
            middle: pose.point_to_2(self.middle),
        }
    }

    /// Whether the signed distance of the shapes is at most `most`. The vertex of shape 2 that is deepest beneath the
    /// plane of the face of shape 1 is at `signed_distance` from that plane, over the face or a little beside it.
    // perf: inlined, it keeps the query around it from being inlined: 2 % more instructions in touching/8.
    #[inline(never)]
    pub fn prove_vertex<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        (vertex, is_over): (DVec3, bool),
        signed_distance: f64,
        most: f64,
    ) -> bool {
        let face = self.faces[0];
        let normal = cso.shape_1.face_normal(face);
        if !self.are_along(cso, normal) {
            return false;
        }
        let middle = self.points_at(cso, normal);
        let inside = middle.on_planes[0];
        let beside = if is_over {
            0.0
        } else {
            distance_beside(cso.shape_1, face, normal, inside, vertex)
        };
        self.some_disc(cso, normal, &middle, |disc| {
            let over_origin = disc.over_origin(signed_distance, beside);
            over_origin <= most && disc.proves(cso, normal, over_origin, most)
        })
    }

    /// Whether these faces prove that no direction has a smaller depth than the candidate.
    pub fn is_depth<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        candidate: &Proximity,
    ) -> bool {
        let (normal, deepest) = (candidate.normal, candidate.signed_distance);
        let most = deepest + DEPTH_GAP * cso.min_radius();
        self.are_along(cso, normal)
            && self.some_disc(cso, normal, &self.points_at(cso, normal), |disc| {
                disc.proves(cso, normal, deepest, most)
            })
    }

    /// Whether both faces are nearly square to a normal, and face each other.
    #[inline]
    fn are_along<A: Polytope, B: Polytope>(&self, cso: &Cso<'_, A, B>, normal: DVec3) -> bool {
        let [face_1, face_2] = self.faces;
        let normal_2 = cso.pose.direction_to_2(normal);
        // A sliver has no plane and no normal.
        cso.shape_1.face_normal(face_1).dot(normal) > KEPT_ANGLE_COS
            && cso.shape_2.face_normal(face_2).dot(normal_2) < -KEPT_ANGLE_COS
    }

    /// The points of both planes in the middle of the contacts. Both faces must be nearly square to the normal.
    #[inline]
    fn points_at<A: Polytope, B: Polytope>(&self, cso: &Cso<'_, A, B>, normal: DVec3) -> PointPair {
        let ([face_1, face_2], place) = (self.faces, self.middle);
        let height = |outward: DVec3, offset: f64, normal: DVec3, place: DVec3| {
            (offset - outward.dot(place)) / outward.dot(normal)
        };
        let (normal_2, place_2) = (cso.pose.direction_to_2(normal), cso.pose.point_to_2(place));
        let (n1, n2) = (
            cso.shape_1.face_normal(face_1),
            cso.shape_2.face_normal(face_2),
        );
        let height_1 = height(n1, cso.shape_1.face_offset(face_1), normal, place);
        let height_2 = height(n2, cso.shape_2.face_offset(face_2), normal_2, place_2);
        PointPair {
            on_planes: [place + normal * height_1, place_2 + normal_2 * height_2],
            distance: height_2 - height_1,
        }
    }

    /// Whether some disc around the middle passes a test. The first one lies in quadrilaterals within the faces. It is
    /// half as large as the second, and usually suffices.
    fn some_disc<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        middle: &PointPair,
        proves: impl Fn(&Disc) -> bool,
    ) -> bool {
        let [face_1, face_2] = self.faces;
        let disc = |corners| {
            let insets = self.insets(cso, middle, corners)?;
            Some(self.disc(cso, normal, middle, insets))
        };
        if disc(Corners::Four).is_some_and(|disc| proves(&disc)) {
            return true;
        }
        let has_more = cso
            .shape_1
            .face_len(face_1)
            .max(cso.shape_2.face_len(face_2))
            > LANES;
        has_more && disc(Corners::All).is_some_and(|disc| proves(&disc))
    }

    /// The disc around points in the middle of both faces, with their distances from the borders of these.
    #[inline]
    fn disc<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        middle: &PointPair,
        [inset_1, inset_2]: [f64; 2],
    ) -> Disc {
        let [face_1, face_2] = self.faces;
        let normals = [
            cso.shape_1.face_normal(face_1),
            cso.pose.direction_to_1(cso.shape_2.face_normal(face_2)),
        ];
        let [cos_1, cos_2] = map_pair(normals, |n| n.dot(normal).abs());
        let [sin_1, sin_2] = map_pair(normals, |n| n.cross(normal).length());
        Disc {
            radius: inset_1 * cos_1 + inset_2 * cos_2,
            highest: middle.distance + inset_1 * sin_1 + inset_2 * sin_2,
        }
    }

    /// The distances of points of the planes from the borders of the faces, if they are inside.
    #[inline]
    fn insets<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        points: &PointPair,
        corners: Corners,
    ) -> Option<[f64; 2]> {
        let ([face_1, face_2], [on_1, on_2]) = (self.faces, points.on_planes);
        let (normal_1, normal_2) = (
            cso.shape_1.face_normal(face_1),
            cso.shape_2.face_normal(face_2),
        );
        let (shape_1, shape_2) = (cso.shape_1, cso.shape_2);
        let inset_1 = inset_in(
            shape_1.face_corners(face_1),
            shape_1.radius(),
            normal_1,
            on_1,
            0.0,
            corners,
        );
        if inset_1 <= 0.0 {
            return None;
        }
        let inset_2 = inset_in(
            shape_2.face_corners(face_2),
            shape_2.radius(),
            normal_2,
            on_2,
            0.0,
            corners,
        );
        (inset_2 > 0.0).then_some([inset_1, inset_2])
    }
}

impl Disc {
    /// Where a point of the difference at a signed distance, `beside` the line through the origin, leads to the line: the
    /// segment from there to the opposite side of the disc crosses it.
    #[inline]
    pub fn over_origin(&self, signed_distance: f64, beside: f64) -> f64 {
        let lift = (self.highest - signed_distance).max(0.0);
        signed_distance + lift * beside / (beside + self.radius)
    }

    /// Whether no direction has a smaller depth than `-most`, given a point of the difference over the origin, along a
    /// normal, at the signed distance `over_origin`.
    #[inline]
    pub fn proves<A: Support, B: Support>(
        &self,
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        over_origin: f64,
        most: f64,
    ) -> bool {
        let tangent = (self.highest - over_origin) / self.radius;
        most >= 0.0
            || over_origin - 0.5 * over_origin * tangent * tangent <= most
                && cone_contains_ball(self.radius, -most, cso.center(), normal)
    }
}
