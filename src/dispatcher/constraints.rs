//! Corrections of contact normals, for the internal edges of meshes.

use parry3d::query::details::NormalConstraints;
use parry3d::shape::TrianglePseudoNormals;

/// What corrects the normals of a part's contacts. Computing it may cost more than finding out that
/// there is no contact.
#[derive(Clone, Copy)]
pub(super) enum Constraints<'a> {
    None,
    Given(&'a dyn NormalConstraints),
    OfTriangle(&'a dyn Fn() -> Option<TrianglePseudoNormals>),
}

impl<'a> Constraints<'a> {
    pub fn given(constraints: Option<&'a dyn NormalConstraints>) -> Self {
        constraints.map_or(Self::None, Self::Given)
    }

    /// Hands them to `f` as parry's routines want them.
    pub fn with<T>(self, f: impl FnOnce(Option<&dyn NormalConstraints>) -> T) -> T {
        match self {
            Self::None => f(None),
            Self::Given(constraints) => f(Some(constraints)),
            Self::OfTriangle(compute) => match compute() {
                Some(normals) => f(Some(&normals)),
                None => f(None),
            },
        }
    }
}
