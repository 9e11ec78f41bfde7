//! Corrections of contact normals, for the internal edges of meshes.

use std::cell::Cell;

use glam::{DVec3, Vec3};
use parry3d::math::Pose;
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};

use crate::manifold::Contacts;
use crate::parry::leaning_normals::LeaningNormals;
use crate::parry::order::PairOrder;
use crate::parry::part_seams::PartSeams;
use crate::query::Proximity;
use crate::stats::Cost;
use crate::support::{Cso, Support};
use crate::tolerance::UNCORRECTED;

/// The constraints that correct the normals of a part's contacts. Computing them may cost more than finding
/// that there is no contact.
#[derive(Clone, Copy)]
pub(crate) enum Constraints<'a> {
    None,
    Given(&'a dyn NormalConstraints),
    OfTriangle(TriangleSeams<'a>),
    OfPart(PartSeams<'a>),
}

/// One triangle of a mesh whose inner edges are corrected.
#[derive(Clone, Copy)]
pub(crate) struct TriangleSeams<'a> {
    pub normals: &'a dyn Fn() -> Option<LeaningNormals>,
    /// Whether some triangle overlaps the other shape, but has no contact along the corrected normal. Mostly a
    /// triangle beside it has one.
    pub is_left: &'a Cell<bool>,
    /// Whether no triangle has a contact along a corrected normal: over the border of a mesh, the query's own
    /// are the only ones.
    pub is_beyond_border: bool,
}

impl<'a> Constraints<'a> {
    pub fn given(constraints: Option<&'a dyn NormalConstraints>) -> Self {
        constraints.map_or(Self::None, Self::Given)
    }

    /// Whether nothing constrains the normals of a pair.
    #[inline]
    pub fn are_none(of_pair: &[Self; 2]) -> bool {
        matches!(of_pair, [Self::None, Self::None])
    }

    /// Whether they are the caller's own, of whose surface nothing else is known.
    fn is_given(&self) -> bool {
        matches!(self, Self::Given(_))
    }

    fn triangle(self) -> Option<TriangleSeams<'a>> {
        match self {
            Self::OfTriangle(triangle) => Some(triangle),
            _ => None,
        }
    }

    fn part(self) -> Option<PartSeams<'a>> {
        match self {
            Self::OfPart(part) => Some(part),
            _ => None,
        }
    }

    /// Passes them to `f` in the form that parry's routines take.
    pub fn with<T>(self, f: impl FnOnce(Option<&dyn NormalConstraints>) -> T) -> T {
        match self {
            Self::None => f(None),
            Self::Given(constraints) => f(Some(constraints)),
            Self::OfPart(part) => f(Some(part.normals)),
            Self::OfTriangle(triangle) => match (triangle.normals)() {
                Some(normals) => f(Some(&normals)),
                None => f(None),
            },
        }
    }
}

/// Normals of a contact in the caller's order, each in the frame of its shape.
pub(crate) struct Corrected {
    pub normals: [Vec3; 2],
    /// For normals that are not near the query's: the distance of the whole shapes along them. No contact is
    /// deeper.
    pub least: Option<f64>,
}

/// A pair with parts.
pub(crate) struct ConstrainedPair<'a, 'c, A, B> {
    pub cso: &'a Cso<'c, A, B>,
    /// The order of the shapes of `cso`.
    pub order: PairOrder,
    /// In the caller's order, as `pos12`.
    pub constraints: [Constraints<'a>; 2],
    pub pos12: &'a Pose,
    pub max_distance: f64,
    /// The sum of the radii of the borders around the shapes of `cso`.
    pub border: f64,
}

impl<A: Support, B: Support> ConstrainedPair<'_, '_, A, B> {
    /// The corrected normals. A normal out of a cut, where another part continues, is replaced. Then normals
    /// are projected into the cones of outer normals. `None` if there can be no contact along them.
    #[inline(never)]
    pub fn correct(&self, normals: [Vec3; 2]) -> Option<Corrected> {
        let mut corrected = Corrected {
            normals,
            least: None,
        };
        for shape in [0, 1] {
            let part = self.constraints[shape].part();
            if part.is_some_and(|part| part.is_cut(corrected.normals[shape])) {
                let out = self.way_out(shape, f64::INFINITY)?;
                if !self.leads_through(shape, &out) {
                    corrected = out;
                }
            }
        }
        let [n1, n2] = &mut corrected.normals;
        let [c1, c2] = self.constraints;
        let is_possible =
            c1.with(|c1| c2.with(|c2| (c1, c2).project_local_normals(self.pos12, n1, n2)));
        let is_direction = |normal: &Vec3| normal.try_normalize().is_some();
        (is_possible && (!self.obeys() || corrected.normals.iter().all(is_direction)))
            .then_some(corrected)
    }

    /// Whether no other normal than the corrected one may be used: the constraints are the caller's own. Those of meshes
    /// and compounds also say what to do where they lead nowhere.
    pub fn obeys(&self) -> bool {
        self.constraints.iter().any(Constraints::is_given)
    }

    /// As in parry, the contact of overlapping shapes whose faces do not meet along the normal that the caller's
    /// constraints allow: at the witness points, with their distance along it. No part beside this one has a contact
    /// instead.
    pub fn at_witness(
        &self,
        near: &Proximity,
        corrected: &Corrected,
        max_distance: f64,
    ) -> Option<([Vec3; 2], Contacts)> {
        let normals = self.order.to_kernel(corrected.normals);
        let normal = normals[0].as_dvec3().normalize();
        let signed_distance = normal.dot(near.on_2 - near.on_1);
        let along = Proximity {
            signed_distance,
            normal,
            ..*near
        };
        let contacts = Contacts::witness(&along, self.cso.pose);
        (signed_distance <= max_distance).then_some((normals, contacts))
    }

    /// Whether the constraints leave the query's normals, which are in the kernels' order, as they are.
    pub fn leaves(&self, corrected: Option<&Corrected>, normals: [Vec3; 2]) -> bool {
        corrected.is_some_and(|corrected| {
            let [normal, _] = self.order.to_kernel(corrected.normals);
            normal.abs_diff_eq(normals[0], UNCORRECTED)
        })
    }

    /// The contacts that no other part covers, if shapes of this signed distance, with their borders, have any. If no
    /// parts that overlap have one, their normals are not corrected.
    pub fn uncovered(
        &self,
        chosen: Option<([Vec3; 2], Contacts)>,
        signed_distance: f64,
        along: impl FnMut(&Corrected) -> Option<([Vec3; 2], Contacts)>,
    ) -> Option<([Vec3; 2], Contacts)> {
        let found = chosen.and_then(|chosen| self.first_uncovered(chosen, along));
        if found.is_none() && signed_distance < 0.0 {
            let parts = self.constraints.iter().filter_map(|c| c.part());
            parts.for_each(|part| part.is_left.set(true));
        }
        found
    }

    /// The contacts, or other ones if another part covers the face that they are all on. Contacts along an
    /// outer normal are found by `along`. Normals are in the kernels' order. A way through a whole part is none:
    /// what is inside of a ring stays there.
    fn first_uncovered(
        &self,
        mut chosen: ([Vec3; 2], Contacts),
        mut along: impl FnMut(&Corrected) -> Option<([Vec3; 2], Contacts)>,
    ) -> Option<([Vec3; 2], Contacts)> {
        let mut beyond = f64::INFINITY;
        while chosen.1.len > 0
            && let Some(shape) = self.covered_shape(&chosen.1, chosen.0)
        {
            let out = self.way_out(shape, beyond)?;
            beyond = out.least?;
            if self.leads_through(shape, &out) {
                break;
            }
            chosen = along(&out)?;
        }
        (chosen.1.len > 0).then_some(chosen)
    }

    /// Whether a way out of a part leads through the whole part: it is longer than the part is thick, and the other
    /// shape's centre is beneath that of the part.
    fn leads_through(&self, shape: usize, out: &Corrected) -> bool {
        let Self { cso, order, .. } = self;
        let along = out.normals[shape].as_dvec3();
        let [width, rise] = if order.to_caller([0, 1])[shape] == 0 {
            let other = cso.pose.point_to_1(cso.shape_2.center());
            measure(cso.shape_1, other, along)
        } else {
            let other = cso.pose.point_to_2(cso.shape_1.center());
            measure(cso.shape_2, other, along)
        };
        out.least.is_some_and(|least| -least > width) && rise < 0.0
    }

    /// Whether overlapping shapes that have no contact along a corrected normal are pushed apart along their own.
    pub fn is_beyond_border(&self) -> bool {
        let mut triangles = self.constraints.iter().filter_map(|c| c.triangle());
        triangles.any(|triangle| {
            triangle.is_left.set(true);
            triangle.is_beyond_border
        })
    }

    /// Of the outer normals of a part, the one along which the shapes overlap least, if they are nearer along
    /// it than `beyond`.
    fn way_out(&self, shape: usize, beyond: f64) -> Option<Corrected> {
        let rotation = self.pos12.rotation;
        let outer = self.constraints[shape].part()?.outer_normals();
        let ways = outer.map(|normal| {
            let normals = if shape == 0 {
                [normal, rotation.inverse() * -normal]
            } else {
                [rotation * -normal, normal]
            };
            let [along, _] = self.order.to_kernel(normals);
            let along = along.as_dvec3();
            let cso = self.cso;
            let start = cso.start_vertices(along);
            let extreme = cso.support(along, start, &mut Cost::default());
            (normals, -extreme.w.dot(along))
        });
        let (normals, distance) = ways
            .filter(|(_, distance)| *distance < beyond)
            .max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (distance <= self.max_distance).then_some(Corrected {
            normals,
            least: Some(distance),
        })
    }

    /// Which shape's contacts other parts cover, in the caller's order, if those of one are covered. Contacts and
    /// normals are in the kernels' order.
    fn covered_shape(&self, contacts: &Contacts, [n1, n2]: [Vec3; 2]) -> Option<usize> {
        let [c1, c2] = self.order.to_kernel(self.constraints);
        let on_1 = contacts.iter().map(|contact| contact.on_1);
        let on_2 = contacts.iter().map(|contact| contact.on_2);
        let covered = self.order.to_caller([
            (c1.part()).is_some_and(|part| part.are_covered(self.cso.shape_1, on_1, n1)),
            (c2.part()).is_some_and(|part| part.are_covered(self.cso.shape_2, on_2, n2)),
        ]);
        covered.iter().position(|is_covered| *is_covered)
    }
}

/// The extent of a part along a direction, and how far a point is above its centre.
fn measure(part: &impl Support, point: DVec3, along: DVec3) -> [f64; 2] {
    let width = part.extent(along) + part.extent(-along);
    [width, along.dot(point - part.center())]
}
