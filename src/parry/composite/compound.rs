//! Contacts of compounds.
//!
//! parry's routine for these pairs scans all points of each part for its bounding box, moves every manifold,
//! and looks each one up in a hash table. For parts of sixty points this is more work than our queries. We
//! use the boxes that the compound stores, and manifolds stay where they are.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Pose;
use parry3d::query::PersistentQueryDispatcher;
use parry3d::shape::{Compound, Shape};

use crate::at::At;
use crate::parry::composite::seams::Seams;
use crate::parry::composite::sub_manifolds::{SubManifolds, SubShape};
use crate::parry::constraints::Constraints;
use crate::parry::operand::Operand;
use crate::parry::order::PairOrder;

/// Two compounds.
pub(crate) fn compounds<M, C, F>(
    sub_manifolds: SubManifolds<'_, M, C, F>,
    pos12: &Pose,
    [c1, c2]: [&Compound; 2],
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    let pos21 = pos12.inverse();
    let prediction = sub_manifolds.prediction;
    let whole_2 = c2.local_aabb().transform_by(pos12).loosened(prediction);
    let whole_1 = c1.local_aabb().transform_by(&pos21).loosened(prediction);
    let seams = [Seams::near(c1, &whole_2), Seams::near(c2, &whole_1)];
    let update = |sub_manifolds: &mut SubManifolds<'_, M, C, F>, corrects: bool| {
        for i in c1.bvh().intersect_aabb(&whole_2) {
            let part_1 = part(c1, &seams[0], i, corrects);
            let near_1 = c1.aabbs().at(i).loosened(prediction);
            let pos_part1_2 = part_1.instead_of_whole(true, pos12);
            for k in c2.bvh().intersect_aabb(&near_1.transform_by(&pos21)) {
                // Boxes around rotated boxes are large. With the compounds exchanged, many of them are apart.
                if !box_in(c2, k, pos12).intersects(&near_1) {
                    continue;
                }
                let part_2 = part(c2, &seams[1], k, corrects);
                let pos12 = part_2.instead_of_whole(false, &pos_part1_2);
                sub_manifolds.update_pair(&pos12, &part_1, &part_2);
            }
        }
    };
    sub_manifolds.update_all(update, || seams.iter().any(Seams::leave_some));
}

/// A compound and a convex shape; the compound is first in `order`.
pub(crate) fn compound_and_convex<M, C, F>(
    sub_manifolds: SubManifolds<'_, M, C, F>,
    pos12: &Pose,
    compound: &Compound,
    convex: &dyn Shape,
    order: PairOrder,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    let whole = SubShape::whole(convex);
    let reach = sub_manifolds.reach(&whole, pos12, order);
    let seams = Seams::near(compound, &reach);
    let update = |sub_manifolds: &mut SubManifolds<'_, M, C, F>, corrects: bool| {
        for i in compound.bvh().intersect_aabb(&reach) {
            let part = part(compound, &seams, i, corrects);
            sub_manifolds.update_part(pos12, &part, &whole, order);
        }
    };
    sub_manifolds.update_all(update, || seams.leave_some());
}

fn box_in(compound: &Compound, part: u32, pose: &Pose) -> Aabb {
    compound.aabbs().at(part).transform_by(pose)
}

/// A part of a compound. If no part of an overlapping pair has a contact along a corrected normal, normals are left as
/// they are.
pub(super) fn part<'a>(
    compound: &'a Compound,
    seams: &'a Seams<'_>,
    id: u32,
    corrects: bool,
) -> SubShape<'a> {
    let (pos, shape) = compound.shapes().at_ref(id);
    let constraints = if corrects {
        seams.of_part(id, pos)
    } else {
        Constraints::None
    };
    SubShape {
        id,
        operand: Operand::new(&**shape),
        pos: Some(*pos),
        constraints,
    }
}
