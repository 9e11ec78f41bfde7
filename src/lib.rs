//! A coherent narrow phase for the convex hulls of [rapier](https://rapier.rs) worlds.
//!
//! [`IsaGjkDispatcher`] answers pairs with a convex hull, a cylinder or a cone, starting from the previous frame,
//! and passes the contacts of other pairs on to parry's own dispatcher, or to one of yours. It is installed in
//! one line. Plain `SharedShape::convex_hull` colliders need no change. A [`HullShape`] contains its prepared
//! hull, so that no cache is searched for it, and computes its own bounding box.
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
//! Frame 1 is that of a pair's first shape; normals point from shape 1 to shape 2. Positions are
//! in the named shape's frame, lengths in the units of the shapes (metres in rapier). Distances
//! are positive between separate shapes, and minus the penetration depth between overlapping
//! ones. Input is f32. Distances, depths and their proofs are computed in f64; scans of small hulls
//! compare in f32 first and settle near ties in f64, and contacts beside the witness are clipped in f32.
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
#![deny(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod arg_max;
mod at;
#[cfg(feature = "bevy")]
pub mod bevy;
mod corners;
mod curved;
mod epa;
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

/// Everything that a user of a physics world needs.
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
