//! Contacts of compounds with hulls among their parts.
//!
//! Parry's routine for these pairs scans all points of each part for its bounding box, moves every
//! manifold, and looks each one up in a hash table: for parts of sixty points more work than our
//! queries. Here the boxes are those that the compound keeps, and manifolds stay where they are,
//! found by the parts they name.
//!
//! The workspace holds nothing. Rapier wants one of pairs with many manifolds, and drops it when a
//! shape changes. Parry's routine, if the pair comes back to it, sees that it is not its own, and
//! begins anew.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::query::details::{ContactManifoldsWorkspace, NormalConstraints};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher, TypedWorkspaceData};
use parry3d::shape::{Compound, Shape};

use super::{composite, pair};

/// Whether a part of the compound is a hull.
pub(super) fn has_hull(compound: &Compound) -> bool {
    let mut parts = compound.shapes().iter();
    parts.any(|(_, shape)| pair::is_hull(&**shape, shape.shape_type()))
}

/// Two compounds.
pub(super) fn compounds<M, C>(
    dispatcher: &dyn PersistentQueryDispatcher<M, C>,
    pos12: &Pose,
    [c1, c2]: [&Compound; 2],
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    let mut update = Update::begin(dispatcher, prediction, manifolds, workspace);
    let pos21 = pos12.inverse();
    let whole_2 = c2.local_aabb().transform_by(pos12).loosened(prediction);
    for i in c1.bvh().intersect_aabb(&whole_2) {
        let (part_1, near_1) = (Part::of(c1, i), c1.aabbs()[i as usize].loosened(prediction));
        let pos_part1_2 = part_1.pos.inv_mul(pos12);
        for k in c2.bvh().intersect_aabb(&near_1.transform_by(&pos21)) {
            // Boxes around turned boxes are large: the other way round many are apart.
            if !box_in(c2, k, pos12).intersects(&near_1) {
                continue;
            }
            let part_2 = Part::of(c2, k);
            update.parts(&(pos_part1_2 * part_2.pos), [&part_1, &part_2]);
        }
    }
    update.end();
}

/// A compound and a convex shape; the convex one is the first if `swapped`.
#[allow(clippy::too_many_arguments)] // Parry's routines take them so.
pub(super) fn compound_and_convex<M, C>(
    dispatcher: &dyn PersistentQueryDispatcher<M, C>,
    pos12: &Pose,
    compound: &Compound,
    convex: &dyn Shape,
    swapped: bool,
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    let mut update = Update::begin(dispatcher, prediction, manifolds, workspace);
    let place = if swapped { pos12.inverse() } else { *pos12 };
    let whole = convex.compute_aabb(&place).loosened(prediction);
    let whole_part = Part::whole(convex);
    for i in compound.bvh().intersect_aabb(&whole) {
        let part = Part::of(compound, i);
        if swapped {
            update.parts(&(*pos12 * part.pos), [&whole_part, &part]);
        } else {
            update.parts(&part.pos.inv_mul(pos12), [&part, &whole_part]);
        }
    }
    update.end();
}

fn box_in(compound: &Compound, part: u32, pose: &Pose) -> Aabb {
    compound.aabbs()[part as usize].transform_by(pose)
}

/// A convex part, or a convex whole.
struct Part<'a> {
    id: u32,
    /// Where it is in the compound; the identity for a whole.
    pos: Pose,
    in_compound: bool,
    shape: &'a dyn Shape,
    constraints: Option<&'a dyn NormalConstraints>,
}

impl<'a> Part<'a> {
    fn of(compound: &'a Compound, id: u32) -> Self {
        let (pos, shape) = &compound.shapes()[id as usize];
        let constraints = compound.part_normal_constraints(id);
        Self {
            id,
            pos: *pos,
            in_compound: true,
            shape: &**shape,
            constraints: constraints.map(|normals| normals as &dyn NormalConstraints),
        }
    }

    fn whole(shape: &'a dyn Shape) -> Self {
        Self {
            id: 0,
            pos: Pose::IDENTITY,
            in_compound: false,
            shape,
            constraints: None,
        }
    }

    fn pos(&self) -> Option<Pose> {
        self.in_compound.then_some(self.pos)
    }
}

/// The manifolds of a pair, while they are brought up to date.
struct Update<'a, M, C> {
    dispatcher: &'a dyn PersistentQueryDispatcher<M, C>,
    prediction: Real,
    manifolds: &'a mut Vec<ContactManifold<M, C>>,
    /// How many of them are of this frame; those of parts that meet no more come behind.
    done: usize,
}

impl<'a, M, C> Update<'a, M, C>
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    /// Our workspace, or one of parry's routines for such pairs, says that the manifolds are of
    /// these shapes. Without it they may be of shapes that were here before.
    fn begin(
        dispatcher: &'a dyn PersistentQueryDispatcher<M, C>,
        prediction: Real,
        manifolds: &'a mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Self {
        use TypedWorkspaceData::{
            CompositeShapeCompositeShapeContactManifoldsWorkspace as OfTwo,
            CompositeShapeShapeContactManifoldsWorkspace as OfOne,
            VoxelsShapeContactManifoldsWorkspace as Ours,
        };
        let known = workspace.as_ref();
        match known.map(|workspace| workspace.0.as_typed_workspace_data()) {
            Some(Ours(_)) => {}
            parrys_or_none => {
                if !matches!(parrys_or_none, Some(OfOne(_) | OfTwo(_))) {
                    manifolds.clear();
                }
                *workspace = Some(composite::empty_workspace());
            }
        }
        Self {
            dispatcher,
            prediction,
            manifolds,
            done: 0,
        }
    }

    fn parts(&mut self, pos12: &Pose, [part_1, part_2]: [&Part<'_>; 2]) {
        let manifold = self.manifold([part_1, part_2]);
        let prediction = self.prediction;
        // As parry's routines do: a pair that nobody supports has no contacts.
        let _ = self.dispatcher.contact_manifold_convex_convex(
            pos12,
            part_1.shape,
            part_2.shape,
            part_1.constraints,
            part_2.constraints,
            prediction,
            &mut self.manifolds[manifold],
        );
    }

    /// Where the manifold of two parts is: mostly where it was, for parts come in the same order.
    fn manifold(&mut self, [part_1, part_2]: [&Part<'_>; 2]) -> usize {
        let place = self.done;
        let is_of_parts = |manifold: &ContactManifold<M, C>| {
            manifold.subshape1 == part_1.id && manifold.subshape2 == part_2.id
        };
        let known = self.manifolds[place..].iter().position(is_of_parts);
        let found = known.map_or(self.manifolds.len(), |offset| place + offset);
        if known.is_none() {
            let mut manifold = ContactManifold::with_data(part_1.id, part_2.id, M::default());
            manifold.set_subshape_pos1(part_1.pos());
            manifold.set_subshape_pos2(part_2.pos());
            self.manifolds.push(manifold);
        }
        if found != place {
            self.manifolds.swap(place, found);
        }
        self.done += 1;
        place
    }

    fn end(self) {
        self.manifolds.truncate(self.done);
    }
}
