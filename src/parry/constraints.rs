//! Corrections of contact normals, for the internal edges of meshes.

use glam::Vec3;
use parry3d::math::Pose;
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::shape::{CompoundPseudoNormals, TrianglePseudoNormals};

use crate::parry::order::PairOrder;
use crate::stats::Cost;
use crate::support::{Cso, Support};
use crate::tolerance::{GRAZING, UNCORRECTED};

/// The constraints that correct the normals of a part's contacts. Computing them may cost more than finding
/// that there is no contact.
#[derive(Clone, Copy)]
pub(crate) enum Constraints<'a> {
    None,
    Given(&'a dyn NormalConstraints),
    OfTriangle(&'a dyn Fn() -> Option<TrianglePseudoNormals>),
    OfPart(&'a CompoundPseudoNormals),
}

impl<'a> Constraints<'a> {
    pub fn given(constraints: Option<&'a dyn NormalConstraints>) -> Self {
        constraints.map_or(Self::None, Self::Given)
    }

    pub fn are_none(&self) -> bool {
        matches!(self, Self::None)
    }

    /// The normals to choose from in the place of `normal`, as the part sees them: those of its outer
    /// faces, and of the faces next to these. None where `normal` is out of the surface itself.
    ///
    /// A normal out of a cut, where another part goes on, is perpendicular to outer faces or leans a
    /// little towards any of them. How it leans says nothing about the surface: the overlap does.
    pub fn instead_of(self, normal: Vec3) -> Option<impl Iterator<Item = Vec3>> {
        let Self::OfPart(part) = self else {
            return None;
        };
        let cones = &part.boundary_faces;
        let is_outwards = cones
            .iter()
            .any(|cone| cone.face.dot(normal) > GRAZING as f32);
        let projected = part.project_local_normal(normal)?;
        let is_outer = is_outwards && projected.abs_diff_eq(normal, UNCORRECTED);
        (!is_outer).then(|| {
            cones.iter().flat_map(|cone| {
                let face = cone.face;
                let beside = move |half_way: &Vec3| *half_way * (2.0 * half_way.dot(face)) - face;
                std::iter::once(face).chain(cone.edge_pseudo_normals.iter().map(beside))
            })
        })
    }

    /// Hands them to `f` as parry's routines want them.
    pub fn with<T>(self, f: impl FnOnce(Option<&dyn NormalConstraints>) -> T) -> T {
        match self {
            Self::None => f(None),
            Self::Given(constraints) => f(Some(constraints)),
            Self::OfPart(normals) => f(Some(normals)),
            Self::OfTriangle(compute) => match compute() {
                Some(normals) => f(Some(&Leaning(normals))),
                None => f(None),
            },
        }
    }
}

/// Pseudo-normals of a triangle that take what lies in its plane up to rounding for a direction to its
/// front. Hulls that stand upright in a floor have such normals.
struct Leaning(TrianglePseudoNormals);

impl NormalConstraints for Leaning {
    fn project_local_normal_mut(&self, normal: &mut Vec3) -> bool {
        let along_face = normal.dot(self.0.face);
        if (-GRAZING as f32..0.0).contains(&along_face) {
            *normal = (*normal + self.0.face * (GRAZING as f32)).normalize();
        }
        self.0.project_local_normal_mut(normal)
    }
}

/// The normals of a contact, each as its own shape sees it, corrected: first out of cuts, where another
/// part goes on, then into the cones of outer normals. `None` if there can be no contact along them.
/// `order` is that of the shapes of `cso`.
#[inline(never)]
pub(crate) fn correct<A: Support, B: Support>(
    [c1, c2]: [Constraints<'_>; 2],
    pos12: &Pose,
    (cso, order): (&Cso<'_, A, B>, PairOrder),
    max_distance: f64,
    [mut n1, mut n2]: [Vec3; 2],
) -> Option<[Vec3; 2]> {
    let rotation = pos12.rotation;
    let least_overlap = |candidates: &mut dyn Iterator<Item = [Vec3; 2]>| {
        outermost(cso, order, candidates).filter(|(_, distance)| *distance <= max_distance)
    };
    if let Some(outer) = c1.instead_of(n1) {
        let mut pairs = outer.map(|normal| [normal, rotation.inverse() * -normal]);
        ([n1, n2], _) = least_overlap(&mut pairs)?;
    }
    if let Some(outer) = c2.instead_of(n2) {
        let mut pairs = outer.map(|normal| [rotation * -normal, normal]);
        ([n1, n2], _) = least_overlap(&mut pairs)?;
    }
    let is_possible =
        c1.with(|c1| c2.with(|c2| (c1, c2).project_local_normals(pos12, &mut n1, &mut n2)));
    is_possible.then_some([n1, n2])
}

/// Of pairs of normals, each as its own shape sees it, those along which the shapes overlap least, and
/// their distance along these.
fn outermost<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    order: PairOrder,
    candidates: &mut dyn Iterator<Item = [Vec3; 2]>,
) -> Option<([Vec3; 2], f64)> {
    let distances = candidates.map(|normals| {
        let [normal, _] = order.to_kernel(normals);
        let normal = normal.as_dvec3();
        let extreme = cso.support(normal, cso.start_vertices(normal), &mut Cost::default());
        (normals, -extreme.w.dot(normal))
    });
    distances.max_by(|(_, a), (_, b)| a.total_cmp(b))
}
