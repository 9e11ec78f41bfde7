//! What can be read off the files of this repository: names in documents lead somewhere, every
//! test is run, and habits that are to go do not spread.

mod imports;
mod links;
mod names;
mod ratchets;

use std::fs;
use std::path::{Path, PathBuf};

/// A path in the repository.
fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Files below a folder with this extension, in order: their paths from the root on, with `/` on all systems, and texts.
fn files(folder: &str, extension: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![root(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                let text = fs::read_to_string(&path).expect("a text file");
                let path = path.strip_prefix(root("")).expect("a file of ours");
                found.push((path.display().to_string().replace('\\', "/"), text));
            }
        }
    }
    found.sort();
    found
}

/// Lines of a text with their numbers.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line))
}
