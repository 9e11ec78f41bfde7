//! Rigid motions of two convex shapes, and how long they keep the shapes apart.
//!
//! A point `r` from the centre it turns about has an acceleration of at most `ω² |r|`. So the separation along
//! a fixed normal differs after a time `t` from that of points that keep their velocities by at most `½ b t²`,
//! where `b` is the sum of `ω² ρ` over both shapes, and ρ the largest `|r|`. The separation of points that keep
//! their velocities is a concave function of `t`: the least of linear ones, one for each pair of points. Where
//! it exceeds `½ b t²` it does so at all times before.

use glam::{DQuat, DVec3};
use parry3d::query::NonlinearRigidMotion;

use crate::parry::pair::Pair;
use crate::pose::{RelativePose, ValidPose};
use crate::stats::Cost;
use crate::support::Support;
use crate::tuning::USED_UP;

/// Steps towards the end of the time that a normal proves. More prove little more.
const REFINEMENTS: usize = 4;
/// A centre on a straight line, and a shape that turns about it. In the world's frame, but for `local_center`.
#[derive(Clone, Copy)]
pub(super) struct Motion {
    local_center: DVec3,
    center: DVec3,
    rotation: DQuat,
    linear: DVec3,
    angular: DVec3,
}

impl Motion {
    /// `None` if it is not finite.
    pub fn new(motion: &NonlinearRigidMotion) -> Option<Self> {
        ValidPose::new(&motion.start)?;
        let [local_center, linear, angular] =
            [motion.local_center, motion.linvel, motion.angvel].map(|v| v.as_dvec3());
        let rotation = motion.start.rotation.as_dquat().normalize();
        let is_finite = local_center.is_finite() && linear.is_finite() && angular.is_finite();
        is_finite.then(|| Self {
            local_center,
            center: rotation * local_center + motion.start.translation.as_dvec3(),
            rotation,
            linear,
            angular,
        })
    }

    fn rotation_at(&self, time: f64) -> DQuat {
        DQuat::from_scaled_axis(self.angular * time) * self.rotation
    }

    /// From its centre no point of the shape is farther.
    fn reach(&self, shape: &impl Support) -> f64 {
        shape.center().distance(self.local_center) + shape.radius()
    }
}

/// Two shapes on their way.
pub(super) struct Course<'a, A, B> {
    pair: &'a Pair<'a, B, A>,
    motions: [Motion; 2],
    /// Of the cores.
    reaches: [f64; 2],
}

/// A moment of their motion, and a unit normal from shape 1 to shape 2 in the world's frame.
pub(super) struct Moment {
    rotations: [DQuat; 2],
    between: DVec3,
    normal: DVec3,
}

impl<'a, A: Support, B: Support> Course<'a, A, B> {
    pub fn new(pair: &'a Pair<'a, B, A>, motions: [Motion; 2]) -> Self {
        let reaches = [motions[0].reach(pair.hull), motions[1].reach(pair.other)];
        Self {
            pair,
            motions,
            reaches,
        }
    }

    /// Of shape 2 in the frame of shape 1.
    pub fn pose_at(&self, time: f64) -> RelativePose {
        let [first, second] = self.motions.map(|motion| motion.rotation_at(time));
        let to_first = first.inverse();
        let local_centers = self.motions.map(|motion| motion.local_center);
        let between = self.between(time) - second * local_centers[1];
        RelativePose::from_parts(to_first * second, to_first * between + local_centers[0])
    }

    /// From centre to centre.
    fn between(&self, time: f64) -> DVec3 {
        let [first, second] = &self.motions;
        second.center - first.center + self.relative_velocity() * time
    }

    fn relative_velocity(&self) -> DVec3 {
        self.motions[1].linear - self.motions[0].linear
    }

    /// When spheres around both centres, in which the shapes turn, overlap. `None` if they never do.
    pub fn within_reach(&self) -> Option<[f64; 2]> {
        let radii: f64 = self.reaches.iter().chain(&self.pair.border_radii).sum();
        let (between, velocity) = (self.between(0.0), self.relative_velocity());
        let outside = between.length_squared() - radii * radii;
        let (a, b) = (velocity.length_squared(), velocity.dot(between));
        if a == 0.0 {
            return (outside <= 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let root = (b * b - a * outside).sqrt();
        // NaN where they pass by.
        (root >= 0.0).then(|| [(-b - root) / a, (-b + root) / a])
    }

    /// `normal` is in the frame of shape 1.
    pub fn moment(&self, time: f64, normal: DVec3) -> Moment {
        let rotations = self.motions.map(|motion| motion.rotation_at(time));
        Moment {
            between: self.between(time),
            normal: rotations[0] * normal,
            rotations,
        }
    }

    /// The separation along the normal.
    pub fn separation(&self, at: &Moment) -> f64 {
        self.separation_after(at, 0.0, [false; 2])
    }

    /// The separation along the normal after the time `ahead`, if until then all points kept their
    /// velocities; shapes that are `spun` may take any place within their reach.
    fn separation_after(&self, at: &Moment, ahead: f64, spun: [bool; 2]) -> f64 {
        let normal = at.normal;
        let centers = normal.dot(at.between + self.relative_velocity() * ahead);
        // What a point gains along the normal by turning it gains along this direction by its place.
        let local = |i: usize| {
            let direction = normal + normal.cross(self.motions[i].angular) * ahead;
            at.rotations[i].inverse() * direction
        };
        let beyond_center = |i: usize, shape: &dyn Support, toward: DVec3| {
            if spun[i] {
                self.reaches[i]
            } else {
                extent(shape, toward) - toward.dot(self.motions[i].local_center)
            }
        };
        let reaches = [
            beyond_center(0, self.pair.hull, local(0)),
            beyond_center(1, self.pair.other, -local(1)),
        ];
        centers - reaches.iter().chain(&self.pair.border_radii).sum::<f64>()
    }

    /// How long the shapes are proved to stay apart from a moment on at which a normal separates them by
    /// more than `touching`: that long or longer, or for all of the time `remaining`, for which there is no
    /// answer.
    pub fn free_time(&self, at: &Moment, remaining: f64, touching: f64) -> Option<f64> {
        let turned = self.free_time_of(at, [false; 2], remaining, touching)?;
        // Far away it does not matter how fast they turn.
        let turns = self.motions.map(|motion| motion.angular != DVec3::ZERO);
        if self.separation_after(at, 0.0, turns) <= touching {
            return Some(turned);
        }
        let spun = self.free_time_of(at, turns, remaining, touching)?;
        Some(turned.max(spun))
    }

    fn free_time_of(
        &self,
        at: &Moment,
        spun: [bool; 2],
        remaining: f64,
        touching: f64,
    ) -> Option<f64> {
        let turning = |i: usize| {
            let motion = &self.motions[i];
            let tilt = at.normal.cross(motion.angular).length();
            let bend = motion.angular.length_squared();
            [tilt, bend].map(|rate| if spun[i] { 0.0 } else { rate * self.reaches[i] })
        };
        let ([tilt_1, bend_1], [tilt_2, bend_2]) = (turning(0), turning(1));
        // No two points approach each other faster.
        let approach = tilt_1 + tilt_2 - at.normal.dot(self.relative_velocity());
        let half_bend = 0.5 * (bend_1 + bend_2);
        // What is left where the search is to go on with a new normal: they do not touch there.
        let rest = 0.5 * touching;
        let certified =
            |ahead: f64| self.separation_after(at, ahead, spun) - half_bend * ahead * ahead - rest;
        let gap = certified(0.0);
        if gap - approach.max(0.0) * remaining > rest {
            return None;
        }
        // So far the speed alone proves it.
        let proved = (gap / approach).min(remaining);
        last_positive(certified, proved, remaining, [USED_UP * gap, rest])
    }
}

/// A time before the zero of a concave function that is not negative at `low`. The search ends where less
/// than `used_up` is left. `None` if more than `rest` is left after the time `remaining`.
fn last_positive(
    function: impl Fn(f64) -> f64,
    mut low: f64,
    remaining: f64,
    [used_up, rest]: [f64; 2],
) -> Option<f64> {
    let mut low_value = function(low);
    let (mut high, mut high_value) = (low, low_value);
    while high_value >= 0.0 {
        if high >= remaining {
            return (high_value <= rest).then_some(remaining);
        }
        (low, low_value) = (high, high_value);
        high = (2.0 * high).min(remaining);
        high_value = function(high);
    }
    for _ in 0..REFINEMENTS {
        if low_value <= used_up {
            break;
        }
        // The chord of a concave function lies beneath it.
        let next = low + (high - low) * low_value / (low_value - high_value);
        let value = function(next);
        if value < 0.0 {
            break;
        }
        (low, low_value) = (next, value);
    }
    Some(low)
}

/// The largest `dir · p` over a shape.
fn extent(shape: &dyn Support, dir: DVec3) -> f64 {
    let (extreme, _) = shape.support(dir, shape.start_vertex(dir), &mut Cost::default());
    dir.dot(extreme)
}
