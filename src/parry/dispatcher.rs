//! [`IsaGjkDispatcher`], which rapier's narrow phase uses in place of parry's own dispatcher.

use std::sync::Arc;

use parry3d::math::{Pose, Real};
use parry3d::query::details::{ContactManifoldsWorkspace, NormalConstraints};
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, Unsupported,
};
use parry3d::shape::Shape;

use crate::map_pair::map_pair;
use crate::parry::composite;
use crate::parry::constraints::Constraints;
use crate::parry::custom::is_custom;
use crate::parry::hull_cache::epoch::{Epoch, EpochSource};
use crate::parry::operand::Operand;
use crate::parry::recording::Recorder;
use crate::parry::update::Updater;
use crate::parry::workspace;
use crate::stats::{SharedStats, Stats};

/// Finds contacts of convex hulls, cylinders, cones and rounded shapes, and answers queries of all convex shapes. Rapier's narrow
/// phase uses it in place of parry's dispatcher.
///
/// Pass it to `NarrowPhase::with_query_dispatcher`, or to `set_query_dispatcher` of a running world, which keeps its
/// contacts. Clones share their statistics; a clone for each of many worlds costs nothing.
///
/// | Query | Pairs that it answers itself, in either order |
/// |---|---|
/// | contact manifolds | a hull with a hull, cuboid, triangle, ball, capsule, segment or half-space; a cylinder or cone with a hull, cuboid, triangle, ball, capsule, segment, cylinder or cone, and with a half-space if it is rounded; a cuboid with a triangle; a capsule, or a rounded cuboid or triangle, with a cuboid, triangle, segment or another of these; a rounded cuboid or triangle with a ball or half-space; a shape of your own with all of these |
/// | `distance`, `closest_points`, `contact`, `intersection_test` | all convex shapes, but for half-spaces without a hull, and balls with shapes that are neither rounded nor hulls nor your own (`contact` knows those with cylinders and cones) |
/// | `cast_shapes`, `cast_shapes_nonlinear` | all convex shapes but half-spaces |
///
/// A hull is a `ConvexPolyhedron`, a `RoundConvexPolyhedron` or a [`HullShape`](crate::HullShape); cuboids, triangles,
/// cylinders and cones may be rounded. A shape of your own (`ShapeType::Custom`) takes part if its `as_support_map` or
/// `as_polygonal_feature_map` returns something; only the latter gives more than one contact. Compounds, meshes, height fields and voxels are answered part by part,
/// also where parry has no routine that does so. All
/// other pairs go to the fallback `F`: parry's dispatcher, or another one given to [`with_fallback`](Self::with_fallback). Only a pair
/// that the fallback does not know either is `Unsupported`.
///
/// It can be called without a world. The pair's memory is in its manifold, so pass the same one in each frame:
///
/// ```
/// use isa_gjk::{HullShape, IsaGjkDispatcher};
/// use parry3d::math::{Pose, Vector};
/// use parry3d::query::{ContactManifold, PersistentQueryDispatcher};
/// use parry3d::shape::Cuboid;
///
/// let dispatcher = IsaGjkDispatcher::default();
/// let table = Cuboid::new(Vector::new(2.0, 0.5, 2.0));
/// let foot = HullShape::from_points(&[Vector::X, Vector::Z, -Vector::X - Vector::Z, Vector::Y])?;
/// let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
/// let mut workspace = None;
/// for frame in 0..3 {
///     // The pose of the foot in the frame of the table, in metres: it sinks in by a millimetre a frame.
///     let pos12 = Pose::translation(0.0, 0.5 - 1e-3 * frame as f32, 0.0);
///     let prediction = 0.02;
///     dispatcher.contact_manifolds(
///         &pos12, &table, &foot, prediction, &mut manifolds, &mut workspace,
///     )?;
/// }
/// let contacts = &manifolds[0].points; // each with a point in either shape's frame
/// assert_eq!(contacts.len(), 3);
/// assert!(contacts.iter().all(|contact| (contact.dist + 2e-3).abs() < 1e-5));
/// assert!(manifolds[0].local_n1.y > 0.999, "from the table to the foot");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct IsaGjkDispatcher<F = DefaultQueryDispatcher> {
    pub(crate) fallback: F,
    stats: SharedStats,
    epochs: EpochSource,
    recorder: Option<Arc<Recorder>>,
    /// Whether the fallback gets the pairs of a user's own shapes.
    leaves_custom: bool,
}

impl Default for IsaGjkDispatcher {
    fn default() -> Self {
        Self {
            leaves_custom: false,
            ..Self::with_fallback(DefaultQueryDispatcher)
        }
    }
}

impl<F> IsaGjkDispatcher<F> {
    /// A dispatcher that passes all pairs that it does not answer itself to `fallback`: a dispatcher of your
    /// own, or several in parry's `QueryDispatcherChain`. [`Stats::left_to_fallback`] counts them, by reason.
    ///
    /// The fallback gets whole pairs, and parts of the composite shapes that this dispatcher takes apart. It also gets
    /// all pairs of shapes of your own (`ShapeType::Custom`) but [`HullShape`](crate::HullShape)s; the default dispatcher
    /// answers those that have a support mapping itself.
    ///
    /// ```
    /// use isa_gjk::IsaGjkDispatcher;
    /// use parry3d::query::{DefaultQueryDispatcher, QueryDispatcher};
    /// use rapier3d::prelude::*;
    ///
    /// // Your dispatcher is tried first, and parry's last.
    /// let yours = DefaultQueryDispatcher;
    /// let dispatcher = IsaGjkDispatcher::with_fallback(yours.chain(DefaultQueryDispatcher));
    /// let narrow_phase = NarrowPhase::with_query_dispatcher(dispatcher);
    /// # let _ = narrow_phase;
    /// ```
    pub fn with_fallback(fallback: F) -> Self {
        Self {
            fallback,
            stats: SharedStats::default(),
            epochs: EpochSource::default(),
            recorder: None,
            leaves_custom: true,
        }
    }

    /// Adds a recorder, which checks each pair and writes down those whose contacts look wrong: see
    /// [`recording`](crate::recording). Clones share the recorder.
    ///
    /// ```
    /// use std::sync::Arc;
    ///
    /// use isa_gjk::IsaGjkDispatcher;
    /// use isa_gjk::recording::Recorder;
    /// use rapier3d::prelude::*;
    ///
    /// let path = std::env::temp_dir().join("isa-gjk-wrong.pairs");
    /// let recorder = Arc::new(Recorder::create(&path)?);
    /// let dispatcher = IsaGjkDispatcher::default().with_recorder(recorder.clone());
    /// let mut world = PhysicsWorld {
    ///     narrow_phase: NarrowPhase::with_query_dispatcher(dispatcher),
    ///     ..PhysicsWorld::default()
    /// };
    /// world.step();
    /// println!("{} pairs look wrong", recorder.summary().recorded);
    /// # std::fs::remove_file(&path)?;
    /// # Ok::<(), std::io::Error>(())
    /// ```
    #[must_use]
    pub fn with_recorder(self, recorder: impl Into<Arc<Recorder>>) -> Self {
        Self {
            recorder: Some(recorder.into()),
            ..self
        }
    }

    /// Asks `answer`, unless the pair is left to the fallback.
    pub(crate) fn unless_left<T>(
        &self,
        shapes: [&dyn Shape; 2],
        answer: impl FnOnce() -> Result<T, Unsupported>,
    ) -> Result<T, Unsupported> {
        if self.leaves_custom && shapes.into_iter().any(is_custom) {
            return Err(Unsupported);
        }
        answer()
    }

    fn updater(&self, epoch: Epoch) -> Updater<'_, F> {
        Updater {
            fallback: &self.fallback,
            stats: &self.stats,
            recorder: self.recorder.as_deref(),
            epoch,
            leaves_custom: self.leaves_custom,
        }
    }

    /// What the queries of this dispatcher and its clones have cost so far.
    pub fn stats(&self) -> Stats {
        self.stats.read()
    }

    /// Runs `step`, during which you promise not to change, replace or drop the shape of any collider. Then
    /// each plain hull is verified in its first pair only, not in every pair.
    ///
    /// The step of a world keeps this promise. It covers all shapes whose contacts this dispatcher and its
    /// clones update meanwhile, in any thread. If it is broken, contacts may be those of the earlier shape.
    /// `HullShape`s need no such promise.
    ///
    /// ```
    /// use isa_gjk::IsaGjkDispatcher;
    /// use rapier3d::prelude::*;
    ///
    /// let dispatcher = IsaGjkDispatcher::default();
    /// let mut world = PhysicsWorld {
    ///     narrow_phase: NarrowPhase::with_query_dispatcher(dispatcher.clone()),
    ///     ..PhysicsWorld::default()
    /// };
    /// dispatcher.with_unchanged_shapes(|| world.step());
    /// ```
    pub fn with_unchanged_shapes<R>(&self, step: impl FnOnce() -> R) -> R {
        self.epochs.run(step)
    }

    /// Drops everything that dispatchers have prepared for plain hulls, and the memory that queries work in:
    /// in this thread now, in others before their next query.
    ///
    /// Prepared hulls whose shapes are gone are also dropped without this call, but later: a thread keeps up
    /// to 32 MiB of them. Call it at the end of a level. It changes no answer. A hull that still exists is
    /// prepared again when it is next needed.
    ///
    /// ```
    /// use isa_gjk::IsaGjkDispatcher;
    /// use rapier3d::prelude::*;
    ///
    /// let dispatcher = IsaGjkDispatcher::default();
    /// for _level in 0..2 {
    ///     let mut world = PhysicsWorld {
    ///         narrow_phase: NarrowPhase::with_query_dispatcher(dispatcher.clone()),
    ///         ..PhysicsWorld::default()
    ///     };
    ///     world.step();
    ///     drop(world);
    ///     dispatcher.trim();
    /// }
    /// ```
    pub fn trim(&self) {
        workspace::trim();
    }
}

impl<M, C, F> PersistentQueryDispatcher<M, C> for IsaGjkDispatcher<F>
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    F: PersistentQueryDispatcher<M, C> + PersistentQueryDispatcher,
{
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let epoch = self.epochs.epoch();
        let operands = map_pair([g1, g2], Operand::new);
        if operands[0].may_be_composite() || operands[1].may_be_composite() {
            let (updater, shapes) = (self.updater(epoch), [g1, g2]);
            if composite::contact_manifolds(
                self, updater, pos12, shapes, prediction, manifolds, workspace,
            ) {
                return Ok(());
            }
        }
        composite::reset_to_single(manifolds, workspace);
        let (updater, constraints) = (self.updater(epoch), [Constraints::None; 2]);
        updater.update(
            pos12,
            &operands,
            &constraints,
            prediction,
            &mut manifolds[0],
        )
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normal_constraints1: Option<&dyn NormalConstraints>,
        normal_constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        let operands = map_pair([g1, g2], Operand::new);
        let constraints = [normal_constraints1, normal_constraints2].map(Constraints::given);
        // The caller may make parts of shapes that do not outlive their pair.
        let updater = self.updater(Epoch::of_pair());
        updater.update(pos12, &operands, &constraints, prediction, manifold)
    }
}
