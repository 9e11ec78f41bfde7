//! Who writes pairs down while a world runs.

use std::fmt;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::judge::judge;
use super::{HEAD, PairView, VERSION, write};

/// A recording ends with the pair that would make it longer than this.
const DEFAULT_LIMIT: usize = 1 << 20;
/// Then it ends with this comment.
const FULL: &str = "\n# The limit was reached. Later pairs are missing.\n";

/// Writes pairs to a file, for [`IsaGjkDispatcher::with_recorder`](crate::IsaGjkDispatcher::with_recorder):
/// those whose contacts look wrong, unless it is told to write [all](Self::of_all_pairs).
///
/// Judging a pair takes a query without memory, so steps take some times as long. A recording stops at
/// 1 MiB, or at [another limit](Self::with_limit); it says so in its last line and in the log, and pairs
/// cost no more than without a recorder. An error of the file ends it as well, and never the step:
/// [`summary`](Self::summary) names it.
pub struct Recorder {
    wants_all: bool,
    limit: usize,
    is_open: AtomicBool,
    state: Mutex<State>,
}

struct State {
    out: Box<dyn Write + Send>,
    summary: RecorderSummary,
}

/// What a [`Recorder`] has done so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RecorderSummary {
    /// Updates that it looked at.
    pub seen: u64,
    /// Pairs in the file.
    pub recorded: u64,
    /// Pairs that are missing in the file, because it cannot have their shapes: those of your own types.
    pub unknown_shapes: u64,
    /// Bytes in the file.
    pub bytes: usize,
    /// The file has reached its limit, and later pairs are missing.
    pub is_full: bool,
    /// What went wrong with the file, which ended the recording.
    pub error: Option<io::ErrorKind>,
}

impl Recorder {
    /// Writes to a new file; one of this name is overwritten.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn create(path: impl AsRef<Path>) -> io::Result<Self> {
        Self::new(File::create(path)?)
    }

    /// Writes to `out`, one pair at a time.
    ///
    /// # Errors
    /// Those of `out`.
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
            state: Mutex::new(State { out, summary }),
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

    /// Ends with the pair that would make the file longer than this.
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

    /// Whether it still looks at pairs.
    pub(crate) fn is_open(&self) -> bool {
        self.is_open.load(Ordering::Relaxed)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks at a pair after its update.
    pub(crate) fn look_at(&self, pair: &PairView<'_>) {
        let suspicion = judge(pair);
        let is_wanted = self.wants_all || suspicion.is_some();
        let text = is_wanted.then(|| write(pair, suspicion));
        let mut state = self.state();
        state.summary.seen += 1;
        match text {
            None => {}
            Some(None) => state.summary.unknown_shapes += 1,
            Some(Some(text)) => state.append(&text, self.limit),
        }
        let RecorderSummary { is_full, error, .. } = &state.summary;
        self.is_open
            .store(!is_full && error.is_none(), Ordering::Relaxed);
    }
}

impl State {
    fn append(&mut self, pair: &str, limit: usize) {
        let Self { out, summary } = self;
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
