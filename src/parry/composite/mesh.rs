//! Contacts of hulls with triangle meshes and height fields.
//!
//! parry's routines compute the pseudo-normals of every nearby triangle, most of which have no contact, and
//! move the manifolds of a height field through a hash table in each frame. We compute normals only if there
//! is a contact to correct, and manifolds stay where they are.

use std::cell::Cell;

use parry3d::bounding_volume::Aabb;
use parry3d::math::Pose;
use parry3d::query::PersistentQueryDispatcher;
use parry3d::shape::{
    HeightField, HeightFieldFlags, Shape, TriMesh, TriMeshFlags, Triangle, TrianglePseudoNormals,
};

use crate::parry::composite::sub_manifolds::{SubManifolds, SubShape};
use crate::parry::constraints::{Constraints, LeaningNormals, TriangleSeams};
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

/// A shape made of triangles and a hull; the triangles are first in `order`.
pub(crate) fn triangles_and_hull<M, C, F>(
    sub_manifolds: SubManifolds<'_, M, C, F>,
    pos12: &Pose,
    triangles: Triangles<'_>,
    hull: &dyn Shape,
    order: PairOrder,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C>,
{
    let hull = SubShape::whole(hull);
    let near = sub_manifolds.reach(&hull, pos12, order);
    let is_flagged = triangles.is_flagged();
    let is_left = Cell::new(false);
    let middle = near.center();
    let update = |sub_manifolds: &mut SubManifolds<'_, M, C, F>, corrects: bool| {
        triangles.each_near(&near, |id, triangle| {
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
            let constraints = seams.map_or(Constraints::None, Constraints::OfTriangle);
            let part = SubShape {
                id,
                constraints,
                ..SubShape::whole(triangle)
            };
            sub_manifolds.update_part(pos12, &part, &hull, order);
        });
    };
    sub_manifolds.update_all(update, || is_left.get());
}
