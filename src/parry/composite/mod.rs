//! Composite shapes: our routines take apart compounds, and meshes that meet a hull or a compound; parry's routines
//! do the rest. Both call *our* dispatcher for the parts.
//!
//! parry's own dispatcher passes itself to those routines, so a dispatcher chained in front of it would never
//! see the hulls inside compounds, meshes, height fields and voxels.

use parry3d::math::{Pose, Real};
use parry3d::query::details::{
    ContactManifoldsWorkspace, contact_manifolds_composite_shape_composite_shape,
    contact_manifolds_composite_shape_shape, contact_manifolds_heightfield_composite_shape,
    contact_manifolds_heightfield_shape_shapes, contact_manifolds_trimesh_shape_shapes,
};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher};
use parry3d::shape::{Shape, ShapeType};

mod cell_queries;
mod cells;
mod compound;
mod coplanar;
mod mesh;
mod nonlinear;
mod nonlinear_cells;
pub(crate) mod scene;
pub(crate) mod seams;
mod spread;
mod sub_manifolds;
mod voxels;

use crate::parry::order::PairOrder;
use crate::parry::update::Updater;
use crate::parry::without_hull::makes_pair_with_triangle_ours;
use mesh::Triangles;
use sub_manifolds::{SubManifolds, empty_workspace};

/// Updates the manifolds of a pair in which a shape has parts. `false` if none has.
// perf: inlined, its arguments would go through memory in pairs without parts.
#[inline(never)]
pub(crate) fn contact_manifolds<M, C, F>(
    dispatcher: &dyn PersistentQueryDispatcher<M, C>,
    updater: Updater<'_, F>,
    pos12: &Pose,
    shapes: [&dyn Shape; 2],
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> bool
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    // parry's routines assert that boxes are not loosened by a negative length.
    let prediction = prediction.max(0.0);
    let is_composite = by_us(updater, pos12, shapes, prediction, manifolds, workspace)
        || by_parry(dispatcher, pos12, shapes, prediction, manifolds, workspace);
    if is_composite {
        coplanar::reduce(shapes, manifolds);
    }
    is_composite
}

/// By parry's routines, which take a shape apart. `false` if none has parts.
fn by_parry<M, C>(
    dispatcher: &dyn PersistentQueryDispatcher<M, C>,
    pos12: &Pose,
    shapes @ [s1, s2]: [&dyn Shape; 2],
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> bool
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    use ShapeType::{HeightField, TriMesh, Voxels};
    let composites = [s1.as_composite_shape(), s2.as_composite_shape()];
    if let [Some(c1), Some(c2)] = composites {
        contact_manifolds_composite_shape_composite_shape(
            dispatcher, pos12, c1, c2, prediction, manifolds, workspace,
        );
        return true;
    }
    match [s1.shape_type(), s2.shape_type()] {
        [TriMesh, _] | [_, TriMesh] => contact_manifolds_trimesh_shape_shapes(
            dispatcher, pos12, s1, s2, prediction, manifolds, workspace,
        ),
        [HeightField, _] | [_, HeightField] => {
            height_field(dispatcher, pos12, shapes, prediction, manifolds, workspace)
        }
        [Voxels, _] | [_, Voxels] if shapes.into_iter().all(voxels::may_meet) => {
            voxels::update(dispatcher, pos12, shapes, prediction, manifolds, workspace);
        }
        _ => match composites {
            [Some(c1), _] => contact_manifolds_composite_shape_shape(
                dispatcher, pos12, c1, s2, prediction, manifolds, workspace, false,
            ),
            [_, Some(c2)] => contact_manifolds_composite_shape_shape(
                dispatcher,
                &pos12.inverse(),
                c2,
                s1,
                prediction,
                manifolds,
                workspace,
                true,
            ),
            _ => return false,
        },
    }
    true
}

/// Leaves a single manifold, as a pair of convex shapes has. If a shape had parts until now, the manifolds of
/// its parts are still there, and rapier must notice that they are removed.
pub(crate) fn reset_to_single<M: Default + Clone, C: Default + Copy>(
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) {
    let is_of_whole = |manifold: &ContactManifold<M, C>| {
        manifold.subshape_poses.is_none() && [manifold.subshape1, manifold.subshape2] == [0, 0]
    };
    if let [manifold] = &manifolds[..]
        && is_of_whole(manifold)
    {
        *workspace = None;
        return;
    }
    *workspace = (!manifolds.is_empty()).then(empty_workspace);
    manifolds.clear();
    // A first push would make room for four. rapier reads all pairs in every frame, and dense memory is
    // faster.
    manifolds.reserve_exact(1);
    manifolds.push(ContactManifold::with_data(0, 0, M::default()));
}

/// Takes apart a compound that meets another one or a convex shape, and a shape made of triangles that meets a
/// compound, a hull, a cuboid, or a curved or rounded shape. `false` for other pairs.
///
/// We answer compounds whether or not they have a hull: to find out, each update would have to visit every
/// part, however few of them are near.
fn by_us<M, C, F>(
    updater: Updater<'_, F>,
    pos12: &Pose,
    [s1, s2]: [&dyn Shape; 2],
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> bool
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    let begin = |manifolds, workspace| SubManifolds::new(updater, prediction, manifolds, workspace);
    if let [Some(c1), Some(c2)] = [s1.as_compound(), s2.as_compound()] {
        compound::compounds(begin(manifolds, workspace), pos12, [c1, c2]);
        return true;
    }
    for order in PairOrder::BOTH {
        let [first, second] = order.to_kernel([s1, s2]);
        if let Some(compound) = first.as_compound()
            && second.is_convex()
        {
            let sub_manifolds = begin(manifolds, workspace);
            compound::compound_and_convex(sub_manifolds, pos12, compound, second, order);
            return true;
        }
        if let Some(triangles) = Triangles::of(first)
            && (second.as_compound().is_some() || makes_pair_with_triangle_ours(second))
        {
            let sub_manifolds = begin(manifolds, workspace);
            mesh::triangles(sub_manifolds, pos12, triangles, second, order);
            return true;
        }
    }
    false
}

/// A height field against anything. One of the shapes is a height field.
fn height_field<M, C>(
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
    let pos21 = pos12.inverse();
    if let (Some(field), Some(other)) = (s1.as_heightfield(), s2.as_composite_shape()) {
        contact_manifolds_heightfield_composite_shape(
            dispatcher, pos12, &pos21, field, other, prediction, manifolds, workspace, false,
        );
    } else if let (Some(other), Some(field)) = (s1.as_composite_shape(), s2.as_heightfield()) {
        contact_manifolds_heightfield_composite_shape(
            dispatcher, &pos21, pos12, field, other, prediction, manifolds, workspace, true,
        );
    } else {
        contact_manifolds_heightfield_shape_shapes(
            dispatcher, pos12, s1, s2, prediction, manifolds, workspace,
        );
    }
}
