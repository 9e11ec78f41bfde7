//! A pair's memory, kept in its contact manifold.
//!
//! Manifolds are saved, cloned and pooled with the world, exist for the parts of composite shapes, and cost
//! rapier nothing; a workspace would make it rebuild its solver graph in every step. So the memory is in
//! unused fields of the manifold:
//!
//! - without points, `local_n1` is the separating axis in an [`AxisFrame`], or zero if none was needed: the
//!   bounding spheres are apart since the last contact. As in parry, it leads from the caller's first shape to
//!   the second: one-way platforms learn from it from where a body comes. `local_n2`, which is unused then,
//!   contains two vertices as whole numbers, which were extreme when the axis was found;
//! - with points, `local_n1` is the contact normal, and the feature ids of the first point are the features
//!   in contact.
//!
//! Anything that another dispatcher or another pair left there is only a hint.

use glam::{DVec3, Vec3};

use super::erased::ErasedManifold;
use super::inherit::ManifoldPoints;
use super::packed_feature::unpack;
use crate::curved::Hint;
use crate::manifold::{Contacts, MAX_POINTS};
use crate::map_pair::map_pair;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::pose::{RelativePose, is_unit};
use crate::query::{LastContacts, PairMemory};
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

    /// The greatest distance of a point of the other shape from the centre of its rotation: the origin of the caller's
    /// second shape, which the caller's pose turns.
    pub fn lever<A: Support, B: Support>(self, cso: &Cso<'_, A, B>, order: PairOrder) -> f64 {
        let (first, second) = (cso.shape_1, cso.shape_2);
        match (self, order) {
            (Self::First, PairOrder::Given) => second.center().length() + second.radius(),
            (Self::First, PairOrder::Reversed) => {
                cso.pose.point_to_1(second.center()).length() + second.radius()
            }
            (Self::Second(pose), PairOrder::Given) => {
                (first.center() - pose.translation()).length() + first.radius()
            }
            (Self::Second(_), PairOrder::Reversed) => first.center().length() + first.radius(),
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
pub(super) struct KernelManifold<'a, 'm> {
    pub manifold: &'a mut ErasedManifold<'m>,
    pub order: PairOrder,
    pub border_radii: [f64; 2],
    frame: AxisFrame<'a>,
}

impl<'a, 'm> KernelManifold<'a, 'm> {
    #[inline(always)]
    pub fn new<B, A>(
        manifold: &'a mut ErasedManifold<'m>,
        pair: &Pair<'_, B, A>,
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
        manifold: &'a mut ErasedManifold<'m>,
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
        let stored = if order.is_reversed() && !manifold.is_empty() {
            *manifold.local_n2
        } else {
            *manifold.local_n1
        };
        let Some(axis) = unit(stored) else {
            return PairMemory::None;
        };
        if manifold.is_empty() {
            let n2 = *manifold.local_n2;
            // Casts saturate, and NaN becomes 0: any vector is some pair of vertices.
            let vertices = [n2.x, n2.y].map(|x| VertexId::from(x as u32));
            let [axis, _] = order.to_kernel([axis, -axis]);
            return PairMemory::Axis(self.frame.to_kernel(axis), vertices);
        }
        let points = manifold.points();
        let deepest = match last {
            Some(last) => Some(last.deepest(axis)),
            None => points.deepest(),
        };
        match deepest.and_then(|deepest| Some(points.features(deepest)?.map(unpack))) {
            Some([Some(f1), Some(f2)]) => PairMemory::Contact(axis, order.to_kernel([f1, f2])),
            _ => PairMemory::Axis(axis, Default::default()),
        }
    }

    /// The memory of a pair with a curved shape, and its contacts.
    pub fn hint(&self, last: Option<&LastContacts>) -> Hint {
        match (last, self.normals()) {
            (Some(_), Some(normals)) => Hint::Contact(normals),
            (Some(_), None) => Hint::None,
            (None, _) => match self.memory(None) {
                PairMemory::Axis(axis, ids) => Hint::Apart(axis, ids),
                _ => Hint::None,
            },
        }
    }

    /// The normals of contacts, in the order of the kernels, if they are unit vectors.
    pub fn normals(&self) -> Option<[DVec3; 2]> {
        let normals = [*self.manifold.local_n1, *self.manifold.local_n2];
        let [first, second] = self.order.to_kernel(normals);
        Some([unit(first)?, unit(second)?])
    }

    /// The stored normal, outward from the kernels' first shape and in its frame.
    #[inline]
    pub fn stored_normal(&self) -> Vec3 {
        self.order
            .to_kernel([*self.manifold.local_n1, *self.manifold.local_n2])[0]
    }

    /// Whether one of the shapes has rolled over the other since the normals were stored.
    #[inline]
    pub fn has_rolled<A: Support, B: Support>(&self, cso: &Cso<'_, A, B>, now: [DVec3; 2]) -> bool {
        cso.may_roll() && self.normals().is_some_and(|before| cso.rolls(before, now))
    }

    /// Clears the memory of a pair whose bounding spheres are apart. To store an axis would cost a root and a
    /// division, which is more than it would save the next query.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.manifold.clear();
        *self.manifold.local_n1 = Vec3::ZERO;
    }

    /// Stores an axis and extreme vertices in a manifold without points.
    #[inline(always)]
    pub fn set_axis(&mut self, axis: DVec3, vertices: [VertexId; 2]) {
        let axis = self.frame.to_stored(axis);
        self.set_stored_axis(axis, vertices);
    }

    /// The same for an axis that is already in the frame in which it is stored, from the kernels' first shape to their
    /// second.
    #[inline]
    pub fn set_stored_axis(&mut self, axis: DVec3, vertices: [VertexId; 2]) {
        debug_assert!(is_unit(axis), "no unit vector: {axis}");
        debug_assert!(
            vertices
                .iter()
                .all(|&vertex| vertex.index() < 1 << f32::MANTISSA_DIGITS)
        );
        self.manifold.clear();
        [*self.manifold.local_n1, _] = self.order.to_caller([axis, -axis].map(|n| n.as_vec3()));
        // Whole numbers up to 2^24 are exact in f32.
        let [x, y] = map_pair(vertices, |vertex| u32::from(vertex) as f32);
        *self.manifold.local_n2 = Vec3::new(x, y, 0.0);
    }

    /// Replaces the contacts. The new ones inherit the data (the solver's impulses) of the old ones.
    #[inline(always)]
    pub fn set_contacts(&mut self, normals: [Vec3; 2], contacts: &Contacts) {
        debug_assert!(contacts.len <= MAX_POINTS, "{contacts:?}");
        debug_assert!(
            contacts.iter().all(|contact| contact.distance.is_finite()),
            "{contacts:?}"
        );
        self.set_normals(normals);
        let points = ManifoldPoints::new(contacts, normals, self.border_radii, self.order);
        self.manifold.replace(&points);
    }

    /// Stores the contact normals in f32, each outward from its shape and in its frame.
    #[inline(always)]
    pub fn set_normals(&mut self, normals: [Vec3; 2]) {
        [*self.manifold.local_n1, *self.manifold.local_n2] = self.order.to_caller(normals);
    }
}

/// The vector, if it has unit length up to rounding. Separations along it then have the same relative error.
#[inline]
fn unit(v: Vec3) -> Option<DVec3> {
    let v = v.as_dvec3();
    // This is also false for NaN.
    ((v.length_squared() - 1.0).abs() < NEARLY_UNIT).then_some(v)
}
