//! Contacts of voxels, by parry's routines.

use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{Pose, Real};
use parry3d::partitioning::{Bvh, BvhBuildStrategy};
use parry3d::query::details::{
    ContactManifoldsWorkspace, NormalConstraints, contact_manifolds_voxels_ball_shapes,
    contact_manifolds_voxels_composite_shape, contact_manifolds_voxels_composite_shape_shapes,
    contact_manifolds_voxels_shape_shapes, contact_manifolds_voxels_voxels_shapes,
};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher};
use parry3d::shape::{self, CompositeShape, Compound, Shape, ShapeType};

use super::sub_manifolds::empty_workspace;
use crate::at::At;
use crate::parry::order::PairOrder;

/// Whether the routines know a shape. Any other, such as a half-space, ends in a panic there.
pub(super) fn may_meet(shape: &dyn Shape) -> bool {
    let is_convex = shape.as_support_map().is_some();
    is_convex || shape.as_composite_shape().is_some() || shape.as_voxels().is_some()
}

/// Voxels against anything that they [may meet](may_meet).
pub(super) fn update<M, C>(
    dispatcher: &dyn PersistentQueryDispatcher<M, C>,
    pos12: &Pose,
    [s1, s2]: [&dyn Shape; 2],
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    for order in PairOrder::BOTH {
        let [first, second] = order.to_kernel([s1, s2]);
        if let (Some(voxels), Some(compound)) = (first.as_voxels(), second.as_compound()) {
            let [pos12, _] = order.to_kernel([*pos12, pos12.inverse()]);
            let parts = NearParts::of(compound, voxels, &pos12, prediction);
            let is_reversed = order.is_reversed();
            return contact_manifolds_voxels_composite_shape(
                dispatcher,
                &pos12,
                voxels,
                &parts,
                prediction,
                manifolds,
                workspace,
                is_reversed,
            );
        }
    }
    without_compound(
        dispatcher,
        pos12,
        [s1, s2],
        prediction,
        manifolds,
        workspace,
    );
}

/// The same without compounds.
fn without_compound<M, C>(
    dispatcher: &dyn PersistentQueryDispatcher<M, C>,
    pos12: &Pose,
    [s1, s2]: [&dyn Shape; 2],
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    use ShapeType::{Ball, Voxels};
    match [s1.shape_type(), s2.shape_type()] {
        [Voxels, Voxels] => contact_manifolds_voxels_voxels_shapes(
            dispatcher, pos12, s1, s2, prediction, manifolds, workspace,
        ),
        [Ball, _] | [_, Ball] => {
            contact_manifolds_voxels_ball_shapes(pos12, s1, s2, prediction, manifolds);
            // parry does not set it.
            *workspace = Some(empty_workspace());
        }
        _ if s1.as_composite_shape().is_some() || s2.as_composite_shape().is_some() => {
            contact_manifolds_voxels_composite_shape_shapes(
                dispatcher, pos12, s1, s2, prediction, manifolds, workspace,
            );
        }
        _ => contact_manifolds_voxels_shape_shapes(
            dispatcher, pos12, s1, s2, prediction, manifolds, workspace,
        ),
    }
}

/// The parts of a compound within reach of voxels, in boxes that are loosened by the prediction: parry's routine
/// takes boxes as they are, and so finds no contact before shapes overlap.
struct NearParts<'a> {
    compound: &'a Compound,
    boxes: Bvh,
}

impl<'a> NearParts<'a> {
    fn of(compound: &'a Compound, voxels: &shape::Voxels, pos12: &Pose, prediction: Real) -> Self {
        let all = voxels.local_aabb().transform_by(&pos12.inverse());
        let all = all.loosened(prediction);
        let mut near: Vec<u32> = compound.bvh().intersect_aabb(&all).collect();
        // parry's tree of one or two leaves wants the numbers of the first parts.
        for part in 0..3 {
            if near.len() < 3 && !near.contains(&part) && compound.shapes().try_at(part).is_some() {
                near.push(part);
            }
        }
        near.sort_unstable();
        let loosened = |part: u32| {
            let aabb = compound.aabbs().at(part).loosened(prediction);
            Some((usize::try_from(part).ok()?, aabb))
        };
        let boxes = near.into_iter().filter_map(loosened);
        Self {
            compound,
            boxes: Bvh::from_iter(BvhBuildStrategy::default(), boxes),
        }
    }
}

impl CompositeShape for NearParts<'_> {
    fn map_part_at(
        &self,
        part: u32,
        f: &mut dyn FnMut(Option<&Pose>, &dyn Shape, Option<&dyn NormalConstraints>),
    ) {
        // The routine panics at others.
        let (_, shape) = self.compound.shapes().at_ref(part);
        if shape.as_support_map().is_some() {
            self.compound.map_part_at(part, f);
        }
    }

    fn bvh(&self) -> &Bvh {
        &self.boxes
    }
}
