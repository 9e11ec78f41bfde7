//! Queries without memory: distance, contact, closest points and intersection of hulls.
//!
//! Only `contact` asks how deep shapes overlap; the others end with GJK.

use glam::DVec3;
use parry3d::math::{Pose, Real};
use parry3d::query::{ClosestPoints, Contact};
use parry3d::shape::Shape;

use super::pair::{self, PairVisitor, Scratch};
use crate::gjk::{self, Closest, Outcome};
use crate::pose::RelativePose;
use crate::query::{Answer, Memory, Proximity, Query};
use crate::simplex::Voronoi;
use crate::stats::Cost;
use crate::support::{Cso, Polytope};

/// Whether two shapes touch or overlap. `None`, here and below: not a pair for us.
pub(super) fn intersect(pos12: &Pose, shape_1: &dyn Shape, shape_2: &dyn Shape) -> Option<bool> {
    let separation = separation(pos12, shape_1, shape_2, 0.0)?;
    Some(matches!(separation, Separation::None))
}

/// Zero where the shapes overlap.
pub(super) fn distance(pos12: &Pose, shape_1: &dyn Shape, shape_2: &dyn Shape) -> Option<Real> {
    Some(match separation(pos12, shape_1, shape_2, Real::INFINITY)? {
        Separation::None => 0.0,
        Separation::Near(near) => near.signed_distance as Real,
        Separation::Beyond => Real::INFINITY,
    })
}

/// The nearest points of shapes that are at most `max_distance` apart.
pub(super) fn closest_points(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    max_distance: Real,
) -> Option<ClosestPoints> {
    Some(match separation(pos12, shape_1, shape_2, max_distance)? {
        Separation::None => ClosestPoints::Intersecting,
        Separation::Near(near) => {
            let [p1, p2] = near.points.map(|p| p.as_vec3());
            ClosestPoints::WithinMargin(p1, p2)
        }
        Separation::Beyond => ClosestPoints::Disjoint,
    })
}

/// The deepest contact of shapes that overlap or are at most `prediction` apart.
pub(super) fn contact(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    prediction: Real,
) -> Option<Option<Contact>> {
    let query = ContactQuery { pos12, prediction };
    pair::visit(shape_1, shape_2, query).flatten()
}

/// The nearest points of a pair, its rounded borders accounted for. Normals and points are in
/// their own shapes' frames.
pub(super) struct Near {
    pub signed_distance: f64,
    pub normals: [DVec3; 2],
    pub points: [DVec3; 2],
}

impl Near {
    /// From two points and the normal of the cores, in frame 1.
    pub fn new(
        normal: DVec3,
        points: [DVec3; 2],
        signed_distance: f64,
        pose: &RelativePose,
        borders: [f64; 2],
    ) -> Self {
        let normals = [normal, -pose.direction_to_2(normal)];
        let points = [points[0], pose.point_to_2(points[1])];
        Self {
            signed_distance: signed_distance - borders[0] - borders[1],
            normals,
            points: [0, 1].map(|i| points[i] + normals[i] * borders[i]),
        }
    }

    pub fn of_proximity(near: &Proximity, pose: &RelativePose, borders: [f64; 2]) -> Self {
        let points = [near.on_1, near.on_2];
        Self::new(near.normal, points, near.signed_distance, pose, borders)
    }

    fn of_closest(near: &Closest, pose: &RelativePose, borders: [f64; 2]) -> Self {
        let points = [near.on_1, near.on_2];
        Self::new(near.normal, points, near.distance, pose, borders)
    }

    fn contact(&self) -> Contact {
        let [p1, p2] = self.points.map(|p| p.as_vec3());
        let [n1, n2] = self.normals.map(|n| n.as_vec3());
        Contact::new(p1, p2, n1, n2, self.signed_distance as Real)
    }
}

/// What lies between two shapes.
enum Separation {
    /// Nothing: they touch or overlap.
    None,
    /// A gap, and where it is narrowest.
    Near(Near),
    /// More than was asked about.
    Beyond,
}

fn separation(
    pos12: &Pose,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    max_distance: Real,
) -> Option<Separation> {
    let query = SeparationQuery {
        pos12,
        max_distance,
    };
    pair::visit(shape_1, shape_2, query).flatten()
}

struct SeparationQuery<'a> {
    pos12: &'a Pose,
    max_distance: Real,
}

impl PairVisitor for SeparationQuery<'_> {
    type Output = Option<Separation>;

    fn visit<A: Polytope, B: Polytope>(
        self,
        shape_1: &A,
        shape_2: &B,
        borders: [f64; 2],
        _scratch: &mut Scratch<'_>,
    ) -> Self::Output {
        let pose = RelativePose::new(self.pos12)?;
        let cso = Cso {
            shape_1,
            shape_2,
            pose: &pose,
        };
        let cost = &mut Cost::default();
        let start = cso.vertex_towards_origin(cost);
        let max_distance = f64::from(self.max_distance) + borders[0] + borders[1];
        let outcome = gjk::distance::<Voronoi, _, _>(&cso, &[start], max_distance, cost);
        Some(match outcome {
            Outcome::Apart(_) => Separation::Beyond,
            Outcome::Overlap(_) => Separation::None,
            Outcome::Near(closest) => {
                let near = Near::of_closest(&closest, &pose, borders);
                if near.signed_distance <= 0.0 {
                    Separation::None
                } else {
                    Separation::Near(near)
                }
            }
        })
    }
}

struct ContactQuery<'a> {
    pos12: &'a Pose,
    prediction: Real,
}

impl PairVisitor for ContactQuery<'_> {
    type Output = Option<Option<Contact>>;

    fn visit<A: Polytope, B: Polytope>(
        self,
        shape_1: &A,
        shape_2: &B,
        borders: [f64; 2],
        scratch: &mut Scratch<'_>,
    ) -> Self::Output {
        let pose = RelativePose::new(self.pos12)?;
        let cso = Cso {
            shape_1,
            shape_2,
            pose: &pose,
        };
        let (answer, _) = Query {
            cso: &cso,
            max_distance: f64::from(self.prediction) + borders[0] + borders[1],
            scratch: scratch.epa,
            cost: &mut Cost::default(),
        }
        .run(&Memory::None)?;
        Some(match answer {
            Answer::Apart(_) => None,
            Answer::Near(near) => Some(Near::of_proximity(&near, &pose, borders).contact()),
        })
    }
}
