//! Preparing the hulls of a whole world.

use std::collections::HashMap;
use std::sync::Arc;

use parry3d::shape::{Compound, CompoundFlags, ConvexPolyhedron, SharedShape};

use super::HullShape;
use crate::hull::HullError;
use crate::hull::build::identity::{fingerprint, same_polyhedron};

/// Replaces plain hulls by [`HullShape`]s, including parts of compounds, for worlds that were loaded or built
/// by others. Colliders that share a shape, or have equal hulls, share the new one: in a loaded world each
/// collider has its own shape.
///
/// ```
/// use isa_gjk::{HullShape, PreparedShapes};
/// use rapier3d::prelude::*;
///
/// # let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
/// # let hull = SharedShape::convex_hull(&corners).unwrap();
/// # let mut world = PhysicsWorld::default();
/// # for _ in 0..2 {
/// #     world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::new(hull.clone()));
/// # }
/// let mut prepared = PreparedShapes::default();
/// for (_, collider) in world.colliders.iter_mut() {
///     let shape = prepared.prepare(collider.shared_shape());
///     collider.set_shape(shape);
/// }
/// # for (_, collider) in world.colliders.iter() {
/// #     assert!(collider.shape().as_shape::<HullShape>().is_some());
/// # }
/// ```
#[derive(Default)]
pub struct PreparedShapes {
    /// Replacements by the address of the old shape.
    known: HashMap<usize, Replacement>,
    /// Hull shapes by the fingerprint of the polyhedron.
    hulls: HashMap<u64, Vec<SharedShape>>,
    refused: Vec<HullError>,
}

struct Replacement {
    prepared: SharedShape,
    /// Kept so that no other shape reuses its address.
    _original: SharedShape,
}

impl PreparedShapes {
    /// The shape with its plain hulls prepared, or the shape itself if none of them can be. Round hulls stay
    /// as they are. Compounds with [`CompoundFlags::FIX_INTERNAL_EDGES`] get plain hulls in place of
    /// `HullShape`s, since parry smooths only these, and parry's default weld tolerance.
    pub fn prepare(&mut self, shape: &SharedShape) -> SharedShape {
        let address = Arc::as_ptr(&shape.0).addr();
        if let Some(known) = self.known.get(&address) {
            return known.prepared.clone();
        }
        let prepared = self.replacement(shape).unwrap_or_else(|| shape.clone());
        let known = Replacement {
            prepared: prepared.clone(),
            _original: shape.clone(),
        };
        self.known.insert(address, known);
        prepared
    }

    /// Why each of the other plain hulls was not replaced.
    pub fn refused(&self) -> &[HullError] {
        &self.refused
    }

    fn replacement(&mut self, shape: &SharedShape) -> Option<SharedShape> {
        if let Some(polyhedron) = shape.as_convex_polyhedron() {
            return self.hull(polyhedron);
        }
        let compound = shape.as_compound()?;
        if compound.flags().contains(CompoundFlags::FIX_INTERNAL_EDGES) {
            return with_parts(compound, plain);
        }
        with_parts(compound, |part| self.prepare(part))
    }

    /// A `HullShape` of this polyhedron, or of an equal one.
    fn hull(&mut self, polyhedron: &ConvexPolyhedron) -> Option<SharedShape> {
        let alike = self.hulls.entry(fingerprint(polyhedron)).or_default();
        let of_this = |shape: &&SharedShape| {
            let hull = shape.as_shape::<HullShape>();
            let known = hull.and_then(HullShape::polyhedron);
            known.is_some_and(|known| same_polyhedron(known, polyhedron))
        };
        if let Some(known) = alike.iter().find(of_this) {
            return Some(known.clone());
        }
        match HullShape::try_from(polyhedron.clone()) {
            Ok(hull) => {
                let shape = SharedShape::new(hull);
                alike.push(shape.clone());
                Some(shape)
            }
            Err(error) => {
                self.refused.push(error);
                None
            }
        }
    }
}

/// A compound whose parts are replaced; `None` if each stays as it is.
fn with_parts(
    compound: &Compound,
    mut replace: impl FnMut(&SharedShape) -> SharedShape,
) -> Option<SharedShape> {
    let parts = compound.shapes();
    let replaced: Vec<_> = parts
        .iter()
        .map(|(pose, part)| (*pose, replace(part)))
        .collect();
    let is_new = parts
        .iter()
        .zip(&replaced)
        .any(|((_, old), (_, new))| !Arc::ptr_eq(&old.0, &new.0));
    is_new.then(|| SharedShape::new(Compound::with_flags(replaced, compound.flags(), None)))
}

/// A plain hull in place of a `HullShape`; other shapes as they are.
pub(crate) fn plain(part: &SharedShape) -> SharedShape {
    let hull = part.as_shape::<HullShape>();
    match hull.and_then(HullShape::polyhedron) {
        Some(polyhedron) => SharedShape::new(polyhedron.clone()),
        None => part.clone(),
    }
}
