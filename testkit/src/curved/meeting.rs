//! Poses that bring two bodies together.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DQuat, DVec3};

use super::body::{Body, Core};
use super::separation::Difference;
use crate::generate::Rng;
use crate::pose::ExactPose;

/// How two bodies lie towards each other. Axes are those of cylinders and cones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meeting {
    Random,
    /// On one axis, one of them perhaps upside down.
    Coaxial,
    /// Their centres coincide; no gap can be chosen.
    Concentric,
    /// Axes are parallel.
    Parallel,
    /// Not turned, or by quarters.
    Square,
    /// A flat side, a base or a line of the one lies on that of the other.
    Flat,
}

impl Meeting {
    pub const ALL: [Self; 6] = [
        Self::Random,
        Self::Coaxial,
        Self::Concentric,
        Self::Parallel,
        Self::Square,
        Self::Flat,
    ];

    /// A pose in which the bodies are apart by `gap`, as f32 holds it; `None` where they never are.
    pub fn pose(self, rng: &mut Rng, bodies: [&Body; 2], gap: f64) -> Option<ExactPose> {
        let flip = DQuat::from_rotation_x(TAU * 0.5 * rng.count(0, 1) as f64);
        let spin = DQuat::from_rotation_y(rng.range(0.0, TAU)) * flip;
        let (rotation, direction) = match self {
            Self::Random => (rng.rotation(), rng.direction()),
            Self::Coaxial => (spin, DVec3::Y),
            Self::Concentric => {
                let rotation = rng.rotation();
                return Some(
                    ExactPose {
                        rotation,
                        translation: DVec3::ZERO,
                    }
                    .rounded(),
                );
            }
            Self::Parallel => (spin, rng.direction()),
            Self::Square => (quarters(rng), rng.direction()),
            Self::Flat => {
                let [up, down] = bodies.map(|body| flat_side(body, rng));
                let turn = DQuat::from_rotation_arc(down, -up);
                let aside = up.any_orthonormal_vector() * rng.range(-0.5, 0.5);
                let twist = DQuat::from_axis_angle(up, rng.range(0.0, TAU));
                (twist * turn, up + twist * aside)
            }
        };
        apart(bodies, rotation, direction.normalize(), gap)
    }
}

/// The same pose, turned by at most `angle` about some axis through the second body's centre.
pub fn tilted(pose: ExactPose, rng: &mut Rng, angle: f64) -> ExactPose {
    let tilt = DQuat::from_axis_angle(rng.direction(), rng.range(-angle, angle));
    ExactPose {
        rotation: tilt * pose.rotation,
        ..pose
    }
    .rounded()
}

fn quarters(rng: &mut Rng) -> DQuat {
    let quarter = |axis, count: usize| DQuat::from_axis_angle(axis, FRAC_PI_2 * count as f64);
    quarter(DVec3::X, rng.count(0, 3))
        * quarter(DVec3::Y, rng.count(0, 3))
        * quarter(DVec3::Z, rng.count(0, 3))
}

/// The normal of a side that is flat, or of a line that the surface has along its axis.
fn flat_side(body: &Body, rng: &mut Rng) -> DVec3 {
    let (sin, cos) = rng.range(0.0, TAU).sin_cos();
    let around = DVec3::new(cos, 0.0, sin);
    let is_side = rng.count(0, 1) == 0;
    match &body.core {
        Core::Cylinder { .. } if is_side => around,
        Core::Cylinder { .. } => DVec3::Y,
        Core::Cone {
            half_height,
            radius,
        } if is_side => (around * 2.0 * *half_height + DVec3::Y * *radius).normalize(),
        Core::Cone { .. } => -DVec3::Y,
        Core::Ellipsoid(_) => rng.direction(),
        Core::HalfSpace(up) => *up,
        Core::Points(points) => match points[..] {
            [_] => rng.direction(),
            [a, b] => {
                let axis = (b - a).normalize_or(DVec3::Y);
                DQuat::from_axis_angle(axis, rng.range(0.0, TAU)) * axis.any_orthonormal_vector()
            }
            _ => a_face(points, rng),
        },
    }
}

/// The normal of a plane through three points that has all others beneath it.
fn a_face(points: &[DVec3], rng: &mut Rng) -> DVec3 {
    loop {
        let [a, b, c] = [0; 3].map(|_| points[rng.count(0, points.len() - 1)]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else {
            continue;
        };
        let beneath = |p: &DVec3| normal.dot(*p - a) < 1.0e-6 * (b - a).length();
        if points.iter().all(beneath) {
            return normal;
        }
    }
}

/// Where the second body is apart from the first by `gap` when it comes from far along `direction`. The
/// distance is a convex function of the way, so that Newton's steps from outside never pass the place.
fn apart(bodies: [&Body; 2], rotation: DQuat, direction: DVec3, gap: f64) -> Option<ExactPose> {
    let sizes = bodies.map(|body| body.diameter());
    let size = sizes[0].min(sizes[1]);
    let far = sizes
        .into_iter()
        .filter(|size| size.is_finite())
        .sum::<f64>()
        + gap.abs();
    let mut way = 2.0 * far;
    for _ in 0..60 {
        let pose = ExactPose {
            rotation,
            translation: direction * way,
        };
        let found = Difference::new(bodies, pose).signed_distance();
        let excess = found.lower - gap;
        if excess.abs() < 1.0e-9 * size {
            return Some(pose.rounded());
        }
        let slope = found.normal.dot(direction);
        if slope <= 1.0e-3 {
            return None;
        }
        way -= excess / slope;
    }
    None
}
