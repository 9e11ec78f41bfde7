//! Proved distances of two shapes, whole regions of contact, and ids of contacts.
//!
//! [`SeparationBounds`] are a lower and an upper bound of the signed distance, with proofs of both.
//! [`ContactPatch`] is the whole polygon over which two shapes meet. [`ContactId`] follows a contact from frame
//! to frame.
//!
//! These need no world, no dispatcher and no memory. They take shapes and the pose of the second one in the frame of
//! the first. What they return is in that frame, in f64, in the units of the shapes.

mod bounds;
mod certificate;
mod contact_id;
mod error;
mod facet_walk;
mod feature;
mod gauss_map;
mod last_contacts;
mod patch;
mod pipeline;
mod search;
mod seeds;
pub(crate) mod types;
mod verdict;
mod witness;

pub use bounds::{Certificate, SeparationBounds};
pub use contact_id::ContactId;
pub use error::QueryError;
pub use feature::Feature;
pub use patch::{ContactPatch, PatchVertex};

pub use crate::ids::{EdgeId, FaceId, VertexId};

pub(crate) use certificate::flush::{Disc, FlushFaces};
pub(crate) use certificate::{cone_contains_ball, inset};
pub(crate) use contact_id::contact_keys;
pub(crate) use feature::vertices;
pub(crate) use last_contacts::{LastContacts, NORMAL_WEIGHTS, fingerprint, first_least};
pub(crate) use pipeline::{Distance, Full, Sink};
pub(crate) use types::{Answer, PairMemory, Proximity, Query, Start};
pub(crate) use witness::moved_apart;
