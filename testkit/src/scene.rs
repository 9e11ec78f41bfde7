//! A pose of a pair with its exact answer, by which answers are judged.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::Real;
use parry3d::query::{QueryDispatcher, TrackedContact};
use parry3d::shape::SharedShape;

use super::cases::Hull;
use super::generate::Rng;
use super::memory::{Manifold, Memory, cold_manifold};
use super::oracle::{Solid, regret, signed_distance};
use super::pose::ExactPose;
use super::report::Finding;

/// Warm against cold, relative to the size of the pair.
const DISTANCE_TOLERANCE: f64 = 1.0e-5;
/// Normals and points of manifolds, relative to the size of the pair.
const MANIFOLD_TOLERANCE: f64 = 1.0e-4;
/// Manifolds reach this far, relative to the size of the pair.
const REACH: f64 = 0.02;

/// One pose of a pair, with the exact answer.
pub struct Scene<'a> {
    pub solids: [&'a Solid; 2],
    pub shapes: [&'a SharedShape; 2],
    pub pose: ExactPose,
    pub exact: f64,
    pub scale: f64,
}

impl<'a> Scene<'a> {
    /// A pose whose exact answer the oracle finds.
    pub fn new(a: &'a Hull, b: &'a Hull, pose: ExactPose) -> Self {
        Self {
            solids: [&a.solid, &b.solid],
            shapes: [&a.shape, &b.shape],
            pose,
            exact: signed_distance(&a.solid, &b.solid, &pose),
            scale: a.solid.diameter().max(b.solid.diameter()),
        }
    }

    /// The same pose, seen from the other shape.
    pub fn swapped(&self) -> Self {
        let [a, b] = self.solids;
        let [shape_a, shape_b] = self.shapes;
        Self {
            solids: [b, a],
            shapes: [shape_b, shape_a],
            pose: self.pose.inverse(),
            ..*self
        }
    }

    pub fn prediction(&self) -> Real {
        (REACH * self.scale) as Real
    }

    pub fn update<'m>(
        &self,
        dispatcher: &IsaGjkDispatcher,
        memory: &'m mut Memory,
    ) -> Option<&'m Manifold> {
        memory.update(
            dispatcher,
            &self.pose.to_f32(),
            self.shapes,
            self.prediction(),
        )
    }

    pub fn cold(&self, dispatcher: &IsaGjkDispatcher) -> Option<Manifold> {
        cold_manifold(
            dispatcher,
            &self.pose.to_f32(),
            self.shapes,
            self.prediction(),
        )
    }

    /// Everything a manifold promises.
    pub fn judge(&self, manifold: Option<&Manifold>) -> Finding {
        let mut finding = Finding::default();
        match manifold {
            Some(manifold) => {
                self.judge_depth(&mut finding, manifold);
                if !manifold.points.is_empty() {
                    self.judge_normals(&mut finding, manifold);
                }
                for point in &manifold.points {
                    self.judge_point(&mut finding, manifold, point);
                }
            }
            None => finding.require(false, || "no manifold".to_owned()),
        }
        finding
    }

    /// The deepest point is as deep as the pair; out of reach there may be none.
    fn judge_depth(&self, finding: &mut Finding, manifold: &Manifold) {
        let slack = MANIFOLD_TOLERANCE * self.scale;
        let out_of_reach = self.exact > f64::from(self.prediction()) - slack;
        match manifold.find_deepest_contact() {
            Some(deepest) => finding.at_most(
                "depth error/scale",
                (f64::from(deepest.dist) - self.exact).abs() / self.scale,
                DISTANCE_TOLERANCE,
            ),
            None => finding.require(out_of_reach, || format!("lost a pair at {:e}", self.exact)),
        }
    }

    /// The normals are opposite unit vectors, and no other direction separates better.
    fn judge_normals(&self, finding: &mut Finding, manifold: &Manifold) {
        let (n1, n2) = (manifold.local_n1.as_dvec3(), manifold.local_n2.as_dvec3());
        finding.at_most("|n1|-1", (n1.length() - 1.0).abs(), DISTANCE_TOLERANCE);
        let opposite = self.pose.rotation * n2 + n1;
        finding.at_most("n1+n2", opposite.length(), DISTANCE_TOLERANCE);
        let [a, b] = self.solids;
        let regret = regret(a, b, &self.pose, n1, self.exact);
        finding.at_most("regret/scale", regret / self.scale, MANIFOLD_TOLERANCE);
    }

    /// A point lies in both shapes, and its distance is measured along the normal.
    fn judge_point(&self, finding: &mut Finding, manifold: &Manifold, point: &TrackedContact<u32>) {
        let (p1, p2) = (point.local_p1.as_dvec3(), point.local_p2.as_dvec3());
        let along = (self.pose.apply(p2) - p1).dot(manifold.local_n1.as_dvec3());
        finding.at_most(
            "dist error/scale",
            (along - f64::from(point.dist)).abs() / self.scale,
            DISTANCE_TOLERANCE,
        );
        let outside = self.solids[0].outside(p1).max(self.solids[1].outside(p2));
        finding.at_most(
            "outside/scale",
            outside.max(0.0) / self.scale,
            MANIFOLD_TOLERANCE,
        );
    }

    /// Warm and cold see the same contact: the same depth, and normals that are equally good.
    pub fn judge_warm(&self, warm: Option<&Manifold>, cold: Option<&Manifold>) -> Finding {
        let mut finding = self.judge(warm);
        let deepest = |manifold: Option<&Manifold>| {
            manifold.and_then(|m| m.find_deepest_contact().map(|p| f64::from(p.dist)))
        };
        if let (Some(warm), Some(cold)) = (deepest(warm), deepest(cold)) {
            finding.at_most(
                "warm-cold/scale",
                (warm - cold).abs() / self.scale,
                DISTANCE_TOLERANCE,
            );
        }
        finding
    }

    /// The stateless queries, which have nothing to be misled by but the shapes.
    pub fn judge_stateless(&self, dispatcher: &IsaGjkDispatcher) -> Finding {
        let mut finding = Finding::default();
        let [shape1, shape2] = self.shapes;
        let pose = self.pose.to_f32();
        let limit = DISTANCE_TOLERANCE;
        match dispatcher.distance(&pose, &**shape1, &**shape2) {
            Ok(answer) => {
                let error = (f64::from(answer.distance) - self.exact.max(0.0)).abs();
                finding.at_most("distance error/scale", error / self.scale, limit);
            }
            Err(_) => finding.require(false, || "no distance".to_owned()),
        }
        let reach = (self.exact.max(0.0) + self.scale) as Real;
        match dispatcher.contact(&pose, &**shape1, &**shape2, reach) {
            Ok(Some(contact)) => {
                let error = (f64::from(contact.dist) - self.exact).abs();
                finding.at_most("contact error/scale", error / self.scale, limit);
            }
            other => finding.require(false, || format!("no contact: {other:?}")),
        }
        finding
    }
}

/// A pose near touching more often than not: the middle of a random approach.
pub fn random_scene<'a>(rng: &mut Rng, a: &'a Hull, b: &'a Hull, reach: f64) -> Scene<'a> {
    let frame = rng.count(0, 15);
    Scene::new(a, b, rng.trajectory(32, reach)[frame])
}
