//! Proofs that two hulls are apart, which hold while the hulls hardly move.
//!
//! An axis, or the bounding spheres, proved a gap at some pose. Now the second shape is at another pose. In
//! the frame in which the axis is stored, none of its points has moved farther than the translation plus the
//! chord of the rotation. What this leaves of the gap is still proved. The present pose is compared with that
//! of the proof, so errors do not add up from frame to frame.
//!
//! A query would find that the same axis or the spheres separate the shapes, and would leave the manifold as
//! it is. A margin covers the rounding of both. So a proof in this cache only saves time.

use glam::{DVec3, Quat, Vec3};
use parry3d::math::Pose;

use crate::ids::ShapeId;
use crate::pose::{chord, is_nearly_unit};
use crate::slots::Slots;
use crate::stats::Stage;
use crate::tolerance::PROOF_MARGIN;

/// 4,096 slots, which take 256 KiB.
const SLOT_BITS: u32 = 12;

/// Proofs of many pairs. A key gives the slot; shapes and axis tell whether the proof in it is that of the pair.
#[derive(Default)]
pub(crate) struct ApartCache(Slots<Proof, SLOT_BITS>);

/// Fills one cache line.
#[derive(Clone, Copy, Default)]
#[repr(C, align(64))]
struct Proof {
    rotation: Quat,
    shapes: [Option<ShapeId>; 2],
    translation: Vec3,
    /// The distance between the shapes, less the margin.
    separation: f32,
    axis: Vec3,
    /// The longest lever of a rotation.
    lever: f32,
}

/// The pair of a proof.
pub(crate) struct ApartPair<'a> {
    pub key: u64,
    pub shapes: [ShapeId; 2],
    /// The axis as the manifold stores it. Zero stands for the bounding spheres.
    pub axis: Vec3,
    pub pose: &'a Pose,
}

impl ApartPair<'_> {
    /// The stage of the query that proves it.
    #[inline]
    pub fn stage(&self) -> Stage {
        if self.axis == Vec3::ZERO {
            Stage::BoundingSpheres
        } else {
            Stage::Axis
        }
    }
}

impl ApartCache {
    /// Whether a pair is certainly farther apart than `max_distance`.
    #[inline]
    pub fn proves(&self, pair: &ApartPair<'_>, max_distance: f64) -> bool {
        let Some(proof) = self.0.get(pair.key) else {
            return false;
        };
        proof.shapes == pair.shapes.map(Some)
            && bits(proof.axis) == bits(pair.axis)
            && proof.separation_at(pair.pose) > max_distance
    }

    /// Stores the proof of a separation. `size` is the size of both shapes. No moving point is farther than
    /// `lever` from the centre of its rotation.
    #[inline(never)]
    pub fn store(&mut self, pair: &ApartPair<'_>, separation: f64, [size, lever]: [f64; 2]) {
        if !is_nearly_unit(pair.pose.rotation) {
            return;
        }
        let margin = (1.0 - PROOF_MARGIN) * (size + separation.abs());
        *self.0.get_or_allocate(pair.key) = Proof {
            rotation: pair.pose.rotation,
            shapes: pair.shapes.map(Some),
            translation: pair.pose.translation,
            // The distance may exceed the range of f32.
            separation: ((separation - margin) as f32).min(f32::MAX),
            axis: pair.axis,
            lever: (lever / PROOF_MARGIN) as f32,
        };
    }
}

impl Proof {
    /// A lower bound of the distance between the shapes at another pose. NaN if the pose has a NaN.
    #[inline]
    fn separation_at(&self, pose: &Pose) -> f64 {
        if !is_nearly_unit(pose.rotation) {
            return f64::NAN;
        }
        let moved = exact_difference(pose.translation, self.translation).length();
        let turned = chord(pose.rotation, self.rotation);
        f64::from(self.separation) - moved - turned * f64::from(self.lever)
    }
}

#[inline]
fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(f32::to_bits)
}

#[inline]
fn exact_difference(a: Vec3, b: Vec3) -> DVec3 {
    a.as_dvec3() - b.as_dvec3()
}
