//! The manifolds of a pair with parts: one for each two parts that may meet.
//!
//! They stay where they are, found by the parts they name. The workspace holds nothing. Rapier
//! wants one of pairs with many manifolds, and drops it when a shape changes. Parry's routines, if
//! the pair comes back to them, see that it is not theirs, and begin anew.

use parry3d::math::{Pose, Real};
use parry3d::query::details::ContactManifoldsWorkspace;
use parry3d::query::{ContactManifold, TypedWorkspaceData};
use parry3d::shape::Shape;

use super::constraints::Constraints;
use super::hulls::LastProved;
use super::pair::Side;
use super::{IsaGjkDispatcher, composite};

/// A convex part, or a convex whole.
pub(super) struct Part<'a> {
    /// Its number; 0 for a whole.
    pub id: u32,
    pub side: Side<'a, LastProved<'a>>,
    /// Where it is in the compound.
    pub pos: Option<Pose>,
    pub constraints: Constraints<'a>,
}

impl<'a> Part<'a> {
    pub fn whole(shape: &'a dyn Shape) -> Self {
        Self {
            id: 0,
            side: Side::new(shape, LastProved::default()),
            pos: None,
            constraints: Constraints::None,
        }
    }
}

/// The manifolds of a pair, while they are brought up to date.
pub(super) struct Update<'a, M, C> {
    dispatcher: &'a IsaGjkDispatcher,
    pub prediction: Real,
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
    pub fn begin(
        dispatcher: &'a IsaGjkDispatcher,
        prediction: Real,
        manifolds: &'a mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Self {
        use TypedWorkspaceData::{
            CompositeShapeCompositeShapeContactManifoldsWorkspace as OfTwo,
            CompositeShapeShapeContactManifoldsWorkspace as OfOne,
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
                    Some(OfOne(_) | OfTwo(_) | OfField(_) | OfMesh(_))
                );
                if !parrys {
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

    /// Two parts, the second at `pos12` in the frame of the first.
    pub fn parts(&mut self, pos12: &Pose, part_1: &mut Part<'_>, part_2: &mut Part<'_>) {
        let manifold = self.manifold(part_1, part_2);
        let constraints = [part_1.constraints, part_2.constraints];
        // As parry's routines do: a pair that nobody supports has no contacts.
        let _ = self.dispatcher.update_manifold(
            pos12,
            (part_1.side.again(), part_2.side.again()),
            self.dispatcher.unchanged.span(),
            constraints,
            self.prediction,
            &mut self.manifolds[manifold],
        );
    }

    /// Where the manifold of two parts is: mostly where it was, for parts come in the same order.
    fn manifold(&mut self, part_1: &Part<'_>, part_2: &Part<'_>) -> usize {
        let place = self.done;
        let is_of_parts = |manifold: &ContactManifold<M, C>| {
            manifold.subshape1 == part_1.id && manifold.subshape2 == part_2.id
        };
        let known = self.manifolds[place..].iter().position(is_of_parts);
        let found = known.map_or(self.manifolds.len(), |offset| place + offset);
        if known.is_none() {
            let mut manifold = ContactManifold::with_data(part_1.id, part_2.id, M::default());
            manifold.set_subshape_pos1(part_1.pos);
            manifold.set_subshape_pos2(part_2.pos);
            self.manifolds.push(manifold);
        }
        if found != place {
            self.manifolds.swap(place, found);
        }
        self.done += 1;
        place
    }

    /// Drops the manifolds of parts that meet no more.
    pub fn end(self) {
        self.manifolds.truncate(self.done);
    }
}
