//! What corrects normals at the seams of a flagged compound.
//!
//! Parry computes it when the compound is made, for parts that it can downcast. A `HullShape` is none of
//! these, and neither is what a save of such a compound is loaded as. So it is computed here for a
//! compound with plain hulls in their place, and kept per thread, by the compound's address. The parts
//! are compared at each use: what is kept is a pure function of the shapes.

use std::sync::Arc;

use parry3d::bounding_volume::Aabb;
use parry3d::math::Pose;
use parry3d::shape::{
    Compound, CompoundFlags, CompoundPseudoNormals, ConvexPolyhedron, SharedShape,
};

use crate::parry::constraints::Constraints;
use crate::parry::hull_shape::HullShape;
use crate::parry::int_hash::IntMap;
use crate::parry::part_seams::PartSeams;
use crate::parry::workspace::ThreadWorkspace;

type PartNormals = Arc<[Option<CompoundPseudoNormals>]>;

/// Those of one compound.
pub(super) struct Seams<'a> {
    compound: &'a Compound,
    /// In the place of parry's own.
    computed: Option<PartNormals>,
}

impl<'a> Seams<'a> {
    /// For the parts of a compound in a box.
    pub fn near(compound: &'a Compound, aabb: &Aabb) -> Self {
        let is_left_out = |part: u32| {
            compound.part_normal_constraints(part).is_none()
                && polyhedron(&compound.shapes()[part as usize].1).is_some()
        };
        let is_flagged = compound.flags().contains(CompoundFlags::FIX_INTERNAL_EDGES);
        let is_incomplete = is_flagged && compound.bvh().intersect_aabb(aabb).any(is_left_out);
        let compute = || ThreadWorkspace::with(|thread| thread.seams.find(compound));
        Self {
            compound,
            computed: is_incomplete.then(compute),
        }
    }

    /// Of the part at `pos`.
    pub fn of_part<'s>(&'s self, id: u32, pos: &'s Pose) -> Constraints<'s> {
        let compound = self.compound;
        let normals = match &self.computed {
            Some(normals) => normals[id as usize].as_ref(),
            None => compound.part_normal_constraints(id),
        };
        let seams = |normals| PartSeams {
            compound,
            id,
            pos,
            normals,
        };
        normals.map_or(Constraints::None, |normals| {
            Constraints::OfPart(seams(normals))
        })
    }
}

/// The hull that parry can take for one, if the part is a hull without a rounded border.
fn polyhedron(part: &SharedShape) -> Option<&ConvexPolyhedron> {
    let prepared = || part.as_shape().map(HullShape::polyhedron);
    part.as_shape().or_else(prepared)
}

/// Those of a thread's compounds.
#[derive(Default)]
pub(crate) struct SeamsCache {
    known: IntMap<usize, Known>,
    /// How many there may be before those go that are not in use.
    room: usize,
}

struct Known {
    parts: Vec<(Pose, SharedShape)>,
    normals: PartNormals,
    is_used: bool,
}

/// As many compounds may have seams without anything being dropped.
const LEAST_ROOM: usize = 64;

impl SeamsCache {
    fn find(&mut self, compound: &Compound) -> PartNormals {
        let address = (&raw const *compound).addr();
        if let Some(known) = self.known.get_mut(&address)
            && known.is_of(compound)
        {
            known.is_used = true;
            return known.normals.clone();
        }
        if self.known.len() >= self.room {
            self.known
                .retain(|_, known| std::mem::take(&mut known.is_used));
            self.room = LEAST_ROOM.max(2 * self.known.len());
        }
        let known = Known::new(compound);
        let normals = known.normals.clone();
        self.known.insert(address, known);
        normals
    }
}

impl Known {
    #[cold]
    fn new(compound: &Compound) -> Self {
        let plain = |part: &SharedShape| match part.as_shape().map(HullShape::polyhedron) {
            Some(polyhedron) => SharedShape::new(polyhedron.clone()),
            None => part.clone(),
        };
        let parts = compound.shapes();
        let twins = parts.iter().map(|(pos, part)| (*pos, plain(part)));
        let twin = Compound::with_flags(twins.collect(), compound.flags(), None);
        let ids = (0..).zip(parts);
        let normals = ids.map(|(id, _)| twin.part_normal_constraints(id).cloned());
        Self {
            parts: parts.to_vec(),
            normals: normals.collect(),
            is_used: true,
        }
    }

    /// Whether the compound has the same parts. They are held here, so nobody has changed them.
    fn is_of(&self, compound: &Compound) -> bool {
        let mut both = self.parts.iter().zip(compound.shapes());
        self.parts.len() == compound.shapes().len()
            && both.all(|((pos, part), (other_pos, other))| {
                pos == other_pos && Arc::ptr_eq(&part.0, &other.0)
            })
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn cubes(distance: f32) -> Compound {
        let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        let corners: Vec<Vec3> = (0..8).map(corner).collect();
        let cube = SharedShape::new(HullShape::from_points(&corners).expect("a cube"));
        let parts = [0.0, distance].map(|x| (Pose::translation(x, 0.0, 0.0), cube.clone()));
        Compound::with_flags(parts.to_vec(), CompoundFlags::FIX_INTERNAL_EDGES, None)
    }

    #[test]
    fn seams_are_those_of_the_present_parts() {
        let mut cache = SeamsCache::default();
        // At the same address.
        let mut compound = Box::new(cubes(2.0));
        for (distance, outer) in [(1.0, 5), (1.5, 6), (1.0, 5)] {
            *compound = cubes(distance);
            for _ in 0..2 {
                let normals = cache.find(&compound);
                let faces = normals[0].as_ref().map(|part| part.boundary_faces.len());
                assert_eq!(faces, Some(outer), "{distance}");
            }
        }
    }
}
