//! A narrow phase for the convex hulls of [rapier](https://rapier.rs) worlds: it finds where they touch, starting
//! from what each pair knew in the previous frame.
//!
//! [`IsaGjkDispatcher`] answers pairs with a convex hull, a cylinder or a cone, and passes the others on to parry's
//! own dispatcher, or to one of yours. It is installed in one line, and plain `SharedShape::convex_hull` colliders
//! need no change. A [`HullShape`] is a collider shape that contains its prepared hull: nothing is prepared while the
//! world runs, and no point is compared. [`query`] has proved distances and whole regions of contact, and
//! [`recording`] writes down pairs whose contacts look wrong.
//!
//! # Quick start
//!
//! ```
//! use isa_gjk::prelude::*;
//! use rapier3d::prelude::*;
//!
//! let dispatcher = IsaGjkDispatcher::default();
//! let mut world = PhysicsWorld {
//!     narrow_phase: NarrowPhase::with_query_dispatcher(dispatcher.clone()),
//!     ..PhysicsWorld::default()
//! };
//! let floor = ColliderBuilder::cuboid(5.0, 0.5, 5.0).translation(Vector::new(0.0, -0.5, 0.0));
//! world.insert_collider(floor, None);
//!
//! // Half a metre across, in the collider's frame.
//! let corners: Vec<Vector> = (0..8)
//!     .map(|i| Vector::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 0.5)
//!     .collect();
//! let plain = SharedShape::convex_hull(&corners).expect("a solid");
//! let prepared = SharedShape::new(HullShape::from_points(&corners)?);
//! let bodies = [(plain, 0.1), (prepared, 1.0)].map(|(shape, height)| {
//!     let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, height, 0.0));
//!     world.insert(body, ColliderBuilder::new(shape)).0
//! });
//! for _ in 0..120 {
//!     world.step();
//! }
//! let [low, high] = bodies.map(|body| world.bodies[body].translation().y);
//! assert!(low.abs() < 0.01 && (high - 0.5).abs() < 0.01, "one stands on the other");
//!
//! let stats = dispatcher.stats();
//! let searched: u64 = stats.answered[Stage::WarmGjk as usize..].iter().sum();
//! println!("{searched} of {} queries took GJK or EPA", stats.queries());
//! # assert!(searched < stats.queries());
//! # Ok::<(), HullError>(())
//! ```
//!
//! # Frames and units
//!
//! Lengths are in the units of the shapes, which are metres in rapier; there are no absolute tolerances. Positions are
//! in the frame of the shape that is named with them. *Frame 1* is that of a pair's first shape, and `pos12` is the
//! pose of the second shape in it. Normals have unit length and point from shape 1 to shape 2. Distances are positive
//! between separate shapes, and minus the penetration depth between overlapping ones.
//!
//! Input is f32. Distances, depths and their proofs are computed in f64, and are right to 1e-5 of the diameter of the
//! larger shape's bounding sphere. Contacts beside the deepest one are clipped in f32.
//!
//! # Errors
//!
//! No step or query panics on finite input, and none returns NaN (parry may, where a pair is left to it). A surface
//! that is no convex solid is refused by [`HullShape`] with a [`HullError`]; a plain hull of that kind is left to the
//! fallback, which is counted in [`Stats::left_to_fallback`] and logged once. Queries that do not know a shape return
//! parry's `Unsupported`, those of [`query`] a [`QueryError`](query::QueryError).
//!
//! # Without a physics engine
//!
//! The dispatcher's queries are parry's traits, which need no world; [`query`] has two of its own:
//!
//! ```
//! use isa_gjk::query::SeparationBounds;
//! use isa_gjk::{HullShape, IsaGjkDispatcher};
//! use parry3d::math::{Pose, Vector};
//! use parry3d::query::QueryDispatcher;
//!
//! let hull = HullShape::from_points(&[Vector::ZERO, Vector::X, Vector::Y, Vector::Z])?;
//! let pos12 = Pose::translation(-1.5, 0.0, 0.0);
//! let found = IsaGjkDispatcher::default().distance(&pos12, &hull, &hull)?;
//! assert!((found.distance - 0.5).abs() < 1e-6);
//!
//! let bounds = SeparationBounds::between(&hull, &hull, &pos12)?;
//! assert!(bounds.lower <= 0.5 && 0.5 <= bounds.upper && bounds.upper - bounds.lower < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! None is on by default.
//!
//! | Feature | What it adds |
//! |---|---|
//! | `rapier` | narrow phases that are compiled with this crate, for programs that are not optimised |
//! | `bevy`, `bevy_app` | rapier worlds in Bevy's entities; the same as a plugin |
//! | `serde-serialize`, `parallel`, `enhanced-determinism`, `simd8`, `profiler` | rapier's features of these names; `simd8` and `enhanced-determinism` exclude each other |
//!
//! # Sources
//!
//! A pair's last separating axis is tried first, as in van den Bergen's incremental separating-axis GJK, which gave
//! the crate its name. Distances come from GJK (Gilbert, Johnson and Keerthi) with signed volumes (Montanari, Petrinic
//! and Barbieri), depths from EPA (van den Bergen). `docs/theory.md` in the repository proves what is new: how the
//! features of the previous frame certify an answer.
#![deny(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod arg_max;
mod at;
#[cfg(feature = "bevy")]
pub mod bevy;
mod corners;
mod curved;
mod epa;
mod face_planes;
mod gjk;
mod hull;
mod ids;
mod manifold;
mod map_pair;
mod mix;
mod oriented_box;
mod parry;
mod pose;
mod primitive;
pub mod query;
#[cfg(feature = "rapier")]
pub mod rapier;
mod ray_cast;
mod simd;
mod simplex;
mod slots;
mod stats;
mod support;
mod tolerance;
mod tuning;

pub use hull::{Hull, HullError};
pub use parry::dispatcher::IsaGjkDispatcher;
pub use parry::hull_shape::{HullShape, PreparedShapes};
pub use parry::recording;
pub use stats::{Left, Stage, Stats};

/// What most programs need, to be imported at once.
///
/// ```
/// use isa_gjk::prelude::*;
///
/// let dispatcher = IsaGjkDispatcher::default();
/// assert_eq!(dispatcher.stats(), Stats::default());
/// ```
pub mod prelude {
    pub use crate::{
        Hull, HullError, HullShape, IsaGjkDispatcher, Left, PreparedShapes, Stage, Stats,
    };
}

/// Kernels, for this crate's tests and benches only. They may change with any version.
#[doc(hidden)]
pub mod internals {
    pub mod curved {
        pub use crate::curved::*;
    }
    pub mod epa {
        pub use crate::epa::*;
    }
    pub mod gjk {
        pub use crate::gjk::*;
    }
    pub mod hull {
        pub use crate::hull::*;
    }
    pub mod manifold {
        pub use crate::manifold::*;
    }
    pub mod pose {
        pub use crate::pose::*;
    }
    pub mod primitive {
        pub use crate::primitive::*;
    }
    pub mod query {
        pub use crate::query::types::*;
    }
    pub mod ray_cast {
        pub use crate::ray_cast::*;
    }
    pub mod simplex {
        pub use crate::simplex::*;
    }
    pub mod stats {
        pub use crate::stats::*;
    }
    pub mod support {
        pub use crate::support::*;
    }
    pub mod tolerance {
        pub use crate::tolerance::*;
    }
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(doctest)]
#[doc = include_str!("../docs/tips.md")]
struct Tips;

#[cfg(doctest)]
#[doc = include_str!("../docs/reporting.md")]
struct Reporting;

#[cfg(all(doctest, feature = "bevy_app"))]
#[doc = include_str!("../docs/bevy.md")]
struct BevyPage;
