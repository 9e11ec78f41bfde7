//! The whole region of contact.

use glam::DVec3;
use parry3d::math::{Pose, Real};
use parry3d::query::Unsupported;
use parry3d::shape::Shape;

use super::why::why_not;
use crate::manifold::{self, PatchCorner};
use crate::parry::convert::HalfSpace;
use crate::parry::half_space;
use crate::parry::pair::{Pair, PairVisitor, valid_pose};
use crate::parry::scene::caller::{CallerProximity, KernelFrame};
use crate::parry::visit;
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::{
    Answer, ContactId, ContactPatch, Feature, PairMemory, PatchVertex, Proximity, Query, QueryError,
};
use crate::stats::Cost;
use crate::support::{Polytope, Support};

impl ContactPatch {
    /// The patch of a hull and a hull, cuboid, triangle, ball, capsule, segment or half-space, rounded or
    /// not, in either order, if they touch, overlap, or are at most `prediction` apart; otherwise `None`.
    /// `pos12` is the pose of shape 2 in the frame of shape 1.
    ///
    /// The deepest point is exact to 1e-5 of the size, and if faces meet, so are the others. If corners or
    /// edges meet, the polygon is that of their faces that face each other most, as far as these are within
    /// `prediction`.
    ///
    /// # Errors
    ///
    /// [`QueryError`] reports unsupported shapes, and poses that are not finite.
    ///
    /// ```
    /// use isa_gjk::query::ContactPatch;
    /// use rapier3d::prelude::*;
    ///
    /// // A prism of eight sides stands on a table, with a part of it beyond the edge.
    /// let corners: Vec<Vector> = (0..16)
    ///     .map(|i| {
    ///         let (sin, cos) = (std::f32::consts::TAU * (i / 2) as f32 / 8.0).sin_cos();
    ///         Vector::new(cos, if i % 2 == 0 { 0.0 } else { 0.5 }, sin)
    ///     })
    ///     .collect();
    /// let prism = SharedShape::convex_hull(&corners).expect("a solid");
    /// let table = SharedShape::cuboid(2.0, 0.4, 2.0);
    ///
    /// let pose = Pose::translation(1.9, 0.399, 0.0); // of the prism, in the frame of the table
    /// let patch = ContactPatch::between(&*table, &*prism, &pose, 0.01)?.expect("they overlap");
    /// assert_eq!(patch.vertices.len(), 7);
    /// assert!((patch.area - 1.61007).abs() < 1e-5); // the octagon has 2.83
    /// assert!(patch.center.x < 1.6); // the rest is in the air
    /// assert!(patch.vertices.iter().all(|vertex| (vertex.distance + 1e-3).abs() < 1e-6));
    /// # Ok::<(), isa_gjk::query::QueryError>(())
    /// ```
    pub fn between(
        shape_1: &dyn Shape,
        shape_2: &dyn Shape,
        pos12: &Pose,
        prediction: Real,
    ) -> Result<Option<Self>, QueryError> {
        if prediction.is_nan() {
            return Err(QueryError::NotFinite);
        }
        let found = visit::shapes(shape_1, shape_2, PatchQuery { pos12, prediction });
        found.map_err(|_| why_not(pos12, [shape_1, shape_2]))
    }
}

struct PatchQuery<'a> {
    pos12: &'a Pose,
    prediction: Real,
}

impl PairVisitor for PatchQuery<'_> {
    type Answer = Option<ContactPatch>;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        let max_distance = pair.core_distance(self.prediction, cso.size());
        let cost = &mut Cost::default();
        let (answer, _) = Query::new(&cso, max_distance, &mut workspace.epa, cost)
            .run(&PairMemory::None)
            .ok_or(Unsupported)?;
        let Answer::Near(near) = answer else {
            return Ok(None);
        };
        let corners = manifold::contact_polygon(&cso, &near, max_distance, &mut workspace.clip);
        Ok(Some(to_caller(pair, &pose, &near, &corners)))
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        _: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let max_distance = pair.core_distance(self.prediction, pair.hull.radius());
        let near = half_space::deepest(pair, &pose, max_distance);
        Ok(near.map(|near| {
            let corners = manifold::half_space_polygon(pair.hull, &near, max_distance);
            to_caller(pair, &pose, &near, &corners)
        }))
    }
}

/// The patch as the caller sees it.
fn to_caller<B>(
    pair: &Pair<'_, B>,
    pose: &RelativePose,
    near: &Proximity,
    corners: &[PatchCorner],
) -> ContactPatch {
    let frame = KernelFrame::new(pair, pose);
    let place = |on_1: DVec3, distance: f64| {
        let on_2 = on_1 + near.normal * distance;
        frame.near(near.normal, [on_1, on_2], distance)
    };
    let vertex = |place: &CallerProximity, features: [Feature; 2]| {
        let features = pair.order.to_caller(features);
        PatchVertex {
            on_1: place.points[0],
            distance: place.signed_distance,
            features,
            id: ContactId::new(features),
        }
    };
    let mut vertices: Vec<PatchVertex> = corners
        .iter()
        .map(|corner| vertex(&place(corner.on_1, corner.distance), corner.features))
        .collect();
    if pair.order.is_reversed() {
        vertices.reverse();
    }
    let deepest = place(near.on_1, near.signed_distance);
    ContactPatch::new(
        deepest.normals[0],
        vertex(&deepest, near.features),
        vertices,
    )
}
