//! Corrections of normals at the seams between a compound's parts.

use std::cell::Cell;

use parry3d::bounding_volume::Aabb;
use parry3d::math::Pose;
use parry3d::shape::{Compound, CompoundFlags, ConvexPolyhedron, SharedShape};

use crate::at::At;
use crate::parry::constraints::Constraints;
use crate::parry::hull_shape::HullShape;
use crate::parry::part_seams::PartSeams;
use crate::parry::seams_cache::PartNormals;
use crate::parry::workspace::ThreadWorkspace;

/// The seams of one compound.
pub(super) struct Seams<'a> {
    compound: &'a Compound,
    /// In the place of parry's own.
    computed: Option<PartNormals>,
    is_left: Cell<bool>,
}

impl<'a> Seams<'a> {
    /// The seams of the parts that meet a box.
    pub fn near(compound: &'a Compound, aabb: &Aabb) -> Self {
        let is_left_out = |part: u32| {
            compound.part_normal_constraints(part).is_none()
                && polyhedron(&compound.shapes().at_ref(part).1).is_some()
        };
        let is_flagged = compound.flags().contains(CompoundFlags::FIX_INTERNAL_EDGES);
        let is_incomplete = is_flagged && compound.bvh().intersect_aabb(aabb).any(is_left_out);
        let compute = || ThreadWorkspace::with(|thread| thread.seams.find(compound));
        Self {
            compound,
            computed: is_incomplete.then(compute),
            is_left: Cell::new(false),
        }
    }

    /// Whether some part overlaps the other shape, but has no contact along a corrected normal.
    pub fn leave_some(&self) -> bool {
        self.is_left.get()
    }

    /// The corrections for the part at `pos`.
    pub fn of_part<'s>(&'s self, id: u32, pos: &'s Pose) -> Constraints<'s> {
        let compound = self.compound;
        let normals = match &self.computed {
            Some(normals) => normals.at_ref(id).as_ref(),
            None => compound.part_normal_constraints(id),
        };
        let seams = |normals| PartSeams {
            compound,
            id,
            pos,
            normals,
            is_left: &self.is_left,
        };
        normals.map_or(Constraints::None, |normals| {
            Constraints::OfPart(seams(normals))
        })
    }
}

/// The polyhedron of a part that is a hull without a rounded border, for parry's routines.
fn polyhedron(part: &SharedShape) -> Option<&ConvexPolyhedron> {
    let prepared = || part.as_shape().and_then(HullShape::polyhedron);
    part.as_shape().or_else(prepared)
}
