//! The contact of a ball with a cylinder or a cone, in closed form. parry takes a ball in the middle of a flat cylinder
//! out through the side, and if the centre is on the surface, its normal points anywhere.

use glam::DVec3;
use parry3d::math::{Pose, Real};
use parry3d::query::{Contact, TrackedContact, Unsupported};
use parry3d::shape::{PackedFeatureId, Shape, ShapeType};

use crate::map_pair::map_pair;
use crate::parry::constraints::Constraints;
use crate::parry::convert::Core;
use crate::parry::manifold::UpdateManifold;
use crate::parry::order::PairOrder;
use crate::parry::pair::valid_pose;
use crate::primitive::Revolved;
use crate::stats::Stage;

/// In the caller's order.
struct BallContact {
    /// Each in the frame of its shape.
    points: [DVec3; 2],
    /// Unit vectors out of the shapes, each in the frame of its shape.
    normals: [DVec3; 2],
    distance: f64,
}

impl BallContact {
    /// Of a ball and a solid with a border, which come in this order in the kernels.
    fn new(
        pos12: &Pose,
        order: PairOrder,
        solid: &impl Revolved,
        [radius, border]: [f64; 2],
    ) -> Result<Self, Unsupported> {
        let pose = order.pose(valid_pose(pos12)?);
        let nearest = solid.nearest_on_surface(pose.point_to_2(DVec3::ZERO));
        let towards_solid = pose.direction_to_1(-nearest.normal);
        let on_ball = towards_solid * radius;
        let on_solid = nearest.at + nearest.normal * border;
        Ok(Self {
            points: order.to_caller([on_ball, on_solid]),
            normals: order.to_caller([towards_solid, nearest.normal]),
            distance: nearest.distance - radius - border,
        })
    }
}

/// Updates the manifold of a ball and a solid with a border, which come in this order in the kernels.
pub(crate) fn update_ball(
    solid: &impl Revolved,
    radii: [f64; 2],
    order: PairOrder,
    update: &mut UpdateManifold<'_>,
) -> Result<(), Unsupported> {
    if !Constraints::are_none(update.constraints) {
        return Err(Unsupported);
    }
    let contact = BallContact::new(update.pos12, order, solid, radii)?;
    update.stats.record_free(Stage::Feature);
    let manifold = &mut update.manifold;
    if contact.distance > update.prediction.into() {
        manifold.clear();
        return Ok(());
    }
    [*manifold.local_n1, *manifold.local_n2] = map_pair(contact.normals, |n| n.as_vec3());
    let [p1, p2] = map_pair(contact.points, |p| p.as_vec3());
    let id = PackedFeatureId::face(0);
    let tracked = TrackedContact::new(p1, p2, id, id, contact.distance as Real);
    manifold.replace_by_ids([Some(tracked), None, None]);
    Ok(())
}

/// The contact of shapes that overlap or are at most `prediction` apart; other shapes are not supported.
pub(crate) fn contact(
    pos12: &Pose,
    shapes: [&dyn Shape; 2],
    prediction: Real,
) -> Result<Option<Contact>, Unsupported> {
    let is_ball = |shape: &dyn Shape| shape.shape_type() == ShapeType::Ball;
    let order = PairOrder::with_first(shapes.map(is_ball)).ok_or(Unsupported)?;
    let cores = map_pair(order.to_kernel(shapes), Core::of);
    let [Some((_, radius)), Some((solid, border))] = &cores else {
        return Err(Unsupported);
    };
    let radii = [*radius, *border].map(f64::from);
    let contact = match solid {
        Core::Cylinder(solid) => BallContact::new(pos12, order, solid, radii),
        Core::Cone(solid) => BallContact::new(pos12, order, solid, radii),
        _ => Err(Unsupported),
    }?;
    Ok((contact.distance <= prediction.into()).then(|| {
        let [p1, p2] = map_pair(contact.points, |p| p.as_vec3());
        let [n1, n2] = map_pair(contact.normals, |n| n.as_vec3());
        Contact::new(p1, p2, n1, n2, contact.distance as Real)
    }))
}
