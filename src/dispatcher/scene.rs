//! Queries without memory: distance, contact, closest points and intersection of hulls.

use glam::DVec3;
use parry3d::math::{Pose, Real};
use parry3d::query::{ClosestPoints, Contact};
use parry3d::shape::Shape;

use super::cache::ordered;
use super::half_space;
use super::pair::{self, PairVisitor, Scratch};
use crate::hull::Hull;
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

    fn visit<B: Polytope>(
        self,
        hull: &Hull,
        other: &B,
        borders: [f64; 2],
        swapped: bool,
        scratch: &mut Scratch<'_>,
    ) -> Self::Output {
        if !RelativePose::is_valid(self.pos12) {
            return None;
        }
        let pose = RelativePose::of_first(self.pos12, swapped);
        let cso = Cso {
            shape_1: hull,
            shape_2: other,
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
            Answer::Near(near) => Some(Near::new(&near, &pose, borders, swapped)),
        })
    }

    fn visit_half_space(
        self,
        hull: &Hull,
        normal: DVec3,
        border: f64,
        swapped: bool,
        _: &mut Scratch<'_>,
    ) -> Self::Output {
        if !RelativePose::is_valid(self.pos12) {
            return None;
        }
        let pose = RelativePose::of_first(self.pos12, swapped);
        let cost = &mut Cost::default();
        let near = half_space::deepest(hull, normal, &pose, &Memory::None, cost);
        let reach = f64::from(self.max_distance) + border;
        Some(
            (near.signed_distance <= reach)
                .then(|| Near::new(&near, &pose, [border, 0.0], swapped)),
        )
    }
}

impl Near {
    fn new(near: &Proximity, pose: &RelativePose, borders: [f64; 2], swapped: bool) -> Self {
        let normals = [near.normal, -pose.direction_to_2(near.normal)];
        let points = [near.on_1, pose.point_to_2(near.on_2)];
        Self {
            signed_distance: near.signed_distance - borders[0] - borders[1],
            normals: ordered(normals, swapped),
            points: ordered([0, 1].map(|i| points[i] + normals[i] * borders[i]), swapped),
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
