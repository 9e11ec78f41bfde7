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

/// What is right for a trajectory.
pub struct Oracle {
    /// Of the larger hull.
    diameter: f64,
    /// At each pose, in diameters.
    distances: Vec<f64>,
}

impl Oracle {
    pub fn new(case: &Case) -> Self {
        let [a, b] = case.shapes.each_ref().map(solid);
        let diameter = a.diameter().max(b.diameter());
        let poses = case.poses.iter().map(exactly);
        let distances = poses.map(|pose| signed_distance(&a, &b, &pose) / diameter);
        Self {
            diameter,
            distances: distances.collect(),
        }
    }

    /// Goes through the trajectory once and compares the deepest contacts.
    pub fn judge(&self, case: &Case, engine: &mut dyn Engine) -> Verdict {
        let mut verdict = Verdict::default();
        engine.forget();
        for (pose, &exact) in case.poses.iter().zip(&self.distances) {
            engine.update(pose);
            let deepest = engine.deepest();
            let overlap = deepest
                .map(|distance| f64::from(distance) / self.diameter)
                .filter(|&deepest| deepest < 0.0);
            verdict.missing += u32::from(exact < -UNDECIDED && overlap.is_none());
            verdict.phantom += u32::from(exact > UNDECIDED && overlap.is_some());
            if let Some(overlap) = overlap
                && exact < 0.0
            {
                let error = (overlap - exact).abs();
                verdict.gross += u32::from(error > GROSS);
                verdict.worst = verdict.worst.max(error);
            }
        }
        verdict
    }
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
