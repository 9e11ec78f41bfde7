//! Contacts of hulls and compounds with triangle meshes and height fields.
//!
//! parry's routines compute the pseudo-normals of every nearby triangle, most of which have no contact, and
//! move the manifolds of a height field through a hash table in each frame. We compute normals only if there
//! is a contact to correct, and manifolds stay where they are.

use std::cell::Cell;

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Pose;
use parry3d::query::PersistentQueryDispatcher;
use parry3d::shape::{
    Compound, HeightField, HeightFieldFlags, Shape, TriMesh, TriMeshFlags, Triangle,
    TrianglePseudoNormals,
};

use crate::parry::composite::compound;
use crate::parry::composite::seams::Seams;
use crate::parry::composite::sub_manifolds::{SubManifolds, SubShape};
use crate::parry::constraints::{Constraints, TriangleSeams};
use crate::parry::leaning_normals::LeaningNormals;
use crate::parry::order::PairOrder;

/// A shape made of triangles.
#[derive(Clone, Copy)]
pub(crate) enum Triangles<'a> {
    Mesh(&'a TriMesh),
    Field(&'a HeightField),
}

impl<'a> Triangles<'a> {
    pub fn of(shape: &'a dyn Shape) -> Option<Self> {
        let mesh = shape.as_trimesh().map(Self::Mesh);
        mesh.or_else(|| shape.as_heightfield().map(Self::Field))
    }

    fn aabb(self) -> Aabb {
        match self {
            Self::Mesh(mesh) => mesh.local_aabb(),
            Self::Field(field) => field.local_aabb(),
        }
    }

    /// Calls `f` for the triangles whose boxes meet a box, always in the same order.
    fn each_near(self, aabb: &Aabb, mut f: impl FnMut(u32, &Triangle)) {
        match self {
            Self::Mesh(mesh) => {
                for id in mesh.bvh().intersect_aabb(aabb) {
                    f(id, &mesh.triangle(id));
                }
            }
            Self::Field(field) => field.map_elements_in_local_aabb(aabb, &mut f),
        }
    }

    /// Whether the normals of contacts are corrected.
    fn is_flagged(self) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES),
            Self::Field(field) => field.flags().contains(HeightFieldFlags::FIX_INTERNAL_EDGES),
        }
    }

    fn normals(self, id: u32) -> Option<TrianglePseudoNormals> {
        match self {
            Self::Mesh(mesh) => mesh.triangle_normal_constraints(id),
            Self::Field(field) => field.triangle_normal_constraints(id),
        }
    }
}

/// A shape made of triangles and a hull or a compound; the triangles are first in `order`.
pub(crate) fn triangles<M, C, F>(
    mut sub_manifolds: SubManifolds<'_, M, C, F>,
    pos12: &Pose,
    triangles: Triangles<'_>,
    other: &dyn Shape,
    order: PairOrder,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    if let Some(compound) = other.as_compound() {
        return triangles_and_compound(sub_manifolds, pos12, triangles, compound, order);
    }
    let hull = SubShape::whole(other);
    let near = sub_manifolds.reach(&hull, pos12, order);
    update_near(&mut sub_manifolds, pos12, triangles, (&hull, &near), order);
    sub_manifolds.finish();
}

/// A shape made of triangles and a compound; the triangles are first in `order`. Each part is updated as it would be
/// alone: at the border of a mesh, the contacts of other parts do not keep it from sinking.
fn triangles_and_compound<M, C, F>(
    sub_manifolds: SubManifolds<'_, M, C, F>,
    pos12: &Pose,
    triangles: Triangles<'_>,
    compound: &Compound,
    order: PairOrder,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    let pos21 = pos12.inverse();
    let [_, of_triangles] = order.to_caller([*pos12, pos21]);
    let all = triangles.aabb().transform_by(&of_triangles);
    let all = all.loosened(sub_manifolds.prediction);
    let seams = Seams::near(compound, &all);
    let update = |sub_manifolds: &mut SubManifolds<'_, M, C, F>, corrects: bool| {
        for i in compound.bvh().intersect_aabb(&all) {
            let part = compound::part(compound, &seams, i, corrects);
            let pos12 = part.instead_of_whole(order.is_reversed(), pos12);
            let near = sub_manifolds.reach(&part, &pos12, order);
            update_near(sub_manifolds, &pos12, triangles, (&part, &near), order);
        }
    };
    sub_manifolds.update_all(update, || seams.leave_some());
}

/// The triangles that meet a box around a convex shape; they are first in `order`.
fn update_near<M, C, F>(
    sub_manifolds: &mut SubManifolds<'_, M, C, F>,
    pos12: &Pose,
    triangles: Triangles<'_>,
    (convex, near): (&SubShape<'_>, &Aabb),
    order: PairOrder,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    let is_flagged = triangles.is_flagged();
    let is_left = Cell::new(false);
    let middle = near.center();
    let update = |sub_manifolds: &mut SubManifolds<'_, M, C, F>, corrects: bool| {
        triangles.each_near(near, |id, triangle| {
            let normals = || {
                let normals = triangles.normals(id)?;
                Some(LeaningNormals::towards(middle, triangle.a, normals))
            };
            let seams = TriangleSeams {
                normals: &normals,
                is_left: &is_left,
                is_beyond_border: !corrects,
            };
            let seams = is_flagged.then_some(seams);
            let part = SubShape {
                id,
                constraints: seams.map_or(Constraints::None, Constraints::OfTriangle),
                ..SubShape::whole(triangle)
            };
            sub_manifolds.update_part(pos12, &part, convex, order);
        });
    };
    sub_manifolds.update_group(update, || is_left.get());
}
