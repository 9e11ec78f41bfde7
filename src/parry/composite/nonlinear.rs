//! Casts of shapes with parts that turn. Parry's search passes over parts that are met: it skips the box of a part if a
//! bisection between two balls finds no impact, or a late one, and a bisection may step over an impact.

use parry3d::bounding_volume::Aabb;
use parry3d::math::{Real, Vector};
use parry3d::partitioning::BvhNode;
use parry3d::query::{NonlinearRigidMotion, QueryDispatcher, ShapeCastHit};
use parry3d::shape::{Ball, CompositeShape, Shape};

use super::cells::Cells;
use crate::tuning::{CELLS_IN_BOX, LOOSE_BALL, MOST_STRETCHES};

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

    /// The first impact of a cell.
    pub fn run_cells(&self, cells: Cells<'_>) -> Option<ShapeCastHit> {
        let (ball, ball_motion) = self.other_ball();
        let mut first = None;
        self.search(cells, &cells.aabb(), (&ball, &ball_motion), &mut first);
        first
    }

    /// The first impact of the cells in a box, if it is earlier than the `first` one so far.
    fn search(
        &self,
        cells: Cells<'_>,
        aabb: &Aabb,
        other: (&Ball, &NonlinearRigidMotion),
        first: &mut Option<ShapeCastHit>,
    ) {
        let limit = first.map_or(self.times[1].next_up(), |hit| hit.time_of_impact);
        if self.earliest(aabb, other) >= limit {
            return;
        }
        let [x, y, z] = aabb.extents().to_array();
        let length = x.max(y).max(z);
        // Cells may have no extent.
        let few = (CELLS_IN_BOX * cells.pitch())
            .max(cells.aabb().extents().max_element() / MOST_STRETCHES);
        if length.is_nan() || length <= few {
            self.look_at(cells, aabb, first);
            return;
        }
        let mut halves = [*aabb; 2];
        let middle = aabb.center();
        if length == x {
            (halves[0].maxs.x, halves[1].mins.x) = (middle.x, middle.x);
        } else if length == y {
            (halves[0].maxs.y, halves[1].mins.y) = (middle.y, middle.y);
        } else {
            (halves[0].maxs.z, halves[1].mins.z) = (middle.z, middle.z);
        }
        for half in &halves {
            self.search(cells, half, other, first);
        }
    }

    /// The same, cell by cell.
    fn look_at(&self, cells: Cells<'_>, aabb: &Aabb, first: &mut Option<ShapeCastHit>) {
        cells.each_near(aabb, |cell| {
            let motion = self.motion.prepend_translation(cell.place);
            let hit = self.cast((&motion, cell.shape), (self.other_motion, self.other));
            let is_earlier = |hit: &ShapeCastHit| {
                first.is_none_or(|first| hit.time_of_impact < first.time_of_impact)
            };
            if let Some(hit) = hit.filter(is_earlier) {
                *first = Some(ShapeCastHit {
                    witness1: hit.witness1 + cell.place,
                    subshape1: cell.id,
                    ..hit
                });
            }
        });
    }

    /// A ball around the other shape, and its motion.
    fn other_ball(&self) -> (Ball, NonlinearRigidMotion) {
        let sphere = self.other.compute_local_bounding_sphere();
        let ball = loose_ball(sphere.radius, sphere.center);
        (ball, self.other_motion.prepend_translation(sphere.center))
    }

    /// No part in a box is met earlier. The other shape is in a ball.
    fn earliest(&self, aabb: &Aabb, other: (&Ball, &NonlinearRigidMotion)) -> Real {
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

    fn cast(
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
