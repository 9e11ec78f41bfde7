//! Casts of shapes with parts that turn. Parry's search passes over parts that are met: it skips the box of a part if a
//! bisection between two balls finds no impact, or a late one, and a bisection may step over an impact.

use parry3d::bounding_volume::Aabb;
use parry3d::math::{Real, Vector};
use parry3d::partitioning::BvhNode;
use parry3d::query::{NonlinearRigidMotion, QueryDispatcher, ShapeCastHit};
use parry3d::shape::{Ball, CompositeShape, Shape};

use crate::tuning::LOOSE_BALL;

/// A cast of a shape with parts and another shape, between two times.
pub(super) struct PartsCast<'a, D> {
    pub us: &'a D,
    pub motion: &'a NonlinearRigidMotion,
    pub other_motion: &'a NonlinearRigidMotion,
    pub other: &'a dyn Shape,
    pub times: [Real; 2],
    pub stop_at_penetration: bool,
}

impl<D: QueryDispatcher> PartsCast<'_, D> {
    /// The first impact of a part. The shape with parts is the first of the hit.
    pub fn run(&self, whole: &(impl CompositeShape + ?Sized)) -> Option<ShapeCastHit> {
        let (ball, ball_motion) = self.other_ball();
        let earliest = |node: &BvhNode, _: Real| self.earliest(&node.aabb(), (&ball, &ball_motion));
        let impact = |part: u32, _: Real| {
            let mut found = None;
            whole.map_part_at(part, &mut |pose, shape, _| {
                let motion = pose.map_or(*self.motion, |pose| self.motion.prepend(*pose));
                let hit = self.cast((&motion, shape), (self.other_motion, self.other));
                found = hit.map(|hit| pose.map_or(hit, |pose| hit.transform1_by(pose)));
            });
            found
        };
        // The search only takes what is earlier than its limit.
        let limit = self.times[1].next_up();
        let (part, hit) = whole.bvh().find_best(limit, earliest, impact)?;
        Some(ShapeCastHit {
            subshape1: part,
            ..hit
        })
    }

    /// A ball around the other shape, and its motion.
    pub fn other_ball(&self) -> (Ball, NonlinearRigidMotion) {
        let sphere = self.other.compute_local_bounding_sphere();
        let ball = loose_ball(sphere.radius, sphere.center);
        (ball, self.other_motion.prepend_translation(sphere.center))
    }

    /// No part in a box is met earlier. The other shape is in a ball.
    pub fn earliest(&self, aabb: &Aabb, other: (&Ball, &NonlinearRigidMotion)) -> Real {
        let [start, end] = self.times;
        let ball = loose_ball(aabb.half_extents().length(), aabb.center());
        if !ball.radius.is_finite() {
            return start;
        }
        let motion = &self.motion.prepend_translation(aabb.center());
        let (other, other_motion) = other;
        let met =
            (self.us).cast_shapes_nonlinear(motion, &ball, other_motion, other, start, end, true);
        match met {
            Ok(Some(hit)) => hit.time_of_impact,
            Ok(None) => Real::MAX,
            Err(_) => start,
        }
    }

    pub fn cast(
        &self,
        (motion_1, shape_1): (&NonlinearRigidMotion, &dyn Shape),
        (motion_2, shape_2): (&NonlinearRigidMotion, &dyn Shape),
    ) -> Option<ShapeCastHit> {
        let ([start, end], stop) = (self.times, self.stop_at_penetration);
        let hit =
            (self.us).cast_shapes_nonlinear(motion_1, shape_1, motion_2, shape_2, start, end, stop);
        hit.ok().flatten()
    }
}

/// A ball that contains one around this center, although its motion is rounded.
fn loose_ball(radius: Real, center: Vector) -> Ball {
    Ball::new(radius + LOOSE_BALL * (radius + center.length()))
}

/// A hit as the other shape's.
pub(super) fn of_other(hit: ShapeCastHit) -> ShapeCastHit {
    ShapeCastHit {
        witness1: hit.witness2,
        witness2: hit.witness1,
        normal1: hit.normal2,
        normal2: hit.normal1,
        subshape1: hit.subshape2,
        subshape2: hit.subshape1,
        ..hit
    }
}
