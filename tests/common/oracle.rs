//! Brute force in f64: what an answer is measured against.

use glam::DVec3;

use super::pose::ExactPose;

/// A convex polyhedron in f64.
pub struct Solid {
    pub points: Vec<DVec3>,
    /// The planes of its triangles: unit outward normal, and offset along it.
    planes: Vec<(DVec3, f64)>,
}

impl Solid {
    /// The hull with these `points`, whose triangular `faces` turn counter-clockwise.
    pub fn new(points: Vec<DVec3>, faces: &[[u32; 3]]) -> Self {
        let planes = faces
            .iter()
            .filter_map(|face| {
                let [a, b, c] = face.map(|i| points[i as usize]);
                let normal = (b - a).cross(c - a).try_normalize()?;
                Some((normal, normal.dot(a)))
            })
            .collect();
        Self { points, planes }
    }

    /// The largest value of `direction · p` over the solid.
    pub fn support(&self, direction: DVec3) -> f64 {
        self.points
            .iter()
            .map(|p| p.dot(direction))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// How far `point` is beyond the plane it violates most; negative inside.
    pub fn outside(&self, point: DVec3) -> f64 {
        self.planes
            .iter()
            .map(|(normal, offset)| normal.dot(point) - offset)
            .fold(f64::NEG_INFINITY, f64::max)
    }
}

/// `s(n) = min_b n·b − max_a n·a`: the signed distance is its maximum over all unit `n`.
pub fn separation_along(a: &Solid, b: &Solid, pose: &ExactPose, normal: DVec3) -> f64 {
    let in_b = pose.rotation.inverse() * normal;
    normal.dot(pose.translation) - b.support(-in_b) - a.support(normal)
}
