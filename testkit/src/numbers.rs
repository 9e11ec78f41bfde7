//! Numbers on the command lines of the programs.

use std::str::FromStr;

/// A number that is finite.
pub fn finite<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    let number = text
        .parse()
        .ok()
        .filter(|&number: &T| number.into().is_finite());
    number.ok_or_else(|| "give a number".to_owned())
}

/// A finite number above zero.
pub fn positive<T: FromStr + Copy + Into<f64>>(text: &str) -> Result<T, String> {
    let number: T = text.parse().map_err(|_| "give a number".to_owned())?;
    let is_positive = number.into().is_finite() && number.into() > 0.0;
    is_positive
        .then_some(number)
        .ok_or_else(|| "give a number above zero".to_owned())
}
