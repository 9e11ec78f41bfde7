//! Shapes of growing size, and how they move.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use isa_gjk::Hull;
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Support, VertexId};
use oorandom::Rand64;
use parry3d::math::Pose;

/// A unit vector, uniform on the sphere.
pub fn direction(random: &mut Rand64) -> DVec3 {
    let (z, angle) = (2.0 * random.rand_float() - 1.0, TAU * random.rand_float());
    let radius = (1.0 - z * z).sqrt();
    DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
}

/// The hull of random points on a sphere, one metre in diameter.
pub fn sphere(count: usize, seed: u128) -> Hull {
    let mut random = Rand64::new(seed);
    let points: Vec<_> = (0..count)
        .map(|_| (direction(&mut random) * 0.5).as_vec3())
        .collect();
    Hull::from_points(&points).expect("points on a sphere have a hull")
}

/// A pose from frame to frame: 0.5 degrees and 2 mm apart, the centres `distance` from each other.
pub fn orbit(frames: usize, distance: f64) -> Vec<Pose> {
    let axis = DVec3::new(0.3, 0.8, 0.5).normalize();
    (0..frames)
        .map(|frame| {
            let angle = 2.0e-3 * frame as f64 / distance;
            let tilt = DQuat::from_rotation_x(0.7);
            let at = tilt * DVec3::new(angle.cos(), angle.sin(), 0.0) * distance;
            let turn = DQuat::from_axis_angle(axis, (0.5 * frame as f64).to_radians());
            Pose::from_parts(at.as_vec3(), turn.as_quat())
        })
        .collect()
}

/// Points in f64 whose supports are found by a scan.
pub struct Cloud {
    points: Vec<DVec3>,
    center: DVec3,
    radius: f64,
}

impl Cloud {
    pub fn new(points: Vec<DVec3>) -> Self {
        let center = points.iter().sum::<DVec3>() / points.len() as f64;
        let distances = points.iter().map(|p| p.distance(center));
        let radius = distances.fold(0.0, f64::max);
        Self {
            points,
            center,
            radius,
        }
    }

    /// The vertices of a hull.
    pub fn of(hull: &Hull) -> Self {
        Self::new(hull.points().iter().map(|p| p.as_dvec3()).collect())
    }

    /// In the manner of the death polytope (GJK 1988, section VII): vertices on a paraboloid,
    /// each half as far from its apex as the one before, on a spiral so that they span a volume.
    pub fn death(count: usize) -> Self {
        let vertex = |k: usize| {
            let radius = 0.5_f64.powi(k as i32);
            let (sin, cos) = (0.4 * k as f64).sin_cos();
            DVec3::new(radius * cos, radius * sin, radius * radius)
        };
        Self::new((0..count).map(vertex).collect())
    }
}

impl Support for Cloud {
    fn support(&self, dir: DVec3, _: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        let mut best = (f64::NEG_INFINITY, 0);
        for (i, p) in self.points.iter().enumerate() {
            let height = dir.dot(*p);
            if height > best.0 {
                best = (height, i);
            }
        }
        (self.points[best.1], VertexId::new(best.1))
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn radius(&self) -> f64 {
        self.radius
    }
}
