//! How right an engine's depths are.

use parry3d::math::Pose;
use parry3d::shape::SharedShape;
use testkit::oracle::{Solid, signed_distance};
use testkit::pose::ExactPose;

use crate::cases::Case;
use crate::engines::Engine;

/// Within this share of the diameter a pair is neither apart nor overlapping.
const UNDECIDED: f64 = 1e-3;
/// Depths that are wrong by this share of the diameter are gross errors.
const GROSS: f64 = 1e-2;

/// Counts of poses, and the worst error of a depth in diameters.
#[derive(Clone, Copy, Debug, Default)]
pub struct Verdict {
    pub missing: u32,
    pub phantom: u32,
    pub gross: u32,
    pub worst: f64,
}

/// The signed distance at each pose, in diameters.
pub fn exact(case: &Case) -> Vec<f64> {
    let [a, b] = case.shapes.each_ref().map(solid);
    let diameter = a.diameter().max(b.diameter());
    let poses = case.poses.iter();
    poses
        .map(|pose| signed_distance(&a, &b, &exactly(pose)) / diameter)
        .collect()
}

/// Goes through the trajectory once and compares the deepest contacts.
pub fn judge(case: &Case, exact: &[f64], engine: &mut dyn Engine) -> Verdict {
    let [a, b] = case.shapes.each_ref().map(solid);
    let diameter = a.diameter().max(b.diameter());
    let mut verdict = Verdict::default();
    engine.forget();
    for (pose, &exact) in case.poses.iter().zip(exact) {
        engine.update(pose);
        let deepest = engine
            .deepest()
            .map(|distance| f64::from(distance) / diameter);
        let overlaps = deepest.is_some_and(|deepest| deepest < 0.0);
        verdict.missing += u32::from(exact < -UNDECIDED && !overlaps);
        verdict.phantom += u32::from(exact > UNDECIDED && overlaps);
        if let Some(deepest) = deepest
            && exact < 0.0
            && overlaps
        {
            let error = (deepest - exact).abs();
            verdict.gross += u32::from(error > GROSS);
            verdict.worst = verdict.worst.max(error);
        }
    }
    verdict
}

fn exactly(pose: &Pose) -> ExactPose {
    ExactPose {
        rotation: pose.rotation.as_dquat().normalize(),
        translation: pose.translation.as_dvec3(),
    }
}

fn solid(shape: &SharedShape) -> Solid {
    let hull = shape.as_convex_polyhedron().expect("a hull");
    let (points, faces) = hull.to_trimesh();
    Solid::new(points.iter().map(|p| p.as_dvec3()).collect(), &faces)
}
