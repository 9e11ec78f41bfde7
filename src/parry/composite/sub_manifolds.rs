//! The manifolds of a pair with parts: one for each two parts that may meet.
//!
//! Manifolds stay where they are, and are found by the parts whose numbers they store. The workspace is
//! empty: rapier requires one for pairs with many manifolds, and drops it when a shape changes. If the pair
//! returns to parry's routines, they find a workspace that is not theirs, and start over.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::query::details::{ContactManifoldsWorkspace, VoxelsShapeContactManifoldsWorkspace};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher, TypedWorkspaceData};
use parry3d::shape::Shape;

use crate::parry::constraints::Constraints;
use crate::parry::int_hash::IntMap;
use crate::parry::operand::Operand;
use crate::parry::order::PairOrder;
use crate::parry::update::Updater;

/// A convex part, or a convex whole.
pub(crate) struct SubShape<'a> {
    /// Its number; 0 for a whole.
    pub id: u32,
    pub operand: Operand<'a>,
    /// Its pose in the compound.
    pub pos: Option<Pose>,
    pub constraints: Constraints<'a>,
}

impl<'a> SubShape<'a> {
    pub fn whole(shape: &'a dyn Shape) -> Self {
        Self {
            id: 0,
            operand: Operand::new(shape),
            pos: None,
            constraints: Constraints::None,
        }
    }

    /// The pose of the second of two shapes in the frame of the first, if this part takes the place of one of them.
    pub fn instead_of_whole(&self, is_of_first: bool, pos12: &Pose) -> Pose {
        match self.pos {
            Some(pos) if is_of_first => pos.inv_mul(pos12),
            Some(pos) => pos12 * pos,
            None => *pos12,
        }
    }
}

/// The manifolds of a pair during an update.
pub(crate) struct SubManifolds<'a, M, C, F> {
    updater: Updater<'a, F>,
    pub prediction: Real,
    manifolds: &'a mut Vec<ContactManifold<M, C>>,
    /// The number of manifolds updated in this frame, which come first. The others belong to parts that may
    /// no longer meet.
    done: usize,
    /// How many manifolds have been examined in searches.
    searched: usize,
    /// The positions of the manifolds after `done`, once searching has become more work than a map.
    places: Option<IntMap<u64, usize>>,
}

/// An update may examine every manifold this many times before it builds a map of them.
const SEARCHES: usize = 2;

/// The key of the manifold of two parts.
fn key(part_1: u32, part_2: u32) -> u64 {
    u64::from(part_1) << 32 | u64::from(part_2)
}

impl<'a, M, C, F> SubManifolds<'a, M, C, F>
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    /// If the workspace is ours, or from one of parry's routines for such pairs, the manifolds belong to
    /// these shapes. Otherwise they may belong to earlier shapes.
    pub fn new(
        updater: Updater<'a, F>,
        prediction: Real,
        manifolds: &'a mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Self {
        use TypedWorkspaceData::{
            CompositeShapeCompositeShapeContactManifoldsWorkspace as OfTwo,
            CompositeShapeShapeContactManifoldsWorkspace as OfOne,
            HeightfieldCompositeShapeContactManifoldsWorkspace as OfFieldAndParts,
            HeightfieldShapeContactManifoldsWorkspace as OfField,
            TriMeshShapeContactManifoldsWorkspace as OfMesh,
            VoxelsShapeContactManifoldsWorkspace as Ours,
        };
        let known = workspace.as_ref();
        match known.map(|workspace| workspace.0.as_typed_workspace_data()) {
            Some(Ours(_)) => {}
            parrys_or_none => {
                let parrys = matches!(
                    parrys_or_none,
                    Some(OfOne(_) | OfTwo(_) | OfField(_) | OfFieldAndParts(_) | OfMesh(_))
                );
                if !parrys {
                    manifolds.clear();
                }
                *workspace = Some(empty_workspace());
            }
        }
        Self {
            updater,
            prediction,
            manifolds,
            done: 0,
            searched: 0,
            places: None,
        }
    }

    /// Two parts, the second at `pos12` in the frame of the first.
    pub fn update_pair(&mut self, pos12: &Pose, part_1: &SubShape<'_>, part_2: &SubShape<'_>) {
        let manifold = self.manifold(part_1, part_2);
        let constraints = [part_1.constraints, part_2.constraints];
        // As in parry's routines, an unsupported pair has no contacts.
        let _ = self.updater.update(
            pos12,
            &[part_1.operand, part_2.operand],
            &constraints,
            self.prediction,
            &mut self.manifolds[manifold],
        );
    }

    /// The box around a whole shape within reach, in the frame of the shape with parts, which is first
    /// in `order`.
    pub fn reach(&self, whole: &SubShape<'_>, pos12: &Pose, order: PairOrder) -> Aabb {
        let pose = if order.is_reversed() {
            pos12.inverse()
        } else {
            *pos12
        };
        whole.operand.aabb(&pose).loosened(self.prediction)
    }

    /// A part and another shape, from the pose of the whole; the shape with parts is first in `order`.
    pub fn update_part(
        &mut self,
        pos12: &Pose,
        part: &SubShape<'_>,
        other: &SubShape<'_>,
        order: PairOrder,
    ) {
        let [part_1, part_2] = order.to_caller([part, other]);
        let pos12 = part.instead_of_whole(!order.is_reversed(), pos12);
        self.update_pair(&pos12, part_1, part_2);
    }

    /// The position of the manifold of two parts. Mostly it is where it was, since parts come in the same
    /// order.
    fn manifold(&mut self, part_1: &SubShape<'_>, part_2: &SubShape<'_>) -> usize {
        let place = self.done;
        let known = self.find(part_1.id, part_2.id);
        let found = known.unwrap_or(self.manifolds.len());
        if known.is_none() {
            let mut manifold = ContactManifold::with_data(part_1.id, part_2.id, M::default());
            manifold.set_subshape_pos1(part_1.pos);
            manifold.set_subshape_pos2(part_2.pos);
            self.manifolds.push(manifold);
        }
        if found != place {
            self.manifolds.swap(place, found);
            if let Some(places) = &mut self.places {
                places.insert(Self::key_of(&self.manifolds[found]), found);
            }
        }
        self.done += 1;
        place
    }

    /// The manifold of two parts among those behind `done`.
    fn find(&mut self, part_1: u32, part_2: u32) -> Option<usize> {
        let key = key(part_1, part_2);
        let is_wanted = |manifold: &ContactManifold<M, C>| Self::key_of(manifold) == key;
        let rest = &self.manifolds[self.done..];
        if rest.first().is_some_and(is_wanted) {
            return Some(self.done);
        }
        if self.searched > SEARCHES * self.manifolds.len() {
            return self.places().get(&key).copied();
        }
        let known = rest.iter().position(is_wanted);
        self.searched += known.unwrap_or(rest.len());
        known.map(|offset| self.done + offset)
    }

    fn places(&mut self) -> &IntMap<u64, usize> {
        self.places.get_or_insert_with(|| {
            let rest = self.manifolds.iter().enumerate().skip(self.done);
            rest.map(|(i, manifold)| (Self::key_of(manifold), i))
                .collect()
        })
    }

    fn key_of(manifold: &ContactManifold<M, C>) -> u64 {
        key(manifold.subshape1, manifold.subshape2)
    }

    /// Whether any parts that were updated after the `first` ones have contacts.
    fn have_contacts(&self, first: usize) -> bool {
        let mut done = self.manifolds[first..self.done].iter();
        done.any(|manifold| !manifold.points.is_empty())
    }

    /// Forgets that any parts after the `first` ones were updated.
    fn start_over(&mut self, first: usize) {
        self.done = first;
        self.searched = 0;
        self.places = None;
    }

    /// Updates all parts of a pair.
    pub fn update_all(mut self, update: impl Fn(&mut Self, bool), leave_some: impl Fn() -> bool) {
        self.update_group(update, leave_some);
        self.finish();
    }

    /// Updates some parts, with corrected normals. If these leave some part that overlaps the other shape without a
    /// contact, and no part has one, updates them once more, with normals as they are.
    pub fn update_group(
        &mut self,
        update: impl Fn(&mut Self, bool),
        leave_some: impl Fn() -> bool,
    ) {
        let first = self.done;
        update(self, true);
        if leave_some() && !self.have_contacts(first) {
            self.start_over(first);
            update(self, false);
        }
    }

    /// Drops the manifolds of parts that no longer meet.
    pub fn finish(self) {
        debug_assert!(self.done <= self.manifolds.len());
        self.manifolds.truncate(self.done);
    }
}

/// An empty workspace, which tells rapier that the manifolds of a pair come and go and must be added to its
/// solver graph again. It has the type that parry uses for voxels: so it can be saved and loaded, and parry's
/// routines for other pairs see that it is not theirs.
pub(crate) fn empty_workspace() -> ContactManifoldsWorkspace {
    VoxelsShapeContactManifoldsWorkspace::<2>::new().into()
}

#[cfg(test)]
mod tests {
    use parry3d::query::DefaultQueryDispatcher;
    use parry3d::shape::Ball;

    use super::*;
    use crate::parry::hull_cache::epoch::Epoch;
    use crate::stats::SharedStats;

    /// Parts that meet for the first time are searched among all that met before, in vain.
    #[test]
    fn searching_is_linear_in_the_parts() {
        let (stats, ball) = (SharedStats::default(), Ball::new(0.5));
        for count in [10, 100, 1000] {
            let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
            let mut workspace = None;
            for first in [0, count, 2 * count] {
                let updater = Updater {
                    fallback: &DefaultQueryDispatcher,
                    stats: &stats,
                    recorder: None,
                    epoch: Epoch::of_pair(),
                    leaves_custom: false,
                };
                let mut pairs = SubManifolds::new(updater, 0.0, &mut manifolds, &mut workspace);
                let whole = SubShape::whole(&ball);
                for id in (first..first + count).rev() {
                    let part = SubShape {
                        id,
                        ..SubShape::whole(&ball)
                    };
                    pairs.manifold(&part, &whole);
                }
                let most = (SEARCHES + 1) * 2 * count as usize;
                assert!(pairs.searched <= most, "{} of {most}", pairs.searched);
                pairs.finish();
                assert_eq!(manifolds.len(), count as usize);
            }
        }
    }
}
