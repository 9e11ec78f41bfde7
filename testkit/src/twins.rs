//! Published hulls beside their `HullShape`s.

use std::collections::BTreeMap;
use std::fmt::Debug;

use isa_gjk::HullShape;
use parry3d::shape::SharedShape;

use super::cases::{Hull, hulls};
use super::generate::prepared;

pub fn hull_shape(shape: &SharedShape) -> &HullShape {
    shape.as_shape().expect("a hull shape")
}

/// Calls `check` with the name of each published hull, the hull and its twin.
pub fn with_twins(mut check: impl FnMut(&str, &Hull, &SharedShape)) {
    // In the order of their names, so that every run throws the same rng for each.
    let hulls: BTreeMap<_, _> = hulls().iter().collect();
    for (name, hull) in hulls {
        check(name, hull, &prepared(&hull.shape));
    }
}

/// Equal to the last bit: floats print in as many digits as tell them apart.
pub fn assert_same(ours: &impl Debug, theirs: &impl Debug, what: &str) {
    assert_eq!(format!("{ours:?}"), format!("{theirs:?}"), "{what}");
}
