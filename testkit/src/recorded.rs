//! Recordings of pairs, as the programs open them.

use std::fmt::Display;
use std::fs;
use std::path::Path;

use isa_gjk::recording::{self, RecordedPair};

/// The pair with this number, counted from 0, in a file.
///
/// # Errors
/// Says what is wrong with the file, or how many pairs it has.
pub fn pair(path: &Path, number: usize) -> Result<RecordedPair, String> {
    let path_name = path.display();
    let cannot = |error: &dyn Display| format!("cannot read {path_name}: {error}");
    let text = fs::read_to_string(path).map_err(|error| cannot(&error))?;
    let pairs = recording::read(&text).map_err(|error| cannot(&error))?;
    let count = pairs.len();
    pairs
        .into_iter()
        .nth(number)
        .ok_or_else(|| format!("{path_name} has no pair {number}: it has {count}, counted from 0"))
}
