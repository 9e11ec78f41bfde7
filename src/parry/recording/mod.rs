//! Pairs of shapes in a file, with their contacts, for reports of wrong contacts.
//!
//! Give the dispatcher a [`Recorder`], which writes down each pair whose contacts look wrong
//! ([`Suspicion`]), or all pairs. [`read`] reads the file, and [`RecordedPair::update`] makes the same update
//! again, to the bit.
//!
//! ```
//! use isa_gjk::IsaGjkDispatcher;
//! use isa_gjk::recording::{self, Recorder};
//! use rapier3d::prelude::*;
//!
//! let path = std::env::temp_dir().join("isa-gjk-doc.pairs");
//! let dispatcher = IsaGjkDispatcher::default().with_recorder(Recorder::create(&path)?.of_all_pairs());
//! let mut world = PhysicsWorld {
//!     narrow_phase: NarrowPhase::with_query_dispatcher(dispatcher.clone()),
//!     ..PhysicsWorld::default()
//! };
//! let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
//! let hull = SharedShape::convex_hull(&corners).expect("a solid");
//! world.insert_collider(ColliderBuilder::new(SharedShape::halfspace(Vector::Y)), None);
//! world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::new(hull));
//! world.step();
//!
//! let pairs = recording::read(&std::fs::read_to_string(&path)?)?;
//! let pair = &pairs[0];
//! assert_eq!(pair.suspicion, None);
//! assert_eq!(pair.after.points.len(), pair.update(&dispatcher).points.len());
//! # std::fs::remove_file(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The format
//!
//! Text, version 1. Words are separated by spaces, `#` begins a comment, and empty lines mean nothing. Lengths
//! are in the units of the shapes. Numbers are f32, in as few digits as give the same bits again; only NaN
//! loses its sign and payload. The first line is `isa-gjk pairs 1`. Then each pair has these lines, in this
//! order:
//!
//! | Line | Meaning |
//! |---|---|
//! | `pair` *suspicion* | what looks wrong: the [name](Suspicion::name) of a [`Suspicion`], or `nothing`; a second word `corrected` if normals are corrected for the inner edges of a mesh or compound |
//! | `shape` *name* *numbers* | twice, see below |
//! | `pose` *x y z*  *x y z w* | of shape 2 in the frame of shape 1: translation, and rotation as a quaternion |
//! | `prediction` *distance* | shapes farther apart have no contacts |
//! | `before` *n1 n2* | the normals in the manifold before the update, three numbers each |
//! | `contacts` *count* | and that many lines with a contact each: parry's packed feature ids on both shapes, the points on both in their own frames, the distance |
//! | `after` *n1 n2*, `contacts` *count*, ... | the same after the update |
//!
//! | Shape | Numbers |
//! |---|---|
//! | `hull`, `hull-shape`, `round-hull` | the border's radius, if round; then a line `points` *count* and as many lines with a point, and a line `triangles` *count* and as many lines with three indices, counter-clockwise from outside |
//! | `cuboid`, `round-cuboid` | half extents; the border's radius, if round |
//! | `ball` | radius |
//! | `segment`, `capsule` | two points; the radius of a capsule |
//! | `triangle`, `round-triangle` | three points; the border's radius, if round |
//! | `cylinder`, `round-cylinder`, `cone`, `round-cone` | half height, radius; the border's radius, if round |
//! | `half-space` | the outward normal |
//!
//! The numbers of a shape are finite, and its sizes are not negative.

mod error;
mod judge;
mod lines;
mod manifold;
mod recorder;
mod shape;
mod text;
mod view;

pub use error::{RecordingError, RecordingErrorKind};
pub use judge::Suspicion;
pub use recorder::{Recorder, RecorderSummary};

use std::fmt;

use parry3d::math::{Pose, Real, Rotation};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher};
use parry3d::shape::SharedShape;

use lines::Lines;
pub(crate) use manifold::bare;
use text::{CORRECTED, HEAD, NOTHING, POSE, VERSION, write};
pub(crate) use view::PairView;

/// Two convex shapes, and an update of their manifold.
#[derive(Clone)]
pub struct RecordedPair {
    /// What looked wrong when it was recorded.
    pub suspicion: Option<Suspicion>,
    /// The shapes; of composite shapes, the parts.
    pub shapes: [SharedShape; 2],
    /// The pose of the second shape in the frame of the first.
    pub pos12: Pose,
    /// Shapes farther apart have no contacts.
    pub prediction: Real,
    /// Whether normals were corrected for the inner edges of a mesh or compound. The corrections are not
    /// recorded.
    pub has_corrected_normals: bool,
    /// The manifold before the update, with what it remembered of the pair.
    pub before: ContactManifold<(), ()>,
    /// The manifold after it.
    pub after: ContactManifold<(), ()>,
}

impl RecordedPair {
    /// Repeats the update: lets `dispatcher` update the manifold [`before`](Self::before). With the dispatcher
    /// that was recorded, the result is [`after`](Self::after), unless normals were corrected.
    pub fn update(&self, dispatcher: &impl PersistentQueryDispatcher) -> ContactManifold<(), ()> {
        let [shape_1, shape_2] = self.shapes.each_ref().map(|shape| &**shape);
        let mut manifold = self.before.clone();
        // Nobody supports the pair: then it has the contacts that it had.
        let _ = dispatcher.contact_manifold_convex_convex(
            &self.pos12,
            shape_1,
            shape_2,
            None,
            None,
            self.prediction,
            &mut manifold,
        );
        manifold
    }

    /// What looks wrong about [`after`](Self::after).
    pub fn judge(&self) -> Option<Suspicion> {
        judge::judge(&self.view())
    }

    fn view(&self) -> PairView<'_> {
        PairView {
            shapes: self.shapes.each_ref().map(|shape| &**shape),
            pos12: &self.pos12,
            prediction: self.prediction,
            has_corrected_normals: self.has_corrected_normals,
            before: &self.before,
            after: &self.after,
        }
    }
}

impl fmt::Debug for RecordedPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&write(&self.view(), self.suspicion).unwrap_or_default())
    }
}

/// Reads all pairs of a recording.
///
/// # Errors
/// The first line that is wrong, and what is wrong there.
pub fn read(text: &str) -> Result<Vec<RecordedPair>, RecordingError> {
    let mut lines = Lines::new(text);
    let unlike = lines.error(RecordingErrorKind::NotARecording);
    let version = text.strip_prefix(HEAD).ok_or(unlike)?;
    let version = version.lines().next().unwrap_or_default().trim();
    if version != VERSION {
        return Err(lines.error(RecordingErrorKind::UnknownVersion(version.to_owned())));
    }
    lines.next();
    let mut pairs = Vec::new();
    while let Some(words) = lines.next() {
        pairs.push(read_pair(words, &mut lines)?);
    }
    Ok(pairs)
}

fn read_pair(
    mut words: lines::Words<'_>,
    lines: &mut Lines<'_>,
) -> Result<RecordedPair, RecordingError> {
    words.keyword("pair")?;
    let name = words.next_word()?;
    let suspicion = Suspicion::ALL.into_iter().find(|s| s.name() == name);
    if suspicion.is_none() && name != NOTHING {
        return Err(words.error(RecordingErrorKind::UnknownSuspicion(name.to_owned())));
    }
    let has_corrected_normals = words.take(CORRECTED);
    words.end()?;
    let shapes = [shape::read(lines)?, shape::read(lines)?];
    let mut words = lines.after(POSE)?;
    let pos12 = Pose::from_parts(words.vector()?, Rotation::from_array(words.numbers()?));
    words.end()?;
    let mut words = lines.after("prediction")?;
    let prediction = words.number()?;
    words.end()?;
    Ok(RecordedPair {
        suspicion,
        shapes,
        pos12,
        prediction,
        has_corrected_normals,
        before: manifold::read("before", lines)?,
        after: manifold::read("after", lines)?,
    })
}
