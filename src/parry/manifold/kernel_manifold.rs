//! A pair's memory, kept in its contact manifold.
//!
//! Manifolds are saved, cloned and pooled with the world, exist for the parts of composite shapes, and cost
//! rapier nothing; a workspace would make it rebuild its solver graph in every step. So the memory is in
//! unused fields of the manifold:
//!
//! - without points, `local_n1` is the separating axis (as in parry) in an [`AxisFrame`], or zero if none was
//!   needed: the bounding spheres are apart since the last contact. `local_n2`, which is unused then, contains
//!   two vertices as whole numbers, which were extreme when the axis was found;
//! - with points, `local_n1` is the contact normal, and the feature ids of the first point are the features
//!   in contact.
//!
//! Anything that another dispatcher or another pair left there is only a hint.

use glam::{DVec3, Vec3};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use crate::map_pair::map_pair;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::pose::{RelativePose, is_unit};
use crate::query::{ContactId, Feature, LastContacts, PairMemory};
use crate::support::{Cso, Support, VertexId};
use crate::tolerance::NEARLY_UNIT;

/// The shape in whose frame a pair keeps its separating axis.
#[derive(Clone, Copy)]
pub(super) enum AxisFrame<'a> {
    /// The kernels' first shape.
    First,
    /// Their second shape, with its pose in the frame of the first.
    Second(&'a RelativePose),
}

impl<'a> AxisFrame<'a> {
    /// The frame of the larger shape. If sizes differ, mostly the small shape tumbles over a floor or along a
    /// wall, and in the frame of these the axis does not move.
    #[inline]
    pub fn of<A: Support, B: Support>(cso: &Cso<'a, A, B>) -> Self {
        if cso.shape_2.radius() > cso.shape_1.radius() {
            Self::Second(cso.pose)
        } else {
            Self::First
        }
    }

    /// The greatest distance of a point of the other shape from the centre of its rotation.
    pub fn lever<A: Support, B: Support>(self, cso: &Cso<'_, A, B>) -> f64 {
        match self {
            Self::First => cso.shape_2.center().length() + cso.shape_2.radius(),
            Self::Second(pose) => {
                (cso.shape_1.center() - pose.translation()).length() + cso.shape_1.radius()
            }
        }
    }

    /// Converts from the frame of the kernels' first shape.
    #[inline]
    fn to_stored(self, axis: DVec3) -> DVec3 {
        match self {
            Self::First => axis,
            Self::Second(pose) => pose.direction_to_2(axis),
        }
    }

    /// Converts to the frame of the kernels' first shape.
    #[inline]
    fn to_kernel(self, axis: DVec3) -> DVec3 {
        match self {
            Self::First => axis,
            Self::Second(pose) => pose.direction_to_1(axis),
        }
    }
}

/// A manifold as the kernels see it: in their order of the shapes, without rounded borders.
pub(super) struct KernelManifold<'a, M, C> {
    pub manifold: &'a mut ContactManifold<M, C>,
    pub order: PairOrder,
    pub border_radii: [f64; 2],
    frame: AxisFrame<'a>,
}

impl<'a, M, C> KernelManifold<'a, M, C> {
    #[inline(always)]
    pub fn new<B>(
        manifold: &'a mut ContactManifold<M, C>,
        pair: &Pair<'_, B>,
        frame: AxisFrame<'a>,
    ) -> Self {
        Self {
            manifold,
            order: pair.order,
            border_radii: pair.border_radii,
            frame,
        }
    }

    /// The same for shapes with their borders.
    pub fn with_borders(
        manifold: &'a mut ContactManifold<M, C>,
        order: PairOrder,
        frame: AxisFrame<'a>,
    ) -> Self {
        Self {
            manifold,
            order,
            border_radii: [0.0; 2],
            frame,
        }
    }

    /// The memory that the previous frame left. Of its contacts, the one that is deepest now counts.
    #[inline(always)]
    pub fn memory(&self, last: Option<&LastContacts>) -> PairMemory {
        let (manifold, order) = (&*self.manifold, self.order);
        let stored = if order.is_reversed() && !manifold.points.is_empty() {
            manifold.local_n2
        } else {
            manifold.local_n1
        };
        let Some(axis) = unit(stored) else {
            return PairMemory::None;
        };
        let deepest = match last {
            Some(last) => manifold.points.get(last.deepest(axis)),
            None => deepest(&manifold.points),
        };
        match deepest {
            None => {
                let n2 = manifold.local_n2;
                // Casts saturate, and NaN becomes 0: any vector is some pair of vertices.
                let vertices = [n2.x, n2.y].map(|x| VertexId::from(x as u32));
                PairMemory::Axis(self.frame.to_kernel(axis), vertices)
            }
            Some(point) => match (unpack(point.fid1), unpack(point.fid2)) {
                (Some(f1), Some(f2)) => PairMemory::Contact(axis, order.to_kernel([f1, f2])),
                _ => PairMemory::Axis(axis, Default::default()),
            },
        }
    }

    /// The normals of contacts, in the order of the kernels, if they are unit vectors.
    pub fn normals(&self) -> Option<[DVec3; 2]> {
        let normals = [self.manifold.local_n1, self.manifold.local_n2];
        let [first, second] = self.order.to_kernel(normals);
        Some([unit(first)?, unit(second)?])
    }

    /// The distance of the deepest contact in the previous frame.
    pub fn least_distance(&self) -> Option<f32> {
        deepest(&self.manifold.points).map(|contact| contact.dist)
    }

    /// Clears the memory of a pair whose bounding spheres are apart. To store an axis would cost a root and a
    /// division, which is more than it would save the next query.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.manifold.points.clear();
        self.manifold.local_n1 = Vec3::ZERO;
    }

    /// Stores an axis and extreme vertices in a manifold without points.
    #[inline(always)]
    pub fn set_axis(&mut self, axis: DVec3, vertices: [VertexId; 2]) {
        debug_assert!(is_unit(axis), "no unit vector: {axis}");
        debug_assert!(
            vertices
                .iter()
                .all(|&vertex| vertex.index() < 1 << f32::MANTISSA_DIGITS)
        );
        self.manifold.points.clear();
        self.manifold.local_n1 = self.frame.to_stored(axis).as_vec3();
        // Whole numbers up to 2^24 are exact in f32.
        let [x, y] = map_pair(vertices, |vertex| u32::from(vertex) as f32);
        self.manifold.local_n2 = Vec3::new(x, y, 0.0);
    }

    /// Stores the contact normals in f32, each outward from its shape and in its frame.
    #[inline(always)]
    pub fn set_normals(&mut self, normals: [Vec3; 2]) {
        [self.manifold.local_n1, self.manifold.local_n2] = self.order.to_caller(normals);
    }
}

/// The address of the manifold, which is usually the same in the next frame.
#[inline]
pub(super) fn key_of<T>(manifold: &T) -> u64 {
    (&raw const *manifold).addr() as u64
}

#[inline]
fn deepest<C>(contacts: &[TrackedContact<C>]) -> Option<&TrackedContact<C>> {
    let (mut deepest, others) = contacts.split_first()?;
    for other in others {
        if other.dist < deepest.dist {
            deepest = other;
        }
    }
    Some(deepest)
}

/// The vector, if it has unit length up to rounding. Separations along it then have the same relative error.
#[inline]
fn unit(v: Vec3) -> Option<DVec3> {
    let v = v.as_dvec3();
    // This is also false for NaN.
    ((v.length_squared() - 1.0).abs() < NEARLY_UNIT).then_some(v)
}

/// As parry packs feature ids; its own constructors are not inlined across crates.
#[inline]
pub(super) fn pack(feature: Feature) -> PackedFeatureId {
    PackedFeatureId(feature.code())
}

#[inline]
pub(super) fn unpack(id: PackedFeatureId) -> Option<Feature> {
    Feature::from_code(id.0)
}

impl ContactId {
    /// The id of a contact in a manifold that this crate wrote, for instance one of rapier's
    /// (`narrow_phase.contact_pair(a, b)`). `None` if another dispatcher wrote it without feature ids.
    pub fn of<C>(contact: &TrackedContact<C>) -> Option<Self> {
        let features = [unpack(contact.fid1)?, unpack(contact.fid2)?];
        Some(Self::new(features))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(id: u32) -> Feature {
        Feature::Vertex(id.into())
    }

    fn edge(id: u32) -> Feature {
        Feature::Edge(id.into())
    }

    fn face(id: u32) -> Feature {
        Feature::Face(id.into())
    }

    #[test]
    fn packed_features_are_parrys() {
        assert_eq!(pack(vertex(7)), PackedFeatureId::vertex(7));
        assert_eq!(pack(edge(8)), PackedFeatureId::edge(8));
        assert_eq!(pack(face(9)), PackedFeatureId::face(9));
        for feature in [vertex(1), edge(2), face(3)] {
            assert_eq!(unpack(pack(feature)), Some(feature));
        }
        assert_eq!(unpack(PackedFeatureId::UNKNOWN), None);
    }
}
