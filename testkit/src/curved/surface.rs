//! How far a point is outside of a body.

use glam::{DVec2, DVec3};

use super::body::{Body, Core};
use super::separation::Difference;
use crate::oracle::distance_to_segment;
use crate::pose::ExactPose;

impl Body {
    /// The signed distance of a point to the surface, negative inside.
    pub fn outside(&self, point: DVec3) -> f64 {
        let in_half_plane = DVec2::new(point.x.hypot(point.z), point.y);
        let core = match &self.core {
            Core::Points(points) => match points[..] {
                [p] => point.distance(p),
                [a, b] => distance_to_segment(point, [a, b]),
                _ => self.outside_core(point),
            },
            Core::Cylinder {
                half_height,
                radius,
            } => {
                let beyond = DVec2::new(in_half_plane.x - radius, point.y.abs() - half_height);
                outside_corner(beyond)
            }
            Core::Cone {
                half_height,
                radius,
            } => outside_cone(in_half_plane, *half_height, *radius),
            Core::Ellipsoid(_) => self.outside_core(point),
            Core::HalfSpace(normal) => normal.dot(point),
        };
        core - self.border
    }

    fn outside_core(&self, point: DVec3) -> f64 {
        let ball = Self::ball(0.0);
        let pose = ExactPose {
            rotation: glam::DQuat::IDENTITY,
            translation: point,
        };
        let core = Self {
            border: 0.0,
            ..self.clone()
        };
        Difference::new([&core, &ball], pose)
            .signed_distance()
            .lower
    }
}

/// Of a quadrant, whose corner is the origin.
fn outside_corner(beyond: DVec2) -> f64 {
    beyond.max(DVec2::ZERO).length() + beyond.max_element().min(0.0)
}

/// Of a cone, in the half plane of a point and the axis.
fn outside_cone(p: DVec2, half_height: f64, radius: f64) -> f64 {
    let (rim, apex) = (
        DVec2::new(radius, -half_height),
        DVec2::new(0.0, half_height),
    );
    let outward = DVec2::new(2.0 * half_height, radius).normalize();
    let beyond = [-half_height - p.y, outward.dot(p - apex)];
    if beyond.iter().all(|distance| *distance <= 0.0) {
        return beyond[0].max(beyond[1]);
    }
    let to_segment =
        |a: DVec2, b: DVec2| distance_to_segment(p.extend(0.0), [a.extend(0.0), b.extend(0.0)]);
    to_segment(rim, apex).min(to_segment(DVec2::new(0.0, -half_height), rim))
}
