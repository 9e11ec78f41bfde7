//! A pair's memory, kept in its contact manifold.
//!
//! Manifolds are saved, cloned and pooled with the world, exist for the parts of composite shapes, and cost
//! rapier nothing; a workspace would make it rebuild its solver graph in every step. So the memory is in
//! unused fields of the manifold:
//!
//! - without points, `local_n1` is the separating axis, or zero if none was needed: the bounding spheres are apart
//!   since the last contact. As in parry, it leads from the caller's first shape to the second, in the frame of the
//!   first: one-way platforms learn from it from where a body comes. Where the axis is kept in this frame (see
//!   [`AxisFrame`]), `local_n2` contains two vertices as whole numbers, which were extreme when the axis was found.
//!   Otherwise it is the axis in the frame of the second shape, outward from that, and each update turns `local_n1`
//!   along, or clears it if the bounding spheres suffice;
//! - with points, `local_n1` is the contact normal, and the feature ids of the first point are the features
//!   in contact.
//!
//! Anything that another dispatcher or another pair left there is only a hint.

use glam::{DVec3, Vec3};

use super::axis_frame::{AxisFrame, unit};
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
        if manifold.is_empty() {
            return self.axis();
        }
        let Some(axis) = unit(self.stored_normal()) else {
            return PairMemory::None;
        };
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

    /// The same, with vertices at which a search along an axis may start if the manifold has none.
    #[inline]
    pub fn memory_of<A: Support, B: Support>(
        &self,
        cso: &Cso<'_, A, B>,
        last: Option<&LastContacts>,
    ) -> PairMemory {
        match self.memory(last) {
            PairMemory::Axis(axis, _) if self.keeps_axis_in_second() => {
                PairMemory::Axis(axis, start_vertices(cso, axis))
            }
            memory => memory,
        }
    }

    /// The axis of a manifold without points, and the extreme vertices if it has them.
    #[inline]
    fn axis(&self) -> PairMemory {
        let [n1, n2] = [*self.manifold.local_n1, *self.manifold.local_n2];
        let kept = if !self.keeps_axis_in_second() {
            unit(n1)
        } else if n1 != Vec3::ZERO {
            unit(-n2)
        } else {
            None
        };
        let Some(axis) = kept else {
            return PairMemory::None;
        };
        // Casts saturate, and NaN becomes 0: any vector is some pair of vertices.
        let vertices = [n2.x, n2.y].map(|x| VertexId::from(x as u32));
        let [axis, _] = self.order.to_kernel([axis, -axis]);
        PairMemory::Axis(self.frame.to_kernel(axis), vertices)
    }

    /// The memory of a pair with a curved shape, and its contacts.
    pub fn hint<A: Support, B: Support>(
        &self,
        cso: &Cso<'_, A, B>,
        last: Option<&LastContacts>,
    ) -> Hint {
        match (last, self.normals()) {
            (Some(_), Some(normals)) => Hint::Contact(normals),
            (Some(_), None) => Hint::None,
            (None, _) => match self.memory_of(cso, None) {
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

    /// Clears the memory of a pair whose bounding spheres are apart.
    #[inline(always)]
    pub fn forget(&mut self) {
        self.manifold.forget();
    }

    /// Whether the axis is kept in the frame of the caller's second shape.
    #[inline]
    pub fn keeps_axis_in_second(&self) -> bool {
        self.frame.is_of_second(self.order)
    }

    /// Stores an axis, in the frame of the kernels' first shape, and extreme vertices in a manifold without points.
    #[inline(always)]
    pub fn set_axis(&mut self, axis: DVec3, vertices: [VertexId; 2], pose: &RelativePose) {
        debug_assert!(is_unit(axis), "no unit vector: {axis}");
        debug_assert!(
            vertices
                .iter()
                .all(|&vertex| vertex.index() < 1 << f32::MANTISSA_DIGITS)
        );
        self.manifold.clear();
        if self.keeps_axis_in_second() {
            self.set_both_axes(axis, pose);
            return;
        }
        *self.manifold.local_n1 = if self.order.is_reversed() {
            -pose.direction_to_2(axis).as_vec3()
        } else {
            axis.as_vec3()
        };
        // Whole numbers up to 2^24 are exact in f32.
        let [x, y] = map_pair(vertices, |vertex| u32::from(vertex) as f32);
        *self.manifold.local_n2 = Vec3::new(x, y, 0.0);
    }

    /// The same in the frames of both shapes.
    // perf: as `start_vertices`.
    #[inline(never)]
    fn set_both_axes(&mut self, axis: DVec3, pose: &RelativePose) {
        self.set_normals(outward_normals(axis, pose));
    }

    /// Turns the axis that is kept in the frame of the second shape to that of the first.
    // perf: as `start_vertices`.
    #[inline(never)]
    pub fn turn_axis(&mut self, axis: DVec3, pose: &RelativePose) {
        [*self.manifold.local_n1, _] = self.order.to_caller(outward_normals(axis, pose));
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

/// An axis as normals of both of the kernels' shapes, each outward from its shape and in its frame.
fn outward_normals(axis: DVec3, pose: &RelativePose) -> [Vec3; 2] {
    [axis, -pose.direction_to_2(axis)].map(|normal| normal.as_vec3())
}

// perf: inlined, what few pairs need made updates so long that the compiler called them (2 to 12 % more instructions).
#[inline(never)]
fn start_vertices<A: Support, B: Support>(cso: &Cso<'_, A, B>, axis: DVec3) -> [VertexId; 2] {
    cso.start_vertices(axis)
}
