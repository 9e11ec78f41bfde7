//! Corrections of contact normals, for the internal edges of meshes.

use glam::Vec3;
use parry3d::math::Pose;
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
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

/// The normals of a contact, each as its own shape sees it, corrected. `None` if there can be no contact
/// along them.
#[inline(never)]
pub(super) fn project(
    [c1, c2]: [Constraints<'_>; 2],
    pos12: &Pose,
    [mut n1, mut n2]: [Vec3; 2],
) -> Option<[Vec3; 2]> {
    let is_possible =
        c1.with(|c1| c2.with(|c2| (c1, c2).project_local_normals(pos12, &mut n1, &mut n2)));
    is_possible.then_some([n1, n2])
}
