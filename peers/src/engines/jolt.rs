//! Jolt's convex collision, through its C interface: the deepest contact only.

use std::ffi::c_void;
use std::hint::black_box;
use std::ptr::{self, NonNull};
use std::sync::Once;

use oxijolt_sys::{
    JPH_CollideShapeResult, JPH_CollideShapeSettings, JPH_CollideShapeSettings_Init,
    JPH_CollisionDispatch_CollideShapeVsShape, JPH_ConvexHullShapeSettings_Create,
    JPH_ConvexHullShapeSettings_CreateShape, JPH_DEFAULT_CONVEX_RADIUS, JPH_Init, JPH_Mat4,
    JPH_Shape, JPH_Shape_Destroy, JPH_Shape_GetCenterOfMass, JPH_ShapeSettings_Destroy, JPH_Vec3,
    JPH_Vec4,
};
use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::SharedShape;
use testkit::pair::PREDICTION;

use super::Engine;
use crate::cases::Case;

pub struct Jolt {
    hulls: [Hull; 2],
    settings: JPH_CollideShapeSettings,
    deepest: Option<Real>,
}

/// A hull with the border that Jolt gives to hulls by default. Jolt places it by its centre of mass.
struct Hull {
    shape: NonNull<JPH_Shape>,
    center_of_mass: Vector,
}

impl Jolt {
    pub fn new(case: &Case) -> Self {
        static STARTED: Once = Once::new();
        STARTED.call_once(|| {
            // SAFETY: it runs once, before any other call.
            assert!(unsafe { JPH_Init() }, "Jolt starts");
        });
        let mut settings = JPH_CollideShapeSettings {
            maxSeparationDistance: 0.0,
            // SAFETY: a plain C struct, of which zeros are a valid value; filled in below.
            ..unsafe { std::mem::zeroed() }
        };
        // SAFETY: the settings are there until the call returns.
        unsafe { JPH_CollideShapeSettings_Init(&raw mut settings) };
        settings.maxSeparationDistance = PREDICTION;
        Self {
            hulls: case.shapes.each_ref().map(Hull::new),
            settings,
            deepest: None,
        }
    }
}

impl Hull {
    fn new(shape: &SharedShape) -> Self {
        let points = shape.as_convex_polyhedron().expect("a hull").points();
        let points: Vec<_> = points.iter().map(|&p| vector(p)).collect();
        let count = u32::try_from(points.len()).expect("a small hull");
        let mut center = vector(Vector::ZERO);
        // SAFETY: the points are there, as many as said, until the first call returns; the settings
        // go when the shape is made, and the shape lives as long as `self`.
        let shape = unsafe {
            let settings = JPH_ConvexHullShapeSettings_Create(
                points.as_ptr(),
                count,
                JPH_DEFAULT_CONVEX_RADIUS as f32,
            );
            let shape = JPH_ConvexHullShapeSettings_CreateShape(settings).cast::<JPH_Shape>();
            JPH_ShapeSettings_Destroy(settings.cast());
            let shape = NonNull::new(shape).expect("Jolt takes this hull");
            JPH_Shape_GetCenterOfMass(shape.as_ptr(), &raw mut center);
            shape
        };
        Self {
            shape,
            center_of_mass: Vector::new(center.x, center.y, center.z),
        }
    }

    fn transform(&self, pose: &Pose) -> JPH_Mat4 {
        let center = pose.transform_point(self.center_of_mass);
        let column = |v: Vector, w| JPH_Vec4 {
            x: v.x,
            y: v.y,
            z: v.z,
            w,
        };
        JPH_Mat4 {
            column: [
                column(pose.rotation * Vector::X, 0.0),
                column(pose.rotation * Vector::Y, 0.0),
                column(pose.rotation * Vector::Z, 0.0),
                column(center, 1.0),
            ],
        }
    }
}

impl Drop for Hull {
    fn drop(&mut self) {
        // SAFETY: it comes from Jolt, and nobody uses it any more.
        unsafe { JPH_Shape_Destroy(self.shape.as_ptr()) };
    }
}

fn vector(v: Vector) -> JPH_Vec3 {
    JPH_Vec3 {
        x: v.x,
        y: v.y,
        z: v.z,
    }
}

/// Keeps the deepest contact in the place that `context` points to.
unsafe extern "C" fn keep(context: *mut c_void, result: *const JPH_CollideShapeResult) -> f32 {
    // SAFETY: `update` passes such a place, and Jolt a result; nobody else uses them meanwhile.
    let (deepest, result) = unsafe { (&mut *context.cast::<Option<Real>>(), &*result) };
    let distance = -result.penetrationDepth;
    *deepest = Some(deepest.map_or(distance, |deepest| deepest.min(distance)));
    // Jolt stops looking below this: everything is welcome.
    f32::MAX
}

impl Engine for Jolt {
    fn name(&self) -> &'static str {
        "Jolt (deepest contact only)"
    }

    fn update(&mut self, pose: &Pose) {
        self.deepest = None;
        let [a, b] = &self.hulls;
        let [at_a, at_b] = [a.transform(&Pose::IDENTITY), b.transform(black_box(pose))];
        let scale = vector(Vector::ONE);
        // SAFETY: all that is pointed to lives until the call returns; `keep` gets its place.
        unsafe {
            JPH_CollisionDispatch_CollideShapeVsShape(
                a.shape.as_ptr(),
                b.shape.as_ptr(),
                &raw const scale,
                &raw const scale,
                &raw const at_a,
                &raw const at_b,
                &raw const self.settings,
                Some(keep),
                (&raw mut self.deepest).cast(),
                ptr::null(),
            );
        }
    }

    /// It keeps nothing of a pair: Jolt's own step keeps a manifold where bodies hardly moved, which is not
    /// measured here.
    fn forget(&mut self) {}

    fn deepest(&self) -> Option<Real> {
        self.deepest
    }
}
