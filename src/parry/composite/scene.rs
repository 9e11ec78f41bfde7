//! Scene queries against shapes with parts: parry's routines choose the parts, and call *our* dispatcher for
//! them. Cells of height fields and voxels, and parts of shapes that turn, are chosen by us. If no routine
//! knows the pair, it is [`Unsupported`]. Negative distances become zero, since parry's routines assert that
//! they are not negative.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::{
    NonlinearShapeCastMode, cast_shapes_composite_shape_shape,
    cast_shapes_nonlinear_support_map_support_map, cast_shapes_shape_composite_shape,
    closest_points_composite_shape_shape, closest_points_shape_composite_shape,
    contact_composite_shape_shape, contact_shape_composite_shape, distance_composite_shape_shape,
    distance_shape_composite_shape, intersection_test_composite_shape_shape,
    intersection_test_shape_composite_shape,
};
use parry3d::query::{
    ClosestPoints, Contact, NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher,
    ShapeCastHit, ShapeCastOptions, ShapeDistance, ShapeIntersection, Unsupported,
};
use parry3d::shape::{Shape, ShapeType};

use super::cell_queries::CellsPair;
use super::cells::Cells;
use super::nonlinear::{PartsCast, of_other};

pub(crate) fn intersection_test(
    us: &impl PersistentQueryDispatcher,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
) -> Result<ShapeIntersection, Unsupported> {
    if let Some(pair) = CellsPair::of(us, pos12, [g1, g2]) {
        return Ok(pair.intersection_test());
    }
    if let Some(pair) = CellsPair::of(us, &pos12.inverse(), [g2, g1]) {
        let hit = pair.intersection_test();
        return Ok(hit.with_subshapes(hit.subshape2, hit.subshape1));
    }
    // parry projects the centre of a ball onto the whole shape.
    if [g1, g2].iter().any(|g| g.shape_type() == ShapeType::Ball) {
        return Err(Unsupported);
    }
    if let Some(c1) = g1.as_composite_shape() {
        Ok(intersection_test_composite_shape_shape(us, pos12, c1, g2))
    } else {
        let c2 = g2.as_composite_shape().ok_or(Unsupported)?;
        Ok(intersection_test_shape_composite_shape(us, pos12, g1, c2))
    }
}

pub(crate) fn distance(
    us: &impl QueryDispatcher,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
) -> Result<ShapeDistance, Unsupported> {
    if let Some(pair) = CellsPair::of(us, pos12, [g1, g2]) {
        Ok(pair.distance())
    } else if let Some(pair) = CellsPair::of(us, &pos12.inverse(), [g2, g1]) {
        let found = pair.distance();
        Ok(found.with_subshapes(found.subshape2, found.subshape1))
    } else if let Some(c1) = g1.as_composite_shape() {
        Ok(distance_composite_shape_shape(us, pos12, c1, g2))
    } else {
        let c2 = g2.as_composite_shape().ok_or(Unsupported)?;
        Ok(distance_shape_composite_shape(us, pos12, g1, c2))
    }
}

pub(crate) fn contact(
    us: &impl QueryDispatcher,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    prediction: Real,
) -> Result<Option<Contact>, Unsupported> {
    let prediction = prediction.max(0.0);
    Ok(if let Some(pair) = CellsPair::of(us, pos12, [g1, g2]) {
        pair.contact(prediction)
    } else if let Some(pair) = CellsPair::of(us, &pos12.inverse(), [g2, g1]) {
        pair.contact(prediction).map(Contact::flipped)
    } else if let Some(c1) = g1.as_composite_shape() {
        contact_composite_shape_shape(us, pos12, c1, g2, prediction)
    } else {
        let c2 = g2.as_composite_shape().ok_or(Unsupported)?;
        contact_shape_composite_shape(us, pos12, g1, c2, prediction)
    })
}

pub(crate) fn closest_points(
    us: &impl QueryDispatcher,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    max_dist: Real,
) -> Result<ClosestPoints, Unsupported> {
    // parry looks at parts whose boxes are nearer than this: at zero, at none.
    let max_dist = max_dist.max(Real::MIN_POSITIVE);
    Ok(if let Some(pair) = CellsPair::of(us, pos12, [g1, g2]) {
        pair.closest_points(max_dist)
    } else if let Some(pair) = CellsPair::of(us, &pos12.inverse(), [g2, g1]) {
        pair.closest_points(max_dist).flipped()
    } else if let Some(c1) = g1.as_composite_shape() {
        closest_points_composite_shape_shape(us, pos12, c1, g2, max_dist)
    } else {
        let c2 = g2.as_composite_shape().ok_or(Unsupported)?;
        closest_points_shape_composite_shape(us, pos12, g1, c2, max_dist)
    })
}

pub(crate) fn cast_shapes(
    us: &impl QueryDispatcher,
    pos12: &Pose,
    velocity: Vector,
    g1: &dyn Shape,
    g2: &dyn Shape,
    mut options: ShapeCastOptions,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    options.target_distance = options.target_distance.max(0.0);
    let pos21 = pos12.inverse();
    Ok(if let Some(pair) = CellsPair::of(us, pos12, [g1, g2]) {
        pair.cast(velocity, options)
    } else if let Some(pair) = CellsPair::of(us, &pos21, [g2, g1]) {
        let hit = pair.cast(-(pos21.rotation * velocity), options);
        hit.map(of_other)
    } else if let Some(c1) = g1.as_composite_shape() {
        cast_shapes_composite_shape_shape(us, pos12, velocity, c1, g2, options)
    } else {
        let c2 = g2.as_composite_shape().ok_or(Unsupported)?;
        cast_shapes_shape_composite_shape(us, pos12, velocity, g1, c2, options)
    })
}

/// A moving shape, with rotation.
#[derive(Clone, Copy)]
pub(crate) struct MovingShape<'a> {
    pub motion: &'a NonlinearRigidMotion,
    pub shape: &'a dyn Shape,
}

/// This includes two convex shapes: parry's search for the time of impact calls our distance query at each
/// step.
pub(crate) fn cast_shapes_nonlinear(
    us: &impl QueryDispatcher,
    movers: [MovingShape<'_>; 2],
    [start, end]: [Real; 2],
    stop_at_penetration: bool,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let stop = stop_at_penetration;
    let [m1, m2] = movers.map(|mover| mover.motion);
    let [g1, g2] = movers.map(|mover| mover.shape);
    let parts_cast = |[motion, other_motion]: [_; 2], other| PartsCast {
        us,
        motion,
        other_motion,
        other,
        times: [start, end],
        stop_at_penetration,
    };
    Ok(
        if let (Some(s1), Some(s2)) = (g1.as_support_map(), g2.as_support_map()) {
            let mode = if stop {
                NonlinearShapeCastMode::StopAtPenetration
            } else {
                NonlinearShapeCastMode::directional_toi(g1, g2)
            };
            cast_shapes_nonlinear_support_map_support_map(
                us, m1, s1, g1, m2, s2, g2, start, end, mode,
            )
        } else if let Some(c1) = g1.as_composite_shape() {
            parts_cast([m1, m2], g2).run(c1)
        } else if let Some(c2) = g2.as_composite_shape() {
            parts_cast([m2, m1], g1).run(c2).map(of_other)
        } else if let Some(c1) = Cells::of(g1) {
            parts_cast([m1, m2], g2).run_cells(c1)
        } else {
            let c2 = Cells::of(g2).ok_or(Unsupported)?;
            parts_cast([m2, m1], g1).run_cells(c2).map(of_other)
        },
    )
}
