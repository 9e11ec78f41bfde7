//! PhysX's contact generation for two convex meshes, from its immediate mode.

mod callbacks;

use std::ffi::c_void;
use std::hint::black_box;
use std::mem::size_of;
use std::ptr::{self, NonNull};
use std::sync::Once;

use parry3d::math::{Pose, Real};
use parry3d::shape::SharedShape;
use physx_sys::{
    PxBoundedData, PxConvexFlags, PxConvexMesh, PxConvexMesh_release_mut, PxConvexMeshDesc_new,
    PxConvexMeshGeometry, PxConvexMeshGeometry_new, PxConvexMeshGeometryFlags, PxCookingParams_new,
    PxGeometry, PxMeshScale_new, PxQuat, PxTolerancesScale_new, PxTransform, PxVec3,
    phys_PxCreateConvexMesh, phys_PxGetStandaloneInsertionCallback, physx_create_foundation,
};
use testkit::pair::PREDICTION;

use self::callbacks::{CacheMemory, DeepestContact};
use super::Engine;
use crate::cases::Case;

/// What PhysX keeps of a pair. The bindings lack it.
#[repr(C)]
struct PxCache {
    data: *mut u8,
    size: u16,
    pair_data: u8,
    manifold_flags: u8,
}

#[expect(
    improper_ctypes,
    reason = "of the callbacks, PhysX reads the first field only"
)]
unsafe extern "C" {
    /// Declared in `PxImmediateMode.h` with C's names; the bindings lack it.
    safe fn PxGenerateContacts(
        first: &*const PxGeometry,
        second: &*const PxGeometry,
        pose_of_first: &PxTransform,
        pose_of_second: &PxTransform,
        cache: &mut PxCache,
        pairs: u32,
        recorder: &mut DeepestContact,
        contact_distance: f32,
        mesh_contact_margin: f32,
        tolerance_length: f32,
        allocator: &mut CacheMemory,
    ) -> bool;
}

/// PhysX's own defaults for a world in metres.
const TOLERANCE_LENGTH: f32 = 1.0;
const TOLERANCE_SPEED: f32 = 10.0;
/// Of meshes only, but it must be positive.
const MESH_CONTACT_MARGIN: f32 = 0.01;

pub struct PhysX {
    meshes: [NonNull<PxConvexMesh>; 2],
    geometries: [PxConvexMeshGeometry; 2],
    cache: PxCache,
    memory: CacheMemory,
    deepest: DeepestContact,
}

impl PhysX {
    pub fn new(case: &Case) -> Self {
        static STARTED: Once = Once::new();
        STARTED.call_once(|| {
            // SAFETY: it runs once, before any other call.
            let foundation = unsafe { physx_create_foundation() };
            assert!(!foundation.is_null(), "PhysX starts");
        });
        let meshes = case.shapes.each_ref().map(mesh);
        Self {
            meshes,
            geometries: meshes.map(geometry),
            cache: empty_cache(),
            memory: CacheMemory::new(),
            deepest: DeepestContact::new(),
        }
    }
}

const fn empty_cache() -> PxCache {
    PxCache {
        data: ptr::null_mut(),
        size: 0,
        pair_data: 0,
        manifold_flags: 0,
    }
}

fn mesh(shape: &SharedShape) -> NonNull<PxConvexMesh> {
    let points = shape.as_convex_polyhedron().expect("a hull").points();
    let points: Vec<_> = points.iter().map(|p| vector(p.to_array())).collect();
    // SAFETY: the points are there, as many as said, until the mesh is made.
    let mesh = unsafe {
        let mut description = PxConvexMeshDesc_new();
        description.points = PxBoundedData {
            stride: size_of::<PxVec3>() as u32,
            data: points.as_ptr().cast::<c_void>(),
            count: points.len() as u32,
            ..description.points
        };
        description.flags = PxConvexFlags::ComputeConvex;
        let scale = PxTolerancesScale_new(TOLERANCE_LENGTH, TOLERANCE_SPEED);
        phys_PxCreateConvexMesh(
            &PxCookingParams_new(&raw const scale),
            &raw const description,
            phys_PxGetStandaloneInsertionCallback(),
            ptr::null_mut(),
        )
    };
    NonNull::new(mesh).expect("PhysX takes this hull")
}

fn geometry(mesh: NonNull<PxConvexMesh>) -> PxConvexMeshGeometry {
    // SAFETY: the mesh lives as long as the geometry, which has no destructor.
    unsafe {
        PxConvexMeshGeometry_new(
            mesh.as_ptr(),
            &PxMeshScale_new(),
            PxConvexMeshGeometryFlags::TightBounds,
        )
    }
}

fn vector([x, y, z]: [Real; 3]) -> PxVec3 {
    PxVec3 { x, y, z }
}

fn transform(pose: &Pose) -> PxTransform {
    let [x, y, z, w] = pose.rotation.to_array();
    PxTransform {
        q: PxQuat { x, y, z, w },
        p: vector(pose.translation.to_array()),
    }
}

impl Drop for PhysX {
    fn drop(&mut self) {
        for mesh in self.meshes {
            // SAFETY: it comes from PhysX, and nobody uses it any more.
            unsafe { PxConvexMesh_release_mut(mesh.as_ptr()) };
        }
    }
}

impl Engine for PhysX {
    fn name(&self) -> &'static str {
        "PhysX"
    }

    fn update(&mut self, pose: &Pose) {
        self.deepest.forget();
        let [a, b] = self
            .geometries
            .each_ref()
            .map(|geometry| ptr::from_ref(geometry).cast::<PxGeometry>());
        PxGenerateContacts(
            &a,
            &b,
            &transform(&Pose::IDENTITY),
            &transform(black_box(pose)),
            &mut self.cache,
            1,
            &mut self.deepest,
            PREDICTION,
            MESH_CONTACT_MARGIN,
            TOLERANCE_LENGTH,
            &mut self.memory,
        );
    }

    fn forget(&mut self) {
        self.cache = empty_cache();
    }

    fn deepest(&self) -> Option<Real> {
        self.deepest.get()
    }
}
