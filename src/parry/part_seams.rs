//! Regions of a part's surface that are not on the surface of the compound, because another part covers them.
//!
//! Parry's pseudo-normals leave out faces that two parts share completely. In most decompositions, parts
//! share only regions of their faces, or overlap slightly. Then it depends on the place whether a face is
//! covered.

use std::cell::Cell;

use glam::Vec3;
use parry3d::bounding_volume::Aabb;
use parry3d::math::Pose;
use parry3d::query::details::NormalConstraints;
use parry3d::shape::{CompositeShape, Compound, CompoundPseudoNormals};

use crate::support::Support;
use crate::tolerance::{GRAZING, SEAM_INSET, SEAM_STEP, UNCORRECTED};

/// One part of a compound whose inner edges are corrected. Normals and places are in its frame.
#[derive(Clone, Copy)]
pub(crate) struct PartSeams<'a> {
    pub compound: &'a Compound,
    pub id: u32,
    pub pos: &'a Pose,
    pub normals: &'a CompoundPseudoNormals,
    /// Whether some part overlaps the other shape, but has no contact. Mostly another part has one there.
    pub is_left: &'a Cell<bool>,
}

impl<'a> PartSeams<'a> {
    /// The normals of the outer faces, and of the faces next to these.
    pub fn outer_normals(self) -> impl Iterator<Item = Vec3> + use<'a> {
        self.normals.boundary_faces.iter().flat_map(|cone| {
            let face = cone.face;
            let beside = move |half_way: &Vec3| *half_way * (2.0 * half_way.dot(face)) - face;
            std::iter::once(face).chain(cone.edge_pseudo_normals.iter().map(beside))
        })
    }

    /// Whether a normal points out of a cut, beyond which another part continues. Such a normal is
    /// perpendicular to outer faces or tilted slightly towards any of them. The tilt says nothing about the
    /// surface; the overlap does.
    pub fn is_cut(self, normal: Vec3) -> bool {
        let Some(projected) = self.normals.project_local_normal(normal) else {
            return false;
        };
        let is_outwards = self.faces().any(|face| face.dot(normal) > GRAZING as f32);
        !is_outwards || !projected.abs_diff_eq(normal, UNCORRECTED)
    }

    /// Whether other parts cover the contacts of this part, `shape`. Along the normal of a face, this is
    /// about all contacts. Any other normal was found at a corner or an edge, where only the first contact
    /// certainly lies, so it is about that one.
    pub fn are_covered(
        self,
        shape: &impl Support,
        mut places: impl Iterator<Item = Vec3>,
        normal: Vec3,
    ) -> bool {
        let own = |face: &Vec3| face.abs_diff_eq(normal, UNCORRECTED);
        if let Some(face) = self.faces().find(own) {
            return places.all(|place| self.goes_on(shape, place, face));
        }
        let Some(place) = places.next() else {
            return false;
        };
        let near = SEAM_STEP * shape.radius();
        let is_there = |face: &Vec3| {
            let outwards = face.as_dvec3();
            let beneath = || shape.extent(outwards) - outwards.dot(place.as_dvec3());
            face.dot(normal) > GRAZING as f32 && beneath() < near
        };
        let mut faces = self.faces().filter(is_there);
        faces.any(|face| self.goes_on(shape, place, face))
    }

    fn faces(self) -> impl Iterator<Item = Vec3> + use<'a> {
        self.normals.boundary_faces.iter().map(|cone| cone.face)
    }

    /// Whether another part continues beyond a face.
    fn goes_on(self, shape: &impl Support, place: Vec3, face: Vec3) -> bool {
        let radius = shape.radius() as f32;
        let to_middle = (shape.center().as_vec3() - place).reject_from_normalized(face);
        let inwards = to_middle.clamp_length_max(SEAM_INSET as f32 * radius);
        let beyond = place + inwards + face * (SEAM_STEP as f32 * radius);
        let point = self.pos.transform_point(beyond);
        let there = Aabb::new(point, point);
        let near = self.compound.bvh().intersect_aabb(&there);
        let mut others = near.filter(|other| *other != self.id);
        others.any(|other| {
            let mut is_inside = false;
            self.compound.map_part_at(other, &mut |pos, part, _| {
                is_inside = pos.is_some_and(|pos| part.contains_point(pos, point));
            });
            is_inside
        })
    }
}
