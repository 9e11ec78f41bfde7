//! Contacts of hulls with triangle meshes and height fields.
//!
//! Parry's routines compute the pseudo-normals of every triangle nearby, most of which have no
//! contact, and move the manifolds of a height field from frame to frame through a hash table.
//! Here normals are computed where there is a contact to correct, and manifolds stay where they
//! are.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::query::ContactManifold;
use parry3d::query::details::ContactManifoldsWorkspace;
use parry3d::shape::{
    HeightField, HeightFieldFlags, Shape, TriMesh, TriMeshFlags, Triangle, TrianglePseudoNormals,
};

use super::constraints::Constraints;
use super::hulls::LastProved;
use super::sub_pairs::{Part, Update};
use super::{IsaGjkDispatcher, pair};

/// A shape made of triangles.
#[derive(Clone, Copy)]
enum Triangles<'a> {
    Mesh(&'a TriMesh),
    Field(&'a HeightField),
}

impl<'a> Triangles<'a> {
    fn of(shape: &'a dyn Shape) -> Option<Self> {
        let mesh = shape.as_trimesh().map(Self::Mesh);
        mesh.or_else(|| shape.as_heightfield().map(Self::Field))
    }

    /// Hands those whose boxes meet a box to `f`, always in the same order.
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

    fn has_normals(self) -> bool {
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

/// A hull and a shape made of triangles, in either order. `false` for other pairs.
pub(super) fn contact_manifolds<M, C>(
    dispatcher: &IsaGjkDispatcher,
    pos12: &Pose,
    [s1, s2]: [&dyn Shape; 2],
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> bool
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    let (triangles, hull, swapped) = match [Triangles::of(s1), Triangles::of(s2)] {
        [Some(triangles), None] => (triangles, s2, false),
        [None, Some(triangles)] => (triangles, s1, true),
        _ => return false,
    };
    if !pair::is_hull(hull, hull.shape_type()) {
        return false;
    }
    let mut update = Update::begin(dispatcher, prediction, manifolds, workspace);
    let place = if swapped { pos12.inverse() } else { *pos12 };
    let near = hull.compute_aabb(&place).loosened(prediction);
    let mut hull = Part::whole(hull);
    let has_normals = triangles.has_normals();
    triangles.each_near(&near, |id, triangle| {
        let normals = || triangles.normals(id);
        let mut part = Part {
            id,
            shape: triangle,
            pos: None,
            constraints: if has_normals {
                Constraints::OfTriangle(&normals)
            } else {
                Constraints::None
            },
            proved: LastProved::default(),
        };
        if swapped {
            update.parts(pos12, &mut hull, &mut part);
        } else {
            update.parts(pos12, &mut part, &mut hull);
        }
    });
    update.end();
    true
}
