//! Writes pairs down while a world runs.

use std::collections::HashMap;
use std::fmt;
use std::fs::File;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::judge::judge;
use super::text::{HEAD, POSE, VERSION, write};
use super::view::PairView;

/// How many pairs of the same two shapes that look wrong for the same reason are written down: what looks wrong
/// in one step mostly does so in the next.
const ALIKE: u32 = 4;
/// The default limit of a recording: it ends before the pair that would make it longer.
const DEFAULT_LIMIT: usize = 1 << 20;
/// Then it ends with this comment.
const FULL: &str = "\n# The limit was reached. Later pairs are missing.\n";

/// Writes pairs to a file, for [`IsaGjkDispatcher::with_recorder`](crate::IsaGjkDispatcher::with_recorder):
/// those whose contacts look wrong, unless it is told to write [all](Self::of_all_pairs). Of two shapes that
/// look wrong for the same reason again and again, it writes the first few pairs.
///
/// Each pair that is checked needs a query without memory, so steps take several times as long. A recording
/// ends at 1 MiB, or at [another limit](Self::with_limit). Its last line and the log say so, and from then on
/// pairs cost no more than without a recorder. A file error also ends it, but never the step: see
/// [`summary`](Self::summary).
pub struct Recorder {
    wants_all: bool,
    limit: usize,
    is_open: AtomicBool,
    state: Mutex<State>,
}

struct State {
    out: Box<dyn Write + Send>,
    /// How many pairs look alike, by a hash of their reason and shapes.
    alike: HashMap<u64, u32>,
    summary: RecorderSummary,
}

/// What a [`Recorder`] has done so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RecorderSummary {
    /// Updates that it checked.
    pub seen: u64,
    /// Pairs in the file.
    pub recorded: u64,
    /// Pairs that are missing in the file because a shape has a type of your own.
    pub unknown_shapes: u64,
    /// Pairs that look wrong and are missing in the file, because it has enough of their shapes and reason.
    pub repeated: u64,
    /// Bytes in the file.
    pub bytes: usize,
    /// The file has reached its limit, and later pairs are missing.
    pub is_full: bool,
    /// The file error that ended the recording.
    pub error: Option<io::ErrorKind>,
}

impl Recorder {
    /// Writes to a new file; one of this name is overwritten.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn create(path: impl AsRef<Path>) -> io::Result<Self> {
        Self::new(File::create(path)?)
    }

    /// Writes to `out`, one pair at a time.
    ///
    /// # Errors
    /// Errors of `out`.
    pub fn new(mut out: impl Write + Send + 'static) -> io::Result<Self> {
        let head = format!("{HEAD} {VERSION}\n");
        out.write_all(head.as_bytes())?;
        let summary = RecorderSummary {
            bytes: head.len(),
            ..RecorderSummary::default()
        };
        let out = Box::new(out);
        Ok(Self {
            wants_all: false,
            limit: DEFAULT_LIMIT,
            is_open: AtomicBool::new(true),
            state: Mutex::new(State {
                out,
                alike: HashMap::new(),
                summary,
            }),
        })
    }

    /// Records each pair, whether it looks wrong or not.
    #[must_use]
    pub fn of_all_pairs(self) -> Self {
        Self {
            wants_all: true,
            ..self
        }
    }

    /// Ends before the pair that would make the file longer than this.
    #[must_use]
    pub fn with_limit(self, bytes: usize) -> Self {
        Self {
            limit: bytes,
            ..self
        }
    }

    /// What it has done so far.
    pub fn summary(&self) -> RecorderSummary {
        self.state().summary.clone()
    }

    /// Whether it still checks pairs.
    pub(crate) fn is_open(&self) -> bool {
        self.is_open.load(Ordering::Relaxed)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Checks a pair after its update.
    pub(crate) fn look_at(&self, pair: &PairView<'_>) {
        let suspicion = judge(pair);
        let is_wanted = self.wants_all || suspicion.is_some();
        let text = is_wanted.then(|| write(pair, suspicion));
        let mut state = self.state();
        state.summary.seen += 1;
        match text {
            None => {}
            Some(None) => state.summary.unknown_shapes += 1,
            Some(Some(text)) if !self.wants_all && state.has_enough_like(&text) => {
                state.summary.repeated += 1;
            }
            Some(Some(text)) => state.append(&text, self.limit),
        }
        let RecorderSummary { is_full, error, .. } = &state.summary;
        self.is_open
            .store(!is_full && error.is_none(), Ordering::Relaxed);
    }
}

impl State {
    /// Whether enough pairs of the same shapes and for the same reason are in the file. Both stand before the
    /// pose.
    fn has_enough_like(&mut self, pair: &str) -> bool {
        let mut hasher = DefaultHasher::new();
        pair.split(POSE).next().hash(&mut hasher);
        let alike = self.alike.entry(hasher.finish()).or_default();
        *alike += 1;
        *alike > ALIKE
    }

    fn append(&mut self, pair: &str, limit: usize) {
        let Self { out, summary, .. } = self;
        // Another thread may have ended it meanwhile.
        if summary.is_full || summary.error.is_some() {
            return;
        }
        summary.is_full = summary.bytes + pair.len() + FULL.len() > limit;
        let text = if summary.is_full { FULL } else { pair };
        match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
            Ok(()) => {
                summary.bytes += text.len();
                summary.recorded += u64::from(!summary.is_full);
            }
            Err(error) => {
                log::warn!("a recording of pairs ends with an error: {error}");
                summary.error = Some(error.kind());
            }
        }
        if summary.is_full {
            log::warn!(
                "a recording of pairs is full: it ends at {} bytes",
                summary.bytes
            );
        }
    }
}

impl fmt::Debug for Recorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder")
            .field("wants_all", &self.wants_all)
            .field("limit", &self.limit)
            .field("summary", &self.summary())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use parry3d::math::{Pose, Real, Vector};
    use parry3d::query::{ContactManifold, TrackedContact};
    use parry3d::shape::{Cuboid, PackedFeatureId};

    use super::*;

    #[test]
    fn what_looks_wrong_again_and_again_is_recorded_a_few_times() {
        let recorder = Recorder::new(io::sink()).expect("it takes everything");
        let id = PackedFeatureId::face(0);
        let nowhere = TrackedContact::new(Vector::NAN, Vector::NAN, id, id, 0.0);
        let after = ContactManifold {
            points: [nowhere].into_iter().collect(),
            ..ContactManifold::new()
        };
        let look = |half: Real, x: Real| {
            let cuboid = Cuboid::new(Vector::splat(half));
            recorder.look_at(&PairView {
                shapes: [&cuboid, &cuboid],
                pos12: &Pose::translation(x, 0.0, 0.0),
                prediction: 0.0,
                has_corrected_normals: false,
                before: &ContactManifold::new(),
                after: &after,
            });
            let RecorderSummary {
                recorded, repeated, ..
            } = recorder.summary();
            [recorded, repeated]
        };
        let alike = u64::from(ALIKE);
        let mut counts = [0; 2];
        for step in 0..2 * ALIKE {
            counts = look(0.5, step as Real);
        }
        assert_eq!(counts, [alike; 2]);
        assert_eq!(look(0.6, 0.0), [alike + 1, alike], "another pair");
    }
}
