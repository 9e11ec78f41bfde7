//! Bounds of a signed distance, and their proofs.

use std::f64::consts::TAU;

use glam::DVec3;
use parry3d::math::Pose;
use parry3d::query::Unsupported;
use parry3d::shape::Shape;

use super::why::why_not;
use crate::curved::SurfacePieces;
use crate::epa::{self, EpaScratch};
use crate::gjk::{self, Outcome};
use crate::hull::Hull;
use crate::parry::convert::HalfSpace;
use crate::parry::half_space;
use crate::parry::pair::{Pair, PairVisitor, valid_pose};
use crate::parry::visit;
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::{Certificate, QueryError, SeparationBounds};
use crate::simplex::{DistanceSubalgorithm, Preferred};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Polytope, Support};
use crate::tolerance::{BOUNDS_ROUNDING, GJK_CURVED_GAP, GJK_GAP_OF_SIZE};

impl SeparationBounds {
    /// Bounds for a hull and a hull, cuboid, triangle, ball, capsule, segment, cylinder, cone or half-space,
    /// rounded or not, in either order. `pos12` is the pose of shape 2 in the frame of shape 1.
    ///
    /// The bounds differ by at most 2e-6 of the smaller shape's size, or with cylinders and cones 1e-6 of both
    /// sizes; or by 1e-9 of a large distance. They are about the hull as it was prepared.
    ///
    /// # Errors
    ///
    /// [`QueryError`] reports unsupported shapes, and poses that are not finite.
    ///
    /// ```
    /// use isa_gjk::query::{Certificate, SeparationBounds};
    /// use rapier3d::prelude::*;
    ///
    /// let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    /// let tip = SharedShape::convex_hull(&corners).expect("a solid");
    /// let wall = SharedShape::cuboid(0.5, 5.0, 5.0);
    ///
    /// // A planner may move the tip by 0.25 m in any direction.
    /// let bounds = SeparationBounds::between(&*wall, &*tip, &Pose::translation(0.75, 0.0, 0.0))?;
    /// assert!(bounds.lower > 0.2499 && bounds.upper < 0.2501);
    /// assert!(matches!(bounds.certificate, Certificate::Points(_)));
    ///
    /// // Here it is 0.1 m inside, and the shortest way out is along x.
    /// let bounds = SeparationBounds::between(&*wall, &*tip, &Pose::translation(0.4, 0.0, 0.0))?;
    /// assert!(bounds.lower > -0.1001 && bounds.upper < -0.0999 && bounds.normal.x > 0.9999);
    /// let out = bounds.normal * -bounds.lower;
    /// assert!((out.x - 0.1).abs() < 1e-4);
    /// assert!(matches!(bounds.certificate, Certificate::Surface(_)));
    /// # Ok::<(), isa_gjk::query::QueryError>(())
    /// ```
    pub fn between(
        shape_1: &dyn Shape,
        shape_2: &dyn Shape,
        pos12: &Pose,
    ) -> Result<Self, QueryError> {
        let found = visit::shapes(shape_1, shape_2, BoundsQuery { pos12 });
        found.map_err(|_| why_not(pos12, [shape_1, shape_2]))
    }
}

struct BoundsQuery<'a> {
    pos12: &'a Pose,
}

impl PairVisitor for BoundsQuery<'_> {
    type Answer = SeparationBounds;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.bounds(pair, GJK_GAP_OF_SIZE, workspace)
    }

    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.bounds(pair, GJK_CURVED_GAP, workspace)
    }

    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        _: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let near = half_space::deepest(pair, &pose, f64::INFINITY).ok_or(Unsupported)?;
        let origin = pose.point_to_1(DVec3::ZERO);
        let size = pair.hull.radius() + pair.hull.center().length() + origin.length();
        let certificate = Certificate::Height(near.on_1);
        let above = (near.normal, near.normal.dot(origin));
        finish(
            pair,
            &pose,
            above,
            (near.signed_distance, certificate),
            size,
        )
    }
}

impl BoundsQuery<'_> {
    fn bounds<B: Support>(
        &self,
        pair: &Pair<'_, B>,
        gap: f64,
        workspace: &mut Workspace,
    ) -> Result<SeparationBounds, Unsupported> {
        let pose = pair.pose(valid_pose(self.pos12)?);
        let cso = pair.cso(&pose);
        let found = search(&cso, gap, &mut workspace.epa);
        let (normal, upper, certificate) = found.ok_or(Unsupported)?;
        let lowest = normal.dot(pose.point_to_1(DVec3::ZERO))
            - pair.other.extent(-pose.direction_to_2(normal));
        let above = (normal, lowest - pair.border_radii[1]);
        let size = cso.size() + cso.center().length();
        finish(pair, &pose, above, (upper, certificate), size)
    }
}

/// Bounds from a plane above all of the hull and one below all of the other shape, and from an upper bound of
/// the distance without borders, with its certificate.
fn finish<B>(
    pair: &Pair<'_, B>,
    pose: &RelativePose,
    (normal, above): (DVec3, f64),
    (upper, certificate): (f64, Certificate),
    size: f64,
) -> Result<SeparationBounds, Unsupported> {
    let planes = [pair.hull.extent(normal) + pair.border_radii[0], above];
    let border = pair.border_radii[0] + pair.border_radii[1];
    let rounding = BOUNDS_ROUNDING * size;
    let kernel = SeparationBounds {
        lower: planes[1] - planes[0] - rounding,
        upper: upper - border + rounding,
        normal,
        planes,
        certificate,
        border,
    };
    if !kernel.lower.is_finite() || !kernel.upper.is_finite() {
        return Err(Unsupported);
    }
    Ok(if pair.order.is_reversed() {
        reversed(kernel, pose)
    } else {
        kernel
    })
}

/// The normal that separates most, and an upper bound of the signed distance with its certificate.
fn search<B: Support>(
    cso: &Cso<'_, Hull, B>,
    gap: f64,
    scratch: &mut EpaScratch,
) -> Option<(DVec3, f64, Certificate)> {
    let cost = &mut Cost::default();
    let start = cso.vertex_towards_origin(cost);
    let outcome = gjk::distance_within::<Preferred, _, _>(cso, &[start], f64::INFINITY, gap, cost);
    let simplex = match outcome {
        Outcome::Separated(_) => return None,
        Outcome::Disjoint(closest) => {
            let points = Certificate::Points([closest.on_1, closest.on_2]);
            return Some((closest.normal, closest.distance, points));
        }
        Outcome::Unsure(closest) => closest.simplex,
        Outcome::Overlapping(simplex) => simplex,
    };
    let seeds: Vec<CsoVertex> = simplex.vertices().copied().collect();
    let depth = epa::penetration(cso, &seeds, scratch, cost)?;
    let (upper, certificate) = certify(scratch)?;
    Some((depth.normal, upper, certificate))
}

/// What the surface of an expansion proves: it contains a ball, or at least the shapes are no farther apart
/// than the two points on the triangle nearest to the origin.
fn certify(scratch: &EpaScratch) -> Option<(f64, Certificate)> {
    let surface = scratch.surface();
    let distance = |face: &[CsoVertex; 3]| Preferred::nearest(&face.map(|v| v.w)).point.length();
    let nearest = surface
        .clone()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let radius = distance(&nearest);
    // The solid angle of a closed surface: the whole sphere if the origin is inside, and otherwise zero.
    let seen: f64 = surface
        .clone()
        .map(|face| solid_angle(face.map(|v| v.w)))
        .sum();
    if seen > TAU {
        let points = |v: CsoVertex| [v.on_1, v.on_2()];
        let surface = surface.map(|face| face.map(points)).collect();
        return Some((-radius, Certificate::Surface(surface)));
    }
    let lambda = Preferred::nearest(&nearest.map(|v| v.w)).lambda;
    let combine = |on: fn(&CsoVertex) -> DVec3| -> DVec3 {
        let weighted = nearest.iter().zip(lambda);
        weighted.map(|(vertex, weight)| on(vertex) * weight).sum()
    };
    let points = [combine(|v| v.on_1), combine(CsoVertex::on_2)];
    Some((points[0].distance(points[1]), Certificate::Points(points)))
}

/// The solid angle of a triangle seen from the origin, positive from the side on which it turns clockwise
/// (van Oosterom, Strackee, *The solid angle of a plane triangle*, IEEE Transactions on Biomedical
/// Engineering 30(2), 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let [la, lb, lc] = [a, b, c].map(DVec3::length);
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * a.dot(b.cross(c)).atan2(below)
}

/// The bounds with the shapes exchanged, in the frame of the second one. `pose` is its pose in the frame of
/// the first.
fn reversed(bounds: SeparationBounds, pose: &RelativePose) -> SeparationBounds {
    let points = |[p, q]: [DVec3; 2]| [q, p].map(|point| pose.point_to_2(point));
    let normal = -pose.direction_to_2(bounds.normal);
    let shift = normal.dot(pose.point_to_2(DVec3::ZERO));
    let [below, above] = bounds.planes;
    SeparationBounds {
        normal,
        planes: [shift - above, shift - below],
        certificate: match bounds.certificate {
            Certificate::Points(both) => Certificate::Points(points(both)),
            // The difference is mirrored, and so are its triangles.
            Certificate::Surface(faces) => {
                let mirrored = |[a, b, c]: [[DVec3; 2]; 3]| [a, c, b].map(points);
                Certificate::Surface(faces.into_iter().map(mirrored).collect())
            }
            Certificate::Height(point) => Certificate::Height(pose.point_to_2(point)),
        },
        ..bounds
    }
}
