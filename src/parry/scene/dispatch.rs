//! Scene queries: we answer the convex pairs that our kernels know, shapes with parts are taken apart, and the
//! fallback gets the rest.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{
    ClosestPoints, Contact, NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher,
    ShapeCastHit, ShapeDistance, ShapeIntersection, Unsupported,
};
use parry3d::shape::{Shape, ShapeType};

use crate::parry::composite::scene::{self as parts, MovingShape};
use crate::parry::dispatcher::IsaGjkDispatcher;
use crate::parry::scene::{cast, contact, nonlinear, separation as scene};

impl<F: PersistentQueryDispatcher> QueryDispatcher for IsaGjkDispatcher<F> {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        self.unless_left([g1, g2], || scene::intersect(pos12, g1, g2))
            .map(ShapeIntersection::from)
            .or_else(|_| parts::intersection_test(self, pos12, g1, g2))
            .or_else(|_| self.fallback.intersection_test(pos12, g1, g2))
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        self.unless_left([g1, g2], || scene::distance(pos12, g1, g2))
            .map(ShapeDistance::from)
            .or_else(|_| parts::distance(self, pos12, g1, g2))
            .or_else(|_| self.fallback.distance(pos12, g1, g2))
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        self.unless_left([g1, g2], || contact::contact(pos12, g1, g2, prediction))
            .or_else(|_| parts::contact(self, pos12, g1, g2, prediction))
            .or_else(|_| match g2.shape_type() {
                // Parry takes the pose for that of the half-space.
                ShapeType::HalfSpace => self
                    .fallback
                    .contact(&pos12.inverse(), g2, g1, prediction)
                    .map(|contact| contact.map(Contact::flipped)),
                _ => self.fallback.contact(pos12, g1, g2, prediction),
            })
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        self.unless_left([g1, g2], || scene::closest_points(pos12, g1, g2, max_dist))
            .or_else(|_| parts::closest_points(self, pos12, g1, g2, max_dist))
            // Parry asserts that it is not negative.
            .or_else(|_| (self.fallback).closest_points(pos12, g1, g2, max_dist.max(0.0)))
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        self.unless_left([g1, g2], || {
            cast::cast_shapes(pos12, local_vel12, g1, g2, options)
        })
        .or_else(|_| parts::cast_shapes(self, pos12, local_vel12, g1, g2, options))
        .or_else(|_| {
            self.fallback
                .cast_shapes(pos12, local_vel12, g1, g2, options)
        })
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let movers =
            [(motion1, g1), (motion2, g2)].map(|(motion, shape)| MovingShape { motion, shape });
        let times = [start_time, end_time];
        self.unless_left([g1, g2], || {
            nonlinear::cast_shapes(movers, times, stop_at_penetration)
        })
        .or_else(|_| parts::cast_shapes_nonlinear(self, movers, times, stop_at_penetration))
    }
}
