//! Checks contact manifolds while a world runs: against a query without memory, and against
//! parry's support functions, which know nothing of ours.

use std::fmt;

use isa_gjk::IsaGjkDispatcher;
use oorandom::Rand32;
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher, QueryDispatcher};
use rapier3d::prelude::{ContactManifold, Pose, Real, Shape, Vector};
use serde::Serialize;

use testkit::scenes::World;

/// How far an answer may be off, relative to the larger shape's diameter: the accuracy that the
/// crate promises.
const LIMIT: f64 = 1e-5;

/// What the checks found. Errors are relative to the larger shape's diameter.
#[derive(Clone, Copy, Default, Serialize)]
pub struct Verified {
    /// Manifolds that were checked.
    manifolds: u32,
    /// Those of them with contacts.
    touching: u32,
    /// The largest difference of depth between a warm answer and the cold one.
    warm_to_cold: f64,
    /// The largest difference between the distance of a manifold and that of the shapes along its
    /// normal.
    along_normal: f64,
    /// How much better the normal of parry's contact separated the shapes, at worst.
    regret: f64,
}

impl Verified {
    /// Whether any error exceeds the limit.
    pub fn failed(&self) -> bool {
        [self.warm_to_cold, self.along_normal, self.regret]
            .iter()
            .any(|error| *error > LIMIT)
    }
}

impl fmt::Display for Verified {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "checked {} manifolds, {} of them with contacts; worst error over the larger diameter",
            self.manifolds, self.touching
        )?;
        for (name, error) in [
            ("warm against cold", self.warm_to_cold),
            ("along the normal", self.along_normal),
            ("against parry's normal", self.regret),
        ] {
            let verdict = if error > LIMIT { "TOO FAR" } else { "" };
            writeln!(f, "  {name:24} {error:9.1e}  (limit {LIMIT:.0e}) {verdict}")?;
        }
        Ok(())
    }
}

/// Draws manifolds of a running world and checks them.
pub struct Verifier {
    /// The findings so far.
    pub found: Verified,
    per_visit: u32,
    random: Rand32,
}

impl Verifier {
    /// Spreads `samples` over so many visits.
    pub fn new(samples: u32, visits: usize) -> Self {
        Self {
            found: Verified::default(),
            per_visit: samples.div_ceil(visits.max(1) as u32),
            random: Rand32::new(0),
        }
    }

    /// Checks some of the manifolds that `world` has now.
    pub fn check(&mut self, world: &World) {
        let physics = &world.physics;
        let pairs = physics.narrow_phase.contact_pairs();
        let mut manifolds: Vec<_> = pairs
            .flat_map(|pair| pair.manifolds().iter().map(move |m| (pair, m)))
            .collect();
        for _ in 0..self.per_visit.min(manifolds.len() as u32) {
            let drawn = self.random.rand_range(0..manifolds.len() as u32);
            let (pair, manifold) = manifolds.swap_remove(drawn as usize);
            let [a, b] = [pair.collider1, pair.collider2].map(|handle| &physics.colliders[handle]);
            with_part(a.shape(), manifold.subshape1, |pose_1, shape_1, c1| {
                with_part(b.shape(), manifold.subshape2, |pose_2, shape_2, c2| {
                    let poses = [*a.position() * *pose_1, *b.position() * *pose_2];
                    let question = Question {
                        pos12: poses[0].inv_mul(&poses[1]),
                        shapes: [shape_1, shape_2],
                        constraints: [c1, c2],
                        prediction: physics.integration_parameters.prediction_distance(),
                    };
                    self.found.add(&question, manifold.clone());
                });
            });
        }
    }
}

/// Hands a part of a composite shape to `f`, with its pose; any other shape as it is.
fn with_part(
    shape: &dyn Shape,
    part: u32,
    mut f: impl FnMut(&Pose, &dyn Shape, Option<&dyn NormalConstraints>),
) {
    match shape.as_composite_shape() {
        Some(composite) => composite.map_part_at(part, &mut |pose, shape, constraints| {
            f(&pose.copied().unwrap_or(Pose::IDENTITY), shape, constraints);
        }),
        None => f(&Pose::IDENTITY, shape, None),
    }
}

/// Two convex shapes at their present poses.
struct Question<'a> {
    pos12: Pose,
    shapes: [&'a dyn Shape; 2],
    constraints: [Option<&'a dyn NormalConstraints>; 2],
    prediction: Real,
}

impl Question<'_> {
    /// Brings `manifold` to the present poses; `None` if the pair was left to parry.
    fn answer(&self, mut manifold: ContactManifold) -> Option<ContactManifold> {
        // One of its own, whose counts say whether it answered.
        let dispatcher = IsaGjkDispatcher::default();
        let [shape_1, shape_2] = self.shapes;
        let [c1, c2] = self.constraints;
        let result = dispatcher.contact_manifold_convex_convex(
            &self.pos12,
            shape_1,
            shape_2,
            c1,
            c2,
            self.prediction,
            &mut manifold,
        );
        result.ok()?;
        (dispatcher.stats().queries() > 0).then_some(manifold)
    }

    /// The depth by a manifold. Without points, the shapes are farther apart than the prediction.
    fn distance(&self, manifold: &ContactManifold) -> f64 {
        let distances = manifold.points.iter().map(|point| point.dist);
        distances.fold(f64::from(self.prediction), |least, next| {
            // `min` would pass over NaN.
            let next = f64::from(next);
            if next < least || next.is_nan() {
                next
            } else {
                least
            }
        })
    }

    /// How far the shapes are apart along a direction of frame 1, by parry's support functions.
    fn separation(&self, normal: Vector) -> Option<f64> {
        let [shape_1, shape_2] = self.shapes.map(Shape::as_support_map);
        let far_1 = shape_1?.local_support_point(normal);
        let far_2 = shape_2?.support_point(&self.pos12, -normal);
        let normal = normal.as_dvec3();
        let gap = far_2.as_dvec3() - far_1.as_dvec3();
        Some(gap.dot(normal) / normal.length())
    }

    /// How far the shapes are apart along the normal of a manifold. Without points it keeps an axis
    /// from whichever shape was the first to the kernels, in the frame of the larger one: what any of
    /// these readings separates is apart. The axis may be old, or zero, where the balls are apart:
    /// then parry says how far.
    fn separation_shown(&self, manifold: &ContactManifold) -> Option<f64> {
        let normal = manifold.local_n1;
        if !manifold.points.is_empty() {
            return self.separation(normal);
        }
        let seen_from_2 = self.pos12.rotation * normal;
        let readings = [normal, -normal, seen_from_2, -seen_from_2];
        let separations = readings
            .into_iter()
            .filter_map(|axis| self.separation(axis));
        let shown = separations.fold(f64::NEG_INFINITY, f64::max);
        if shown >= f64::from(self.prediction) {
            return Some(shown);
        }
        let [shape_1, shape_2] = self.shapes;
        let distance = DefaultQueryDispatcher.distance(&self.pos12, shape_1, shape_2);
        Some(distance.ok()?.distance.into())
    }

    fn size(&self) -> f64 {
        let radii = self
            .shapes
            .map(|shape| shape.compute_local_bounding_sphere().radius);
        2.0 * f64::from(radii[0].max(radii[1]))
    }
}

impl Verified {
    fn add(&mut self, question: &Question<'_>, memory: ContactManifold) {
        let Some(cold) = question.answer(ContactManifold::new()) else {
            return;
        };
        let Some(warm) = question.answer(memory) else {
            return;
        };
        let size = question.size();
        let distance = question.distance(&warm);
        self.manifolds += 1;
        self.touching += u32::from(!warm.points.is_empty());
        let difference = (distance - question.distance(&cold)).abs();
        raise(&mut self.warm_to_cold, difference / size);
        // The normals of a mesh's triangles are corrected, and then are not those of the depth.
        if question.constraints.iter().any(Option::is_some) {
            return;
        }
        let reach = f64::from(question.prediction);
        if let Some(separation) = question.separation_shown(&warm) {
            let error = (separation.min(reach) - distance).abs();
            raise(&mut self.along_normal, error / size);
        }
        let [shape_1, shape_2] = question.shapes;
        let theirs =
            DefaultQueryDispatcher.contact(&question.pos12, shape_1, shape_2, question.prediction);
        if let Ok(Some(contact)) = theirs
            && let Some(separation) = question.separation(contact.normal1)
        {
            raise(&mut self.regret, (separation.min(reach) - distance) / size);
        }
    }
}

/// NaN is infinitely wrong.
fn raise(worst: &mut f64, error: f64) {
    *worst = worst.max(if error.is_nan() { f64::INFINITY } else { error });
}
