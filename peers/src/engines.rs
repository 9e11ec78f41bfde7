//! Who answers.

#[cfg(feature = "box3d")]
mod box3d;
#[cfg(feature = "jolt")]
mod jolt;
#[cfg(feature = "physx")]
mod physx;

use isa_gjk::{IsaGjkDispatcher, PreparedShapes};
use parry3d::math::{Pose, Real};
use parry3d::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use parry3d::shape::SharedShape;
use testkit::pair::{self, Manifolds};

use crate::cases::Case;

/// An engine's contact manifold of one pair.
pub trait Engine {
    fn name(&self) -> &'static str;
    /// Brings the manifold up to date, starting from what the engine knows of the last update.
    fn update(&mut self, pose: &Pose);
    /// Drops what it knows.
    fn forget(&mut self);
    /// The least distance of a contact; `None` without contacts.
    fn deepest(&self) -> Option<Real>;
}

/// All engines that were built, with the pair.
pub fn all(case: &Case) -> Vec<Box<dyn Engine>> {
    #[allow(unused_mut, reason = "without features nothing is added")]
    let mut engines: Vec<Box<dyn Engine>> = vec![
        Box::new(Dispatched::new(
            "isa-gjk",
            IsaGjkDispatcher::default(),
            case.shapes.clone(),
        )),
        Box::new(Dispatched::new(
            "isa-gjk, HullShape",
            IsaGjkDispatcher::default(),
            prepared(&case.shapes),
        )),
        Box::new(Dispatched::new(
            "parry",
            DefaultQueryDispatcher,
            case.shapes.clone(),
        )),
    ];
    #[cfg(feature = "box3d")]
    if let Some(box3d) = box3d::Box3d::new(case) {
        engines.push(Box::new(box3d));
    }
    #[cfg(feature = "jolt")]
    engines.push(Box::new(jolt::Jolt::new(case)));
    #[cfg(feature = "physx")]
    engines.push(Box::new(physx::PhysX::new(case)));
    engines
}

/// With their hulls built ahead, as the other engines' hulls are.
fn prepared(shapes: &[SharedShape; 2]) -> [SharedShape; 2] {
    let mut prepared = PreparedShapes::default();
    shapes.each_ref().map(|shape| prepared.prepare(shape))
}

/// A dispatcher of parry's kind.
struct Dispatched<D> {
    name: &'static str,
    dispatcher: D,
    shapes: [SharedShape; 2],
    manifolds: Manifolds,
}

impl<D> Dispatched<D> {
    fn new(name: &'static str, dispatcher: D, shapes: [SharedShape; 2]) -> Self {
        Self {
            name,
            dispatcher,
            shapes,
            manifolds: Manifolds::default(),
        }
    }
}

impl<D: PersistentQueryDispatcher> Engine for Dispatched<D> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn update(&mut self, pose: &Pose) {
        pair::update(&self.dispatcher, &self.shapes, pose, &mut self.manifolds);
    }

    fn forget(&mut self) {
        self.manifolds.list.clear();
    }

    fn deepest(&self) -> Option<Real> {
        let points = self
            .manifolds
            .list
            .iter()
            .flat_map(|manifold| &manifold.points);
        points.map(|point| point.dist).reduce(Real::min)
    }
}
