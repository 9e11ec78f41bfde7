//! Random hulls and motions, the same ones in every run.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use oorandom::Rand64;
use parry3d::math::Vector;
use parry3d::shape::SharedShape;
use parry3d::transformation::try_convex_hull;

use super::cases::Hull;
use super::oracle::Solid;
use super::pose::ExactPose;

/// A seeded source of geometry.
pub struct Dice(Rand64);

impl Dice {
    pub fn new(seed: u128) -> Self {
        Self(Rand64::new(seed))
    }

    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.rand_float()
    }

    pub fn count(&mut self, low: usize, high: usize) -> usize {
        self.0.rand_range(low as u64..high as u64 + 1) as usize
    }

    /// A unit vector, uniform on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.range(-1.0, 1.0), self.range(0.0, TAU));
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
    }

    pub fn rotation(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.direction(), self.range(0.0, TAU))
    }

    /// A hull of about `size` in diameter with exactly `vertices` corners: round, stretched, or
    /// a drum with two flat many-cornered faces.
    pub fn hull(&mut self, vertices: usize, size: f64) -> Hull {
        let radii = 0.5 * size * DVec3::new(self.range(0.4, 1.0), self.range(0.4, 1.0), 1.0);
        let flat = vertices.is_multiple_of(2) && self.range(0.0, 1.0) < 0.3;
        let points: Vec<Vector> = if flat {
            self.drum(vertices / 2, radii)
        } else {
            (0..vertices).map(|_| radii * self.direction()).collect()
        }
        .into_iter()
        .map(|p| p.as_vec3())
        .collect();
        hull_of(&points)
    }

    /// Two regular polygons above each other, the upper one smaller.
    fn drum(&mut self, sides: usize, radii: DVec3) -> Vec<DVec3> {
        let taper = self.range(0.5, 0.95);
        let corner = |i: usize, width: f64, height: f64| {
            let angle = TAU * i as f64 / sides as f64;
            radii * DVec3::new(width * angle.cos(), width * angle.sin(), height)
        };
        (0..sides)
            .flat_map(|i| [corner(i, 1.0, -0.5), corner(i, taper, 0.5)])
            .collect()
    }

    /// A smooth relative motion of `frames` frames that starts apart, passes through touching
    /// and deep contact, and ends apart, for two shapes whose centres touch at about `reach`.
    pub fn passage(&mut self, frames: usize, reach: f64) -> Vec<ExactPose> {
        let along = self.direction();
        let aside = along.any_orthonormal_vector() * self.range(0.0, 0.3) * reach;
        let (first, turn) = (self.rotation(), self.direction());
        let angle = self.range(0.2, 1.5);
        (0..frames)
            .map(|frame| {
                let t = frame as f64 / (frames - 1) as f64;
                let pose = ExactPose {
                    rotation: DQuat::from_axis_angle(turn, angle * t) * first,
                    translation: along * (2.4 * t - 1.2) * reach + aside,
                };
                pose.rounded()
            })
            .collect()
    }

    /// An unrelated pose no farther than `reach`.
    pub fn pose(&mut self, reach: f64) -> ExactPose {
        let pose = ExactPose {
            rotation: self.rotation(),
            translation: self.direction() * self.range(0.0, reach),
        };
        pose.rounded()
    }
}

/// The hull of points that are all corners of it.
pub fn hull_of(points: &[Vector]) -> Hull {
    let (corners, faces) = try_convex_hull(points).expect("the points span a solid");
    assert_eq!(corners.len(), points.len(), "all points are corners");
    let solid = Solid::new(corners.iter().map(|p| p.as_dvec3()).collect(), &faces);
    let bulge = solid.concavity() / solid.diameter();
    assert!(
        bulge < 1.0e-6,
        "the generated hull is not convex: {bulge:e}"
    );
    let shape = SharedShape::convex_mesh(corners, &faces).expect("a closed surface");
    Hull { solid, shape }
}
