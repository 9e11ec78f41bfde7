//! The lines of a recording, and the words in them.

use std::fmt::{Debug, Write};
use std::str::{FromStr, SplitWhitespace};

use parry3d::math::{Real, Vector};

use super::error::{RecordingError, RecordingErrorKind};

/// Begins a comment, up to the end of the line.
const COMMENT: char = '#';

/// The lines still to be read, without comments and empty lines.
pub(super) struct Lines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    /// The number of the line that was read last, from 1.
    number: usize,
}

impl<'a> Lines<'a> {
    pub fn new(text: &'a str) -> Self {
        Self {
            lines: text.lines().enumerate(),
            number: 1,
        }
    }

    /// The next line; `None` after the last one.
    pub fn next(&mut self) -> Option<Words<'a>> {
        for (index, line) in self.lines.by_ref() {
            self.number = index + 1;
            let line = line.split(COMMENT).next().unwrap_or_default();
            if !line.trim().is_empty() {
                return Some(Words {
                    words: line.split_whitespace(),
                    line: self.number,
                });
            }
        }
        None
    }

    /// An error in the line read last.
    pub fn error(&self, kind: RecordingErrorKind) -> RecordingError {
        RecordingError {
            line: self.number,
            kind,
        }
    }

    /// The next line, which must be there.
    fn following(&mut self) -> Result<Words<'a>, RecordingError> {
        let end = RecordingErrorKind::EndsTooSoon;
        self.next().ok_or_else(|| self.error(end))
    }

    /// A line with `keyword` and a count, and that many lines with an item each.
    pub fn list<T>(
        &mut self,
        keyword: &'static str,
        read: impl Fn(&mut Words<'a>) -> Result<T, RecordingError>,
    ) -> Result<Vec<T>, RecordingError> {
        let mut words = self.after(keyword)?;
        let count: usize = words.number()?;
        words.end()?;
        let items = (0..count).map(|_| {
            let mut words = self.following()?;
            let item = read(&mut words)?;
            words.end()?;
            Ok(item)
        });
        items.collect()
    }

    /// The words after `keyword` in the next line.
    pub fn after(&mut self, keyword: &'static str) -> Result<Words<'a>, RecordingError> {
        let mut words = self.following()?;
        words.keyword(keyword)?;
        Ok(words)
    }
}

/// The words still to be read in a line.
pub(super) struct Words<'a> {
    words: SplitWhitespace<'a>,
    line: usize,
}

impl<'a> Words<'a> {
    pub fn error(&self, kind: RecordingErrorKind) -> RecordingError {
        RecordingError {
            line: self.line,
            kind,
        }
    }

    pub fn keyword(&mut self, keyword: &'static str) -> Result<(), RecordingError> {
        if self.take(keyword) {
            Ok(())
        } else {
            Err(self.error(RecordingErrorKind::Expected(keyword)))
        }
    }

    /// Takes the next word if it is this one. Returns whether it is.
    pub fn take(&mut self, word: &str) -> bool {
        let mut rest = self.words.clone();
        let is_next = rest.next() == Some(word);
        if is_next {
            self.words = rest;
        }
        is_next
    }

    pub fn next_word(&mut self) -> Result<&'a str, RecordingError> {
        let word = self.words.next();
        word.ok_or_else(|| self.error(RecordingErrorKind::MissingWord))
    }

    pub fn number<T: FromStr>(&mut self) -> Result<T, RecordingError> {
        let word = self.next_word()?;
        let number = word.parse();
        number.map_err(|_| self.error(RecordingErrorKind::NotANumber(word.to_owned())))
    }

    pub fn numbers<T: FromStr + Copy + Default, const N: usize>(
        &mut self,
    ) -> Result<[T; N], RecordingError> {
        let mut numbers = [T::default(); N];
        for number in &mut numbers {
            *number = self.number()?;
        }
        Ok(numbers)
    }

    /// A number of a shape.
    pub fn finite(&mut self) -> Result<Real, RecordingError> {
        let number = self.number()?;
        self.possible(number, Real::is_finite(number))
    }

    /// A size of a shape, which is not negative: parry panics if it is.
    pub fn size(&mut self) -> Result<Real, RecordingError> {
        let size = self.finite()?;
        self.possible(size, size.is_sign_positive())
    }

    /// The sizes of a shape along three axes.
    pub fn sizes(&mut self) -> Result<Vector, RecordingError> {
        Ok(Vector::new(self.size()?, self.size()?, self.size()?))
    }

    /// A point of a shape.
    pub fn point(&mut self) -> Result<Vector, RecordingError> {
        Ok(Vector::new(self.finite()?, self.finite()?, self.finite()?))
    }

    fn possible(&self, number: Real, is_possible: bool) -> Result<Real, RecordingError> {
        let bad = || self.error(RecordingErrorKind::BadShape);
        is_possible.then_some(number).ok_or_else(bad)
    }

    pub fn vector(&mut self) -> Result<Vector, RecordingError> {
        self.numbers::<Real, 3>().map(Vector::from)
    }

    /// An error if words are left.
    pub fn end(mut self) -> Result<(), RecordingError> {
        match self.words.next() {
            None => Ok(()),
            Some(word) => Err(self.error(RecordingErrorKind::ExtraWord(word.to_owned()))),
        }
    }
}

/// Appends a line of numbers after a keyword, which may be empty. Numbers have the fewest digits that give the
/// same bits when they are read.
pub(super) fn push<T: Debug>(keyword: &str, numbers: &[T], text: &mut String) {
    text.push_str(keyword);
    for number in numbers {
        let space = if text.ends_with('\n') { "" } else { " " };
        // Writing to a string cannot fail.
        let _ = write!(text, "{space}{number:?}");
    }
    text.push('\n');
}
