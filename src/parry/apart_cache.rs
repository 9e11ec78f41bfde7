//! Proofs that two hulls are apart, which hold while the hulls hardly move.
//!
//! A proof is that of an axis, or of the bounding spheres, at some pose. If the second shape is at another
//! pose now, none of its points is farther from where it was, seen from the shape in whose frame the axis is
//! kept, than the translation and the chord of the rotation allow. What this leaves of the gap is proved. The
//! pose of the proof is compared with the present one, so nothing adds up from frame to frame.
//!
//! A query would find the same axis, or the spheres, to separate the shapes, and would leave the manifold as
//! it is: a margin covers what both are rounded by. So whether a proof is here changes only how long an answer
//! takes.

use glam::{DVec3, Quat, Vec3};
use parry3d::math::Pose;

use crate::ids::ShapeId;
use crate::slot::slot;
use crate::stats::Stage;
use crate::tolerance::{NEARLY_UNIT, PROOF_MARGIN};

/// How many proofs there are, if no two pairs share a slot: 256 KiB, once there is the first.
const SLOTS: usize = 1 << SLOT_BITS;
const SLOT_BITS: u32 = 12;

/// Proofs of many pairs. Where to look is decided by a key, and what is found there by its shapes and axis.
#[derive(Default)]
pub(crate) struct ApartCache(Box<[Proof]>);

/// Fills one cache line.
#[derive(Clone, Copy, Default)]
#[repr(C, align(64))]
struct Proof {
    rotation: Quat,
    shapes: [Option<ShapeId>; 2],
    translation: Vec3,
    /// How far the shapes were apart, less the margin.
    separation: f32,
    axis: Vec3,
    /// The longest lever of a rotation.
    lever: f32,
}

/// Whose proof it is.
pub(crate) struct ApartPair<'a> {
    pub key: u64,
    pub shapes: [ShapeId; 2],
    /// As the manifold keeps it: zero stands for the spheres.
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
        let Some(proof) = self.0.get(slot(pair.key, SLOT_BITS)) else {
            return false;
        };
        proof.shapes == pair.shapes.map(Some)
            && bits(proof.axis) == bits(pair.axis)
            && proof.separation_at(pair.pose) > max_distance
    }

    /// Keeps the proof of a separation. `size` is that of both shapes, and no point that moves is farther than
    /// `lever` from the centre of its rotation.
    #[inline(never)]
    pub fn store(&mut self, pair: &ApartPair<'_>, separation: f64, [size, lever]: [f64; 2]) {
        if !is_nearly_unit(pair.pose.rotation) {
            return;
        }
        if self.0.is_empty() {
            self.0 = vec![Proof::default(); SLOTS].into();
        }
        let margin = (1.0 - PROOF_MARGIN) * (size + separation.abs());
        self.0[slot(pair.key, SLOT_BITS)] = Proof {
            rotation: pair.pose.rotation,
            shapes: pair.shapes.map(Some),
            translation: pair.pose.translation,
            // Shapes may be farther apart than f32 can say.
            separation: ((separation - margin) as f32).min(f32::MAX),
            axis: pair.axis,
            lever: (lever / PROOF_MARGIN) as f32,
        };
    }
}

impl Proof {
    /// How far the shapes are apart at another pose, at least. Not a number if the pose is not.
    #[inline]
    fn separation_at(&self, pose: &Pose) -> f64 {
        if !is_nearly_unit(pose.rotation) {
            return f64::NAN;
        }
        let moved = exact_difference(pose.translation, self.translation).length();
        // A chord of a turned unit sphere is at most twice that between the unit quaternions.
        let turned = 2.0 * f64::from((pose.rotation - self.rotation).length());
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

#[inline]
fn is_nearly_unit(rotation: Quat) -> bool {
    (rotation.length_squared() - 1.0).abs() < NEARLY_UNIT as f32
}
