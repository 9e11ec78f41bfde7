//! Random hulls and motions, the same ones in every run.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use isa_gjk::HullShape;
use oorandom::Rand64;
use parry3d::math::Vector;
use parry3d::shape::SharedShape;
use parry3d::transformation::try_convex_hull;

use super::cases::Hull;
use super::oracle::Solid;
use super::pose::ExactPose;

/// A plain hull as a `HullShape`.
pub fn prepared(plain: &SharedShape) -> SharedShape {
    let polyhedron = plain.as_convex_polyhedron().expect("a convex polyhedron");
    SharedShape::new(HullShape::try_from(polyhedron.clone()).expect("a solid"))
}

/// A seeded source of geometry.
pub struct Rng(Rand64);

impl Rng {
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
    /// a drum with two flat many-cornered faces. Rolls again where parry's convex hull is not
    /// quite convex.
    pub fn hull(&mut self, vertices: usize, size: f64) -> Hull {
        loop {
            let points = self.corners(vertices, size);
            if let Some(hull) = hull_of(&points) {
                return hull;
            }
        }
    }

    fn corners(&mut self, count: usize, size: f64) -> Vec<Vector> {
        let radii = 0.5 * size * DVec3::new(self.range(0.4, 1.0), self.range(0.4, 1.0), 1.0);
        let is_drum = count >= 6 && count.is_multiple_of(2) && self.range(0.0, 1.0) < 0.3;
        let points: Vec<DVec3> = if is_drum {
            self.drum(count / 2, radii)
        } else {
            (0..count).map(|_| radii * self.direction()).collect()
        };
        points.into_iter().map(|p| p.as_vec3()).collect()
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
    pub fn trajectory(&mut self, frames: usize, reach: f64) -> Vec<ExactPose> {
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

/// The hull of points that are all corners of it, if it comes out convex.
pub fn hull_of(points: &[Vector]) -> Option<Hull> {
    let (corners, faces) = try_convex_hull(points).ok()?;
    let solid = Solid::new(corners.iter().map(|p| p.as_dvec3()).collect(), &faces);
    let is_convex = solid.concavity() < 1.0e-7 * solid.diameter();
    let shape = SharedShape::convex_mesh(corners, &faces)?;
    (is_convex && solid.points.len() == points.len()).then_some(Hull { solid, shape })
}
