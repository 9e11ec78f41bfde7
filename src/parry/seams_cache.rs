//! Pseudo-normals for the seams of compounds, where parry computes none.
//!
//! Parry computes them when a compound is made, for parts that it can downcast. It cannot downcast a
//! `HullShape`, and computes none for a loaded compound. So they are computed here for a copy of the compound
//! with plain hulls, and stored per thread, by the compound's address. Each use compares the parts: the cache
//! is a pure function of the shapes.

use std::sync::Arc;

use parry3d::math::Pose;
use parry3d::shape::{Compound, CompoundPseudoNormals, SharedShape};

use crate::parry::hull_shape::plain;
use crate::parry::int_hash::IntMap;

/// The pseudo-normals of each part that has any.
pub(crate) type PartNormals = Arc<[Option<CompoundPseudoNormals>]>;

/// The pseudo-normals of a thread's compounds.
#[derive(Default)]
pub(crate) struct SeamsCache {
    known: IntMap<usize, Known>,
    /// With more compounds than this, unused ones are dropped.
    room: usize,
}

struct Known {
    parts: Vec<(Pose, SharedShape)>,
    normals: PartNormals,
    is_used: bool,
}

/// Up to this number of compounds, nothing is dropped.
const LEAST_ROOM: usize = 64;

impl SeamsCache {
    pub fn find(&mut self, compound: &Compound) -> PartNormals {
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

    /// Whether the compound has the same parts. The cache holds references to them, so they cannot have changed.
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
    use parry3d::shape::CompoundFlags;

    use super::*;
    use crate::parry::hull_shape::HullShape;

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
