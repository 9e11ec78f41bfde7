//! Scene queries of shapes made of cells. parry has no routine for most of them, and its casts miss cells that are
//! within the target distance or beside the middle of the other shape.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    ClosestPoints, Contact, QueryDispatcher, Ray, RayCast, ShapeCastHit, ShapeCastOptions,
    ShapeDistance, ShapeIntersection,
};
use parry3d::shape::{Shape, ShapeType};

use super::cells::{Cell, Cells, loose};
use crate::tuning::{CELLS_AT_ONCE, MOST_STRETCHES};

/// Cells, and another shape at a pose in their frame.
pub(super) struct CellsPair<'a, D> {
    pub us: &'a D,
    pub cells: Cells<'a>,
    pub pos12: Pose,
    pub other: &'a dyn Shape,
}

impl<'a, D: QueryDispatcher> CellsPair<'a, D> {
    /// `None` if the first shape is not made of cells, or if no routine knows the other.
    pub fn of(us: &'a D, pos12: &Pose, [cells, other]: [&'a dyn Shape; 2]) -> Option<Self> {
        let is_known = other.as_support_map().is_some()
            || other.as_composite_shape().is_some()
            || other.shape_type() == ShapeType::HalfSpace
            || Cells::of(other).is_some();
        let cells = Cells::of(cells).filter(|_| is_known)?;
        Some(Self {
            us,
            cells,
            pos12: *pos12,
            other,
        })
    }

    fn aabb(&self) -> Aabb {
        self.other.compute_aabb(&self.pos12)
    }

    pub fn intersection_test(&self) -> ShapeIntersection {
        let mut found = ShapeIntersection::new(false);
        self.cells.each_near(&self.aabb(), |cell| {
            if found.intersecting {
                return;
            }
            let pose = cell.pose_of(&self.pos12);
            if let Ok(hit) = self.us.intersection_test(&pose, cell.shape, self.other)
                && hit.intersecting
            {
                found = hit.with_subshapes(cell.id, hit.subshape2);
            }
        });
        found
    }

    /// As far away as parry says if there are no cells.
    pub fn distance(&self) -> ShapeDistance {
        let measure = |cell: &Cell<'_>| {
            let pose = cell.pose_of(&self.pos12);
            let found = self.us.distance(&pose, cell.shape, self.other).ok()?;
            let named = found.with_subshapes(cell.id, found.subshape2);
            Some((found.distance, named))
        };
        let nearest = self.cells.nearest(&self.aabb(), Real::MAX, measure);
        nearest.unwrap_or(ShapeDistance::new(Real::MAX))
    }

    pub fn closest_points(&self, max_dist: Real) -> ClosestPoints {
        let measure = |cell: &Cell<'_>| {
            let (pose, other) = (cell.pose_of(&self.pos12), self.other);
            let found = self.us.closest_points(&pose, cell.shape, other, max_dist);
            match found.ok()? {
                ClosestPoints::Intersecting => Some((0.0, ClosestPoints::Intersecting)),
                ClosestPoints::WithinMargin(p1, p2) => {
                    let distance = pose.transform_point(p2).distance(p1);
                    let p1 = p1 + cell.place;
                    Some((distance, ClosestPoints::WithinMargin(p1, p2)))
                }
                ClosestPoints::Disjoint => None,
            }
        };
        let nearest = self.cells.nearest(&self.aabb(), max_dist, measure);
        nearest.unwrap_or(ClosestPoints::Disjoint)
    }

    pub fn contact(&self, prediction: Real) -> Option<Contact> {
        let mut deepest: Option<Contact> = None;
        let near = self.aabb().loosened(prediction);
        self.cells.each_near(&near, |cell| {
            let (pose, other) = (cell.pose_of(&self.pos12), self.other);
            let found = self.us.contact(&pose, cell.shape, other, prediction);
            if let Ok(Some(mut contact)) = found
                && deepest.is_none_or(|deepest| contact.dist < deepest.dist)
            {
                contact.point1 += cell.place;
                deepest = Some(contact.with_subshapes(cell.id, contact.subshape2));
            }
        });
        deepest
    }

    /// The other shape moves with this velocity. Cells are looked for stretch by stretch of its way.
    pub fn cast(&self, velocity: Vector, options: ShapeCastOptions) -> Option<ShapeCastHit> {
        let start = self.aabb().loosened(options.target_distance);
        let [enter, leave] = self.times_near(&start, velocity, options.max_time_of_impact)?;
        let length = self.cells.pitch() * CELLS_AT_ONCE + start.half_extents().length();
        let stretches = ((leave - enter) * velocity.length() / length).ceil();
        let stretches = stretches.clamp(1.0, MOST_STRETCHES);
        let mut first: Option<ShapeCastHit> = None;
        for i in 0..stretches as u16 {
            let time = |i: u16| enter + (leave - enter) * (Real::from(i) / stretches);
            let [from, to] = [i, i + 1].map(time);
            let ends = [from, to].map(|time| start.translated(velocity * time));
            self.cells.each_near(&ends[0].merged(&ends[1]), |cell| {
                let least = first.map_or(options.max_time_of_impact, |hit| hit.time_of_impact);
                if is_met(cell, &start, velocity, least)
                    && let Some(hit) = self.cast_at(cell, velocity, options)
                    && first.is_none_or(|first| hit.time_of_impact < first.time_of_impact)
                {
                    first = Some(hit);
                }
            });
            if first.is_some_and(|hit| hit.time_of_impact <= to) {
                break;
            }
        }
        first
    }

    /// When the box around the other shape is near the cells.
    fn times_near(&self, start: &Aabb, velocity: Vector, until: Real) -> Option<[Real; 2]> {
        let ways = ways_to_meet(&self.cells.aabb(), start).loosened(self.cells.pitch());
        let (enter, leave) = ways.clip_ray_parameters(&Ray::new(Vector::ZERO, velocity))?;
        (enter <= until).then_some([enter, leave.min(until)])
    }

    fn cast_at(
        &self,
        cell: &Cell<'_>,
        velocity: Vector,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let (pose, other) = (cell.pose_of(&self.pos12), self.other);
        let hit = self
            .us
            .cast_shapes(&pose, velocity, cell.shape, other, options);
        let hit = hit.ok().flatten()?;
        Some(ShapeCastHit {
            witness1: hit.witness1 + cell.place,
            subshape1: cell.id,
            ..hit
        })
    }
}

/// The translations with which a box meets another.
fn ways_to_meet(aabb: &Aabb, start: &Aabb) -> Aabb {
    Aabb::new(aabb.mins - start.maxs, aabb.maxs - start.mins)
}

/// Whether a moving box may meet a cell by some time.
fn is_met(cell: &Cell<'_>, start: &Aabb, velocity: Vector, until: Real) -> bool {
    let ways = ways_to_meet(&cell.aabb(), start);
    let ray = Ray::new(Vector::ZERO, velocity);
    loose(&ways).cast_local_ray(&ray, until, true).is_some()
}
