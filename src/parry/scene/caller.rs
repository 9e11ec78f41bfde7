//! Answers for the caller: in its order of the shapes, with borders.

use glam::DVec3;
use parry3d::math::Real;
use parry3d::query::Contact;

use crate::gjk::SeparatingAxis;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::pose::{RelativePose, is_unit};
use crate::query::{Proximity, Sink};

/// The nearest points of a pair, including its rounded borders. Normals and points are in their own shapes'
/// frames.
pub(crate) struct CallerProximity {
    pub signed_distance: f64,
    pub normals: [DVec3; 2],
    pub points: [DVec3; 2],
}

impl CallerProximity {
    pub fn of_proximity(near: &Proximity, frame: &KernelFrame<'_>) -> Self {
        frame.near(near.normal, [near.on_1, near.on_2], near.signed_distance)
    }

    pub fn contact(&self) -> Contact {
        let [p1, p2] = self.points.map(|p| p.as_vec3());
        let [n1, n2] = self.normals.map(|n| n.as_vec3());
        Contact::new(p1, p2, n1, n2, self.signed_distance as Real)
    }
}

/// The pair as the kernels see it: the hull first, in whose frame they answer.
pub(crate) struct KernelFrame<'a> {
    /// The pose of the other shape in the frame of the hull.
    pose: &'a RelativePose,
    border_radii: [f64; 2],
    order: PairOrder,
}

impl<'a> KernelFrame<'a> {
    pub fn new<A, B>(pair: &Pair<'_, B, A>, pose: &'a RelativePose) -> Self {
        Self {
            pose,
            border_radii: pair.border_radii,
            order: pair.order,
        }
    }

    /// Converts the normal and the points of the cores, which are in the frame of the hull.
    pub fn near(&self, normal: DVec3, [on_1, on_2]: [DVec3; 2], distance: f64) -> CallerProximity {
        debug_assert!(is_unit(normal), "no unit vector: {normal}");
        let normals = [normal, -self.pose.direction_to_2(normal)];
        let points = [on_1, self.pose.point_to_2(on_2)];
        let points = [0, 1].map(|i| points[i] + normals[i] * self.border_radii[i]);
        CallerProximity {
            signed_distance: distance - self.border_radii[0] - self.border_radii[1],
            normals: self.order.to_caller(normals),
            points: self.order.to_caller(points),
        }
    }
}

/// A sink that keeps the nearest points, without memory of the pair.
pub(crate) struct NearestPoints<'a> {
    frame: KernelFrame<'a>,
    pub nearest: Option<CallerProximity>,
}

impl<'a> NearestPoints<'a> {
    pub fn new<A, B>(pair: &Pair<'_, B, A>, pose: &'a RelativePose) -> Self {
        Self {
            frame: KernelFrame::new(pair, pose),
            nearest: None,
        }
    }
}

impl Sink for NearestPoints<'_> {
    fn spheres_apart(&mut self) {}

    fn separated(&mut self, _: &SeparatingAxis) {}

    fn near(&mut self, near: &Proximity) {
        self.nearest = Some(CallerProximity::of_proximity(near, &self.frame));
    }
}
