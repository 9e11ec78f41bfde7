//! Why a recording cannot be read.

use std::error::Error;
use std::fmt;

/// What is wrong with a recording, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordingError {
    /// Counted from 1; the last one if the text ends too soon.
    pub line: usize,
    /// What is wrong there.
    pub kind: RecordingErrorKind,
}

/// What is wrong with a line of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RecordingErrorKind {
    /// The first line is not that of a recording.
    NotARecording,
    /// The format has this version, which this crate does not know.
    UnknownVersion(String),
    /// A line that begins with this word belongs here.
    Expected(&'static str),
    /// The text ends within a pair.
    EndsTooSoon,
    /// The line has too few words.
    MissingWord,
    /// The line has more words than are known, from this one on.
    ExtraWord(String),
    /// This word is not a number, or not one that can be here.
    NotANumber(String),
    /// No shape has this name.
    UnknownShape(String),
    /// No suspicion has this name.
    UnknownSuspicion(String),
    /// The numbers make no such shape.
    BadShape,
}

impl fmt::Display for RecordingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use RecordingErrorKind as Kind;
        write!(f, "line {}: ", self.line)?;
        match &self.kind {
            Kind::NotARecording => write!(f, "this is not a recording of pairs"),
            Kind::UnknownVersion(version) => write!(f, "version {version} is not known"),
            Kind::Expected(word) => write!(f, "a line with `{word}` belongs here"),
            Kind::EndsTooSoon => write!(f, "the text ends within a pair"),
            Kind::MissingWord => write!(f, "the line ends too soon"),
            Kind::ExtraWord(word) => write!(f, "`{word}` does not belong here"),
            Kind::NotANumber(word) => write!(f, "`{word}` is not a number that can be here"),
            Kind::UnknownShape(word) => write!(f, "no shape is called `{word}`"),
            Kind::UnknownSuspicion(word) => write!(f, "no suspicion is called `{word}`"),
            Kind::BadShape => write!(f, "these numbers make no such shape"),
        }
    }
}

impl Error for RecordingError {}
