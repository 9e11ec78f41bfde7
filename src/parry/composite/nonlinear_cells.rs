//! Casts of height fields and voxels, and shapes that turn.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Vector;
use parry3d::query::{NonlinearRigidMotion, QueryDispatcher, ShapeCastHit};
use parry3d::shape::Ball;

use super::cells::Cells;
use super::nonlinear::PartsCast;
use crate::tuning::{CELLS_IN_BOX, LOOSE_BALL, MOST_STRETCHES};

impl<D: QueryDispatcher> PartsCast<'_, D> {
    /// The first impact of a cell.
    pub fn run_cells(&self, cells: Cells<'_>) -> Option<ShapeCastHit> {
        let (ball, ball_motion) = self.other_ball();
        let other = (&ball, &ball_motion);
        let all = cells.aabb();
        let near = self
            .way(other)
            .map_or(Some(all), |way| all.intersection(&way))?;
        let mut first = None;
        self.search(cells, &near, other, &mut first);
        first
    }

    /// A box in the frame of the cells that the other ball does not leave. `None` if the cells turn, or if it has no end.
    fn way(&self, (ball, motion): (&Ball, &NonlinearRigidMotion)) -> Option<Aabb> {
        if self.motion.angvel != Vector::ZERO {
            return None;
        }
        // It turns about this point.
        let center = if motion.angvel == Vector::ZERO {
            Vector::ZERO
        } else {
            motion.local_center
        };
        let (start, from) = (self.motion.start, motion.start * center);
        let velocity = motion.linvel - self.motion.linvel;
        let ends = self.times.map(|time| from + velocity * time);
        let extent = start.translation.length() + ends[0].length() + ends[1].length();
        let radius = ball.radius + center.length() + LOOSE_BALL * extent;
        let way = ends.map(|end| start.inverse_transform_point(end));
        radius
            .is_finite()
            .then(|| Aabb::from_points(way).loosened(radius))
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
            let end = first.map_or(self.times[1], |hit| hit.time_of_impact);
            let cast = Self {
                times: [self.times[0], end],
                ..*self
            };
            let hit = cast.cast((&motion, cell.shape), (self.other_motion, self.other));
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
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use parry3d::math::{IVector, Pose};
    use parry3d::shape::{Cylinder, Voxels};
    use testkit::silent::Silent;

    use super::*;

    /// A body of 12 cm that falls fast, and turns, over a floor of 3,600 voxels of 10 cm. A search through the
    /// whole floor would look at some cells many times.
    #[test]
    fn only_cells_near_the_way_are_looked_at() {
        let cells = (0..60).flat_map(|x| (0..60).map(move |z| IVector::new(x, 0, z)));
        let floor = Voxels::new(Vector::splat(0.1), &cells.collect::<Vec<_>>());
        let still = NonlinearRigidMotion::constant_position(Pose::translation(-3.0, 0.0, -3.0));
        let (velocity, turning) = (Vector::new(1.0, -3.0, 0.5), Vector::new(3.0, 1.0, 2.0));
        let above = Pose::translation(0.02, 0.2, 0.03);
        let falling = NonlinearRigidMotion::new(above, Vector::ZERO, velocity, turning);
        let us = Silent::default();
        let cast = PartsCast {
            us: &us,
            motion: &still,
            other_motion: &falling,
            other: &Cylinder::new(0.06, 0.04),
            times: [0.0, 1.0 / 60.0],
            stop_at_penetration: false,
        };
        assert!(cast.run_cells(Cells::Voxels(&floor)).is_none());
        let casts = us.0.load(Ordering::Relaxed);
        println!("{casts} casts");
        assert!((1..100).contains(&casts), "{casts} casts");
    }
}
