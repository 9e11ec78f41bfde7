//! Bodies at rest side by side, as logs are: a point of each line in contact proves the answer.

use glam::DVec3;

use super::at_rest::AtRest;
use super::circle::along_ruling;
use super::query::CurvedQuery;
use super::surface_pieces::{Ruling, SurfacePieces};
use crate::query::LastContacts;
use crate::support::{Cso, CsoVertex, VertexId};
use crate::tuning::{FLUSH_TIE, SMALL_TURN};

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// What a line of the second shape and a line or the extreme point of the first one prove, along the normal that
    /// suits the ruled side of the second one.
    pub(super) fn on_ruled_side(
        &mut self,
        last: &LastContacts,
        [about, outward]: [DVec3; 2],
    ) -> Option<AtRest> {
        let (cso, tolerance) = (self.cso, self.tolerance());
        let Cso {
            shape_1,
            shape_2,
            pose,
        } = cso;
        let mut rulings = shape_2.rulings(outward, VertexId::default());
        let ruling =
            rulings.find(|side| (side.axis.dot(outward) - side.sine).abs() < SMALL_TURN)?;
        let ruling = Ruling {
            axis: pose.direction_to_1(ruling.axis),
            sine: -ruling.sine,
        };
        let start = CsoVertex {
            ids: cso.start_vertices(about),
            ..CsoVertex::default()
        };
        let found = along_ruling(cso, &ruling, (about, &start), self.cost)?;
        let normal = found.normal;
        let middle = last.middle_of_deepest(normal, FLUSH_TIE * tolerance);
        let side = shape_1.point_on_side(normal, middle, self.cost);
        let on_1 = side.unwrap_or(found.extreme.on_1);
        let outward = -pose.direction_to_2(normal);
        let on_2 = shape_2.point_on_side(outward, pose.point_to_2(on_1), self.cost)?;
        let at_2 = pose.point_to_1(on_2);
        let most = found.distance + tolerance;
        let is_proved = if found.distance > 0.0 {
            on_1.distance(at_2) <= most
        } else {
            // A ball in the difference that touches its surface there.
            let [ball_1, ball_2] = [shape_1.ball_at(on_1), shape_2.ball_at(on_2)];
            let center = ball_1.0 - pose.point_to_1(ball_2.0);
            ball_1.1 + ball_2.1 - center.length() >= -most
        };
        is_proved.then_some(AtRest {
            signed_distance: found.distance,
            normal,
            on_1,
        })
    }
}
