//! Queries without memory: distance, contact, closest points and intersection of hulls.

use glam::DVec3;
use parry3d::math::{Pose, Real};
use parry3d::query::{ClosestPoints, Contact};
use parry3d::shape::Shape;

use super::pair::{self, PairVisitor, Scratch};
use crate::pose::RelativePose;
use crate::query::{Answer, Memory, Proximity, Query};
use crate::stats::Cost;
use crate::support::{Cso, Polytope};

/// A pair within reach, its rounded borders accounted for; points in their own shapes' frames.
pub(super) struct Near {
    signed_distance: f64,
    normals: [DVec3; 2],
    points: [DVec3; 2],
}

/// Asks about a pair of hulls. `None`: not a pair for us. `Some(None)`: farther apart than
/// `max_distance`.
pub(super) fn near(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    max_distance: Real,
) -> Option<Option<Near>> {
    pair::visit(
        shape_1,
        shape_2,
        ColdQuery {
            pos12,
            max_distance,
        },
    )
    .flatten()
}

struct ColdQuery<'a> {
    pos12: &'a Pose,
    max_distance: Real,
}

impl PairVisitor for ColdQuery<'_> {
    type Output = Option<Option<Near>>;

    fn visit<A: Polytope, B: Polytope>(
        self,
        shape_1: &A,
        shape_2: &B,
        borders: [f64; 2],
        scratch: &mut Scratch<'_>,
    ) -> Self::Output {
        if !RelativePose::is_valid(self.pos12) {
            return None;
        }
        let pose = RelativePose::from_valid(self.pos12);
        let cso = Cso {
            shape_1,
            shape_2,
            pose: &pose,
        };
        let (answer, _) = Query {
            cso: &cso,
            max_distance: f64::from(self.max_distance) + borders[0] + borders[1],
            scratch: scratch.epa,
            cost: &mut Cost::default(),
        }
        .run(&Memory::None)?;
        Some(match answer {
            Answer::Apart(_) => None,
            Answer::Near(proximity) => Some(Near::new(&proximity, &pose, borders)),
        })
    }
}

impl Near {
    fn new(proximity: &Proximity, pose: &RelativePose, borders: [f64; 2]) -> Self {
        let normals = [proximity.normal, -pose.direction_to_2(proximity.normal)];
        let points = [proximity.on_1, pose.point_to_2(proximity.on_2)];
        Self {
            signed_distance: proximity.signed_distance - borders[0] - borders[1],
            normals,
            points: [0, 1].map(|i| points[i] + normals[i] * borders[i]),
        }
    }

    /// Zero where the shapes overlap.
    pub fn distance(&self) -> Real {
        self.signed_distance.max(0.0) as Real
    }

    pub fn intersecting(&self) -> bool {
        self.signed_distance <= 0.0
    }

    pub fn contact(&self) -> Contact {
        let [p1, p2] = self.points.map(|p| p.as_vec3());
        let [n1, n2] = self.normals.map(|n| n.as_vec3());
        Contact::new(p1, p2, n1, n2, self.signed_distance as Real)
    }

    pub fn closest_points(&self) -> ClosestPoints {
        if self.intersecting() {
            ClosestPoints::Intersecting
        } else {
            let [p1, p2] = self.points.map(|p| p.as_vec3());
            ClosestPoints::WithinMargin(p1, p2)
        }
    }
}
