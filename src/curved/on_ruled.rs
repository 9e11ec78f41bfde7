//! Bodies at rest side by side, as logs are: a place where two lines are nearest proves the answer.

use glam::DVec3;

use super::at_rest::AtRest;
use super::circle::along_ruling;
use super::query::CurvedQuery;
use super::separation::NormalSeparation;
use super::surface_pieces::{Ruling, SurfacePieces};
use crate::query::LastContacts;
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, VertexId};
use crate::tuning::SMALL_TURN;

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// What lines of both shapes prove, or a line of one and the extreme point of the other. The normals are outward,
    /// each in the frame of its shape.
    pub(super) fn on_ruled_sides(
        &mut self,
        last: &LastContacts,
        normals: [DVec3; 2],
    ) -> Option<AtRest> {
        self.on_second_side(last, normals)
            .or_else(|| self.on_first_side(last, normals))
    }

    /// Along the normal that suits the ruled side of the second shape.
    fn on_second_side(&mut self, last: &LastContacts, normals: [DVec3; 2]) -> Option<AtRest> {
        let side = OnRuledSide::new(self.cso, normals, self.cost)?;
        let [on_1, _] = side.proved(self.tolerance(), last.middle(), self.cost)?;
        Some(AtRest {
            signed_distance: side.found.distance,
            normal: side.found.normal,
            on_1,
        })
    }

    /// Along the normal that suits the ruled side of the first shape.
    fn on_first_side(
        &mut self,
        last: &LastContacts,
        [normal_1, normal_2]: [DVec3; 2],
    ) -> Option<AtRest> {
        let pose = self.cso.pose;
        let inverse = pose.inverse();
        let reversed = self.cso.reversed(&inverse);
        let side = OnRuledSide::new(&reversed, [normal_2, normal_1], self.cost)?;
        let middle = pose.point_to_2(last.middle());
        let [_, on_1] = side.proved(self.tolerance(), middle, self.cost)?;
        Some(AtRest {
            signed_distance: side.found.distance,
            normal: -pose.direction_to_1(side.found.normal),
            on_1: pose.point_to_1(on_1),
        })
    }
}

/// The greatest separation along normals that suit the ruled side of the second shape.
struct OnRuledSide<'a, 'c, A, B> {
    cso: &'a Cso<'c, A, B>,
    found: NormalSeparation,
}

impl<'a, 'c, A: SurfacePieces, B: SurfacePieces> OnRuledSide<'a, 'c, A, B> {
    fn new(cso: &'a Cso<'c, A, B>, [about, outward]: [DVec3; 2], cost: &mut Cost) -> Option<Self> {
        // Of other polytopes, the ids of extreme vertices would be needed.
        if cso.shape_2.rim(outward).is_none() && cso.shape_2.segment().is_none() {
            return None;
        }
        let mut rulings = cso.shape_2.rulings(outward, VertexId::default());
        let ruling =
            rulings.find(|side| (side.axis.dot(outward) - side.sine).abs() < SMALL_TURN)?;
        let ruling = Ruling {
            axis: cso.pose.direction_to_1(ruling.axis),
            sine: -ruling.sine,
        };
        let start = CsoVertex {
            ids: cso.start_vertices(about),
            ..CsoVertex::default()
        };
        let found = along_ruling(cso, &ruling, (about, &start), cost)?;
        Some(Self { cso, found })
    }

    /// Points of both shapes in frame 1 that prove the separation to be the signed distance up to the tolerance: at the
    /// extreme point of the first shape, or beside the middle of the contacts.
    fn proved(&self, tolerance: f64, middle: DVec3, cost: &mut Cost) -> Option<[DVec3; 2]> {
        let NormalSeparation {
            normal, distance, ..
        } = self.found;
        let most = distance + tolerance;
        let extreme = self.beside(self.found.extreme.on_1, cost)?;
        let is_near = |[on_1, on_2]: [DVec3; 2]| on_1.distance(on_2) <= most;
        if distance > 0.0 && is_near(extreme) {
            return Some(extreme);
        }
        let on_line = self.cso.shape_1.point_on_side(normal, middle, cost)?;
        let middle = self.beside(on_line, cost)?;
        if distance > 0.0 {
            return is_near(middle).then_some(middle);
        }
        let ball = self.ball(middle);
        [extreme, middle]
            .into_iter()
            .find(|[on_1, on_2]| ball.proves(*on_1 - *on_2, normal, most))
    }

    /// A point of the first shape, and that of the line of the second one on the same line along the normal.
    fn beside(&self, on_1: DVec3, cost: &mut Cost) -> Option<[DVec3; 2]> {
        let Cso { shape_2, pose, .. } = self.cso;
        let NormalSeparation {
            normal, extreme, ..
        } = self.found;
        let at = on_1 + normal * normal.dot(extreme.on_2() - on_1);
        let outward = -pose.direction_to_2(normal);
        let on_2 = shape_2.point_on_side(outward, pose.point_to_2(at), cost)?;
        Some([on_1, pose.point_to_1(on_2)])
    }

    /// A ball in the difference that touches its surface at a place.
    fn ball(&self, [on_1, on_2]: [DVec3; 2]) -> BallWithin {
        let Cso {
            shape_1,
            shape_2,
            pose,
        } = self.cso;
        let (center_1, radius_1) = shape_1.ball_at(on_1);
        let (center_2, radius_2) = shape_2.ball_at(pose.point_to_2(on_2));
        BallWithin {
            center: center_1 - pose.point_to_1(center_2),
            radius: radius_1 + radius_2,
        }
    }
}

/// A ball in the difference.
struct BallWithin {
    center: DVec3,
    radius: f64,
}

impl BallWithin {
    /// Whether no direction has a smaller depth than `-most`, given a point `w` of the difference over the origin, along
    /// a normal.
    ///
    /// At an angle `a` from the normal, `w` reaches as far as its depth times `cos a`, and the ball as far as its radius
    /// less what its centre is beneath the origin times `cos a`. Both are equal where the cosine is the radius over the
    /// distance of `w` from the centre. Beyond that angle the ball reaches farther. What `w` is beside the line along the
    /// normal is taken off its depth, which is enough up to 45 degrees; the same of the centre, off the radius.
    fn proves(&self, w: DVec3, normal: DVec3, most: f64) -> bool {
        let parts = |v: DVec3| {
            let along = v.dot(normal);
            (along, (v - normal * along).length())
        };
        let ((depth, beside), (height, aside)) = (parts(w), parts(self.center));
        let (depth, radius) = (depth - beside, self.radius - aside);
        let sum = radius.max(depth - height);
        let is_within_45_degrees = sum * sum <= 2.0 * radius * radius;
        let reach = depth.min(depth * radius / sum);
        radius > 0.0 && height <= 0.0 && is_within_45_degrees && reach >= -most
    }
}
