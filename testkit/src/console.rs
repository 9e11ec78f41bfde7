//! What the programs print.

use std::fmt::Display;
use std::io::{self, Write};

/// Prints a text. `println!` would panic if the reader of our output has closed it, as `head` does.
///
/// # Errors
/// All other errors of the output.
pub fn print(text: &impl Display) -> io::Result<()> {
    match write!(io::stdout().lock(), "{text}") {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}
