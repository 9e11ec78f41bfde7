//! Box3D's hull collision, through its C interface.

use std::hint::black_box;
use std::mem;
use std::ptr::NonNull;

use boxddd_sys::ffi::{
    b3CollideHulls, b3CreateHull, b3DestroyHull, b3HullData, b3LocalManifold, b3LocalManifoldPoint,
    b3Quat, b3SATCache, b3Transform, b3Vec3,
};
use parry3d::math::{Pose, Real};
use parry3d::shape::SharedShape;

use super::Engine;
use crate::cases::Case;

/// Room for the contacts of one update.
const CAPACITY: usize = 64;

pub struct Box3d {
    hulls: [Hull; 2],
    cache: b3SATCache,
    points: [b3LocalManifoldPoint; CAPACITY],
    count: usize,
}

struct Hull(NonNull<b3HullData>);

impl Box3d {
    /// `None` for hulls that Box3D does not take: it allows 256 half-edges.
    pub fn new(case: &Case) -> Option<Self> {
        let [a, b] = case.shapes.each_ref().map(Hull::new);
        Some(Self {
            hulls: [a?, b?],
            cache: empty(),
            points: [const { empty() }; CAPACITY],
            count: 0,
        })
    }
}

/// All of these are plain C structs, of which zeros are a valid value.
const fn empty<T: Copy>() -> T {
    // SAFETY: the types that it is called with hold numbers and pointers that may be null.
    unsafe { mem::zeroed() }
}

impl Hull {
    fn new(shape: &SharedShape) -> Option<Self> {
        let points = shape.as_convex_polyhedron().expect("a hull").points();
        let points: Vec<_> = points.iter().map(|p| vector(p.to_array())).collect();
        let count = i32::try_from(points.len()).expect("a small hull");
        // SAFETY: the points are there, as many as said, until the call returns.
        let hull = unsafe { b3CreateHull(points.as_ptr(), count, count) };
        NonNull::new(hull).map(Self)
    }
}

fn vector([x, y, z]: [Real; 3]) -> b3Vec3 {
    b3Vec3 { x, y, z }
}

impl Drop for Hull {
    fn drop(&mut self) {
        // SAFETY: it comes from `b3CreateHull`, and nobody uses it any more.
        unsafe { b3DestroyHull(self.0.as_ptr()) };
    }
}

impl Engine for Box3d {
    fn name(&self) -> &'static str {
        "Box3D"
    }

    fn update(&mut self, pose: &Pose) {
        let [x, y, z, s] = pose.rotation.to_array();
        let transform = b3Transform {
            p: vector(pose.translation.to_array()),
            q: b3Quat {
                v: vector([x, y, z]),
                s,
            },
        };
        let mut manifold: b3LocalManifold = empty();
        manifold.points = self.points.as_mut_ptr();
        let [a, b] = self
            .hulls
            .each_ref()
            .map(|hull| hull.0.as_ptr().cast_const());
        // SAFETY: the hulls live as long as `self`, and the manifold has room for so many points.
        unsafe {
            b3CollideHulls(
                &raw mut manifold,
                CAPACITY as i32,
                a,
                b,
                black_box(transform),
                &raw mut self.cache,
            );
        }
        self.count = manifold.pointCount as usize;
    }

    fn forget(&mut self) {
        self.cache = empty();
    }

    fn deepest(&self) -> Option<Real> {
        let points = self.points[..self.count].iter();
        points.map(|point| point.separation).reduce(Real::min)
    }
}
