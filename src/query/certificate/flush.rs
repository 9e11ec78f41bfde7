//! Two faces that lie flush on each other, as those of bodies at rest do.
//!
//! All corners of their patch are about equally deep, and trembling decides which of them is the deepest. So
//! the features of one corner prove little from one frame to the next. But each place over both faces bounds
//! the distance from above.
//!
//! Where the shapes overlap, the faces prove a depth as well. The differences of their points around a place in
//! the middle fill a disc. The deepest point is above it, by the angle between the faces times its radius, and
//! the flat cone between them lies in the Minkowski difference, as does the one from the disc to its centre.
//! The ball of the depth looks out of the flat cone by that angle squared only.

use glam::DVec3;

use super::polygon::{cone_contains_ball, inset, inset_of_quadrilateral};
use crate::map_pair::map_pair;
use crate::query::feature::Feature;
use crate::query::last_contacts::LastContacts;
use crate::query::types::{Proximity, Query};
use crate::support::{Cso, FaceId, Polytope};
use crate::tolerance::KEPT_ANGLE_COS;
use crate::tuning::FLUSH_TIE;

/// A face of each shape, and the contacts between them.
pub(crate) struct FlushFaces {
    pub faces: [FaceId; 2],
    pub contacts: LastContacts,
}

/// Points of the planes of both faces on one line along a normal, each in the frame of its shape.
struct PointPair {
    on_planes: [DVec3; 2],
    /// From the first to the second.
    distance: f64,
}

impl<A: Polytope, B: Polytope> Query<'_, '_, A, B> {
    /// Answers with flush faces alone. The plane of one of them bounds the distance from below, both faces together
    /// bound it from above. `features` are those of the deepest contact.
    pub(in crate::query) fn certify_flush(
        &mut self,
        features: [Feature; 2],
        flush: &FlushFaces,
    ) -> Option<Proximity> {
        // The face that a corner of the other one touches is likely the one whose plane supports the difference.
        let first = usize::from(matches!(features[1], Feature::Face(_)));
        [first, 1 - first]
            .into_iter()
            .find_map(|side| self.certify_face(side, features, flush))
    }

    /// Answers with the plane of the face on one side.
    fn certify_face(
        &mut self,
        side: usize,
        features: [Feature; 2],
        flush: &FlushFaces,
    ) -> Option<Proximity> {
        let (normal, signed_distance) = self.distance_to_face(side, features, flush.faces);
        if signed_distance > self.max_distance || !flush.are_along(self.cso, normal) {
            return None;
        }
        let most = signed_distance + self.tolerance();
        let tie = FLUSH_TIE * self.tolerance();
        let place = flush.place_within(self.cso, normal, most, tie)?;
        Some(Proximity {
            signed_distance,
            normal,
            on_1: place,
            on_2: place + normal * signed_distance,
            features: flush.faces.map(Feature::Face),
        })
    }

    /// The normal of the face on one side, in frame 1 from shape 1 to shape 2, and the signed distance of the other
    /// shape from its plane.
    #[inline]
    fn distance_to_face(
        &mut self,
        side: usize,
        features: [Feature; 2],
        [face_1, face_2]: [FaceId; 2],
    ) -> (DVec3, f64) {
        let Cso {
            shape_1,
            shape_2,
            pose,
        } = self.cso;
        if side == 0 {
            let normal = shape_1.face_normal(face_1);
            let start = features[1].vertex(*shape_2);
            let (on_2, _) = shape_2.support(-pose.direction_to_2(normal), start, self.cost);
            let height = normal.dot(pose.point_to_1(on_2));
            (normal, height - shape_1.face_offset(face_1))
        } else {
            let outward = shape_2.face_normal(face_2);
            let normal = -pose.direction_to_1(outward);
            let start = features[0].vertex(*shape_1);
            let (on_1, _) = shape_1.support(normal, start, self.cost);
            let height = outward.dot(pose.point_to_2(on_1));
            (normal, height - shape_2.face_offset(face_2))
        }
    }

    /// Whether flush faces prove that no direction has a smaller depth than the candidate.
    pub(in crate::query) fn is_depth(&self, candidate: &Proximity, flush: &FlushFaces) -> bool {
        let (normal, deepest) = (candidate.normal, candidate.signed_distance);
        if !flush.are_along(self.cso, normal) {
            return false;
        }
        let middle = flush.points_at(self.cso, normal, flush.contacts.middle());
        flush.prove_depth(
            self.cso,
            normal,
            &middle,
            [deepest, deepest + self.tolerance()],
        )
    }
}

impl FlushFaces {
    /// A place over both faces, which look along a normal, that proves the signed distance of the shapes to be `most`
    /// or less. It is in the middle of all contacts, or of those that tie for the deepest.
    fn place_within<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        most: f64,
        tie: f64,
    ) -> Option<DVec3> {
        let place = self.contacts.middle();
        let middle = self.points_at(cso, normal, place);
        if middle.distance <= most {
            let is_proved = if most < 0.0 {
                self.prove_depth(cso, normal, &middle, [middle.distance, most])
            } else {
                self.are_inside(cso, &middle)
            };
            return is_proved.then_some(place);
        }
        let place = self.contacts.middle_of_deepest(normal, tie);
        let points = self.points_at(cso, normal, place);
        let is_proved = points.distance <= most
            && self.are_inside(cso, &points)
            && (most >= 0.0 || self.prove_depth(cso, normal, &middle, [points.distance, most]));
        is_proved.then_some(place)
    }

    /// Whether no direction has a smaller depth than `-most`, if the points over the origin along a normal have
    /// the signed distance `deepest`. The disc is around those in the `middle`.
    fn prove_depth<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        middle: &PointPair,
        [deepest, most]: [f64; 2],
    ) -> bool {
        let [face_1, face_2] = self.faces;
        let normals = [
            cso.shape_1.face_normal(face_1),
            cso.pose.direction_to_1(cso.shape_2.face_normal(face_2)),
        ];
        let [cos_1, cos_2] = map_pair(normals, |n| n.dot(normal).abs());
        let [sin_1, sin_2] = map_pair(normals, |n| n.cross(normal).length());
        let proves = |[inset_1, inset_2]: [f64; 2]| {
            let radius = inset_1 * cos_1 + inset_2 * cos_2;
            let beneath = middle.distance - deepest + inset_1 * sin_1 + inset_2 * sin_2;
            let tangent = beneath / radius;
            deepest - 0.5 * deepest * tangent * tangent <= most
                && cone_contains_ball(radius, -most, cso.center(), normal)
        };
        // A disc that is half as large mostly proves as much.
        let few = self.insets(cso, middle, inset_of_quadrilateral, inset_of_quadrilateral);
        few.is_some_and(proves) || self.insets(cso, middle, inset, inset).is_some_and(proves)
    }

    /// Whether both faces look along a normal.
    #[inline]
    fn are_along<A: Polytope, B: Polytope>(&self, cso: &Cso<'_, A, B>, normal: DVec3) -> bool {
        let [face_1, face_2] = self.faces;
        let normal_2 = cso.pose.direction_to_2(normal);
        // A sliver has no plane and no normal.
        cso.shape_1.face_normal(face_1).dot(normal) > KEPT_ANGLE_COS
            && cso.shape_2.face_normal(face_2).dot(normal_2) < -KEPT_ANGLE_COS
    }

    /// The points of both planes at a place, of faces that look along the normal.
    fn points_at<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        normal: DVec3,
        place: DVec3,
    ) -> PointPair {
        let [face_1, face_2] = self.faces;
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

    /// Whether points of the planes are inside of the faces. Quadrilaterals within these mostly prove that.
    fn are_inside<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        points: &PointPair,
    ) -> bool {
        let few = self.insets(cso, points, inset_of_quadrilateral, inset_of_quadrilateral);
        few.is_some() || self.insets(cso, points, inset, inset).is_some()
    }

    /// How far points of the planes are inside of the faces, if they are.
    fn insets<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        points: &PointPair,
        inset_1: impl Fn(&A, FaceId, DVec3, DVec3, f64) -> f64,
        inset_2: impl Fn(&B, FaceId, DVec3, DVec3, f64) -> f64,
    ) -> Option<[f64; 2]> {
        let [face_1, face_2] = self.faces;
        let [on_1, on_2] = points.on_planes;
        let inset_1 = inset_1(
            cso.shape_1,
            face_1,
            cso.shape_1.face_normal(face_1),
            on_1,
            0.0,
        );
        let inset_2 = inset_2(
            cso.shape_2,
            face_2,
            cso.shape_2.face_normal(face_2),
            on_2,
            0.0,
        );
        (inset_1 > 0.0 && inset_2 > 0.0).then_some([inset_1, inset_2])
    }
}
