//! Whether contacts that may stay as they are belong to the present shapes, which may have been exchanged or reshaped
//! since the contacts were chosen.
//!
//! Each shape is looked at in its own frame, along the stored normals: so while the shapes stay the same, the answer
//! does too, however they move. The [`StillCache`] notes for which shapes contacts were chosen, and for which they were
//! found to be right. This only saves time.
//!
//! [`StillCache`]: crate::parry::still_cache::StillCache

use glam::{DVec3, Vec3};
use parry3d::math::Pose;

use super::kernel_manifold::KernelManifold;
use crate::gjk::{self, Outcome};
use crate::mix::extended;
use crate::parry::convert::HalfSpace;
use crate::parry::still_cache::StillCache;
use crate::pose::RelativePose;
use crate::primitive::Point;
use crate::query::{LastContacts, fingerprint};
use crate::simd::LANES;
use crate::simplex::Preferred;
use crate::stats::Cost;
use crate::support::{Cso, ShapeId, Support};
use crate::tolerance::STILL_TILT;
use crate::tuning::{OWN_HEIGHT, OWN_PLACE, OWN_ROUNDING};

/// The contacts of a pair on one of its shapes, in the frame of that shape.
pub(super) struct ContactsOnShape<'a> {
    pub points: &'a [DVec3; LANES],
    pub normal: DVec3,
    pub border_radius: f64,
    /// The radius of the smaller shape of the pair.
    pub radius: f64,
}

impl ContactsOnShape<'_> {
    /// How far the points are beneath the plane that supports a shape along the normal; `None` if they do not all lie on
    /// or in the shape.
    pub fn depths(&self, shape: &impl Support) -> Option<[f64; LANES]> {
        let top = shape.extent(self.normal) + self.border_radius - rounding_of(shape);
        let are_near = are_near(shape, self.points, self.border_radius, self.radius);
        are_near.then(|| self.points.map(|p| top - self.normal.dot(p)))
    }

    /// The same for a half-space.
    pub fn depths_in(&self, half_space: &HalfSpace) -> Option<[f64; LANES]> {
        let is_same = self.normal.distance(half_space.normal) <= STILL_TILT;
        is_same.then(|| self.points.map(|p| half_space.normal.dot(p).abs()))
    }
}

/// Tells contacts of shapes from others, by the fingerprint of the contacts and the stored normal: a certificate of contacts
/// along another normal proves nothing.
#[inline]
pub(super) fn tag(shapes: [ShapeId; 2], fingerprint: u64, normal: Vec3) -> u64 {
    let [first, second] = shapes.map(ShapeId::number);
    let [x, y, z] = (normal.to_array()).map(|coordinate| u64::from(coordinate.to_bits()));
    let words = [first, second ^ x << 32, fingerprint, y << 32 | z];
    words.into_iter().fold(0, extended)
}

/// The normals on the kernels' first shape before and after contacts are measured anew.
#[derive(Clone, Copy)]
pub(super) struct StoredNormals {
    pub before: Vec3,
    pub after: Vec3,
}

/// Whether contacts at these depths belong to a pair whose smaller shape has this radius: some contact is on the
/// supporting planes of both shapes.
pub(super) fn some_is_on_both([on_1, on_2]: [[f64; LANES]; 2], radius: f64) -> bool {
    let mut depths = on_1.iter().zip(&on_2);
    depths.any(|(a, b)| a + b <= OWN_HEIGHT * radius)
}

impl KernelManifold<'_, '_> {
    /// Notes that the contacts were chosen for the present shapes, which have these ids.
    #[inline]
    pub fn note_chosen(&self, shapes: [Option<ShapeId>; 2], cache: &mut StillCache) {
        if let [Some(first), Some(second)] = shapes
            && let Some(places) = self.manifold.points().places(self.order)
        {
            let tag = tag([first, second], fingerprint(places), self.stored_normal());
            cache.note_own(self.manifold.key(), tag);
        }
    }
}

/// What tells whether the contacts of a manifold, which moved with the shapes, belong to these.
pub(super) struct OwnCheck<'a> {
    pub cache: &'a mut StillCache,
    /// Of the manifold.
    pub key: u64,
}

impl OwnCheck<'_> {
    /// Whether all contacts lie on or in the shapes.
    #[inline]
    pub fn passes<A: Support, B: Support>(
        self,
        cso: &Cso<'_, A, B>,
        border_radii: [f64; 2],
        last: &LastContacts,
        normals: StoredNormals,
    ) -> bool {
        self.passes_if(ids(cso), last, normals, || {
            lie_on_both(cso, border_radii, last)
        })
    }

    /// Whether contacts with the fingerprint of these are known to belong to the shapes, or are `found` to do so. If so,
    /// this is noted.
    #[inline]
    pub fn passes_if(
        self,
        shapes: [Option<ShapeId>; 2],
        last: &LastContacts,
        normals: StoredNormals,
        found: impl FnOnce() -> bool,
    ) -> bool {
        let [Some(first), Some(second)] = shapes else {
            return found();
        };
        let tag = |normal| tag([first, second], last.fingerprint(), normal);
        let are_own = self.cache.are_own(self.key, tag(normals.before)) || found();
        if are_own {
            self.cache.note_own(self.key, tag(normals.after));
        }
        are_own
    }
}

/// The ids of both shapes.
#[inline]
pub(super) fn ids<A: Support, B: Support>(cso: &Cso<'_, A, B>) -> [Option<ShapeId>; 2] {
    [cso.shape_1.id(), cso.shape_2.id()]
}

#[inline(never)]
fn lie_on_both<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    [border_1, border_2]: [f64; 2],
    last: &LastContacts,
) -> bool {
    let ([on_1, on_2], radius) = (last.points(cso.pose), cso.min_radius());
    are_near(cso.shape_1, &on_1, border_1, radius) && are_near(cso.shape_2, &on_2, border_2, radius)
}

/// Whether points lie on or in a shape with a border. `radius` is that of the smaller shape of the pair.
pub(super) fn are_near(
    shape: &impl Support,
    points: &[DVec3; LANES],
    border_radius: f64,
    radius: f64,
) -> bool {
    let reach = border_radius + OWN_PLACE * radius + rounding_of(shape);
    let is_repeated = |i: usize| i > 0 && points[i] == points[i - 1];
    (0..LANES).all(|i| is_repeated(i) || is_near(shape, points[i], reach))
}

/// Whether points lie on the boundary of a half-space.
pub(super) fn are_on_plane(half_space: &HalfSpace, points: &[DVec3; LANES], radius: f64) -> bool {
    points.iter().all(|p| {
        let reach = OWN_PLACE * radius + OWN_ROUNDING * p.length();
        half_space.normal.dot(*p).abs() <= reach
    })
}

fn rounding_of(shape: &impl Support) -> f64 {
    OWN_ROUNDING * (shape.center().length() + shape.radius())
}

/// Whether a point is at most so far from a shape.
fn is_near(shape: &impl Support, p: DVec3, reach: f64) -> bool {
    let Some(pose) = RelativePose::new(&Pose::from_translation(p.as_vec3())) else {
        return false;
    };
    let cso = Cso {
        shape_1: shape,
        shape_2: &Point,
        pose: &pose,
    };
    let cost = &mut Cost::default();
    let toward = p - shape.center();
    let first = cso.support(toward, cso.start_vertices(toward), cost);
    match gjk::distance::<Preferred, _, _>(&cso, &[first], reach, cost) {
        Outcome::Separated(_) => false,
        Outcome::Disjoint(_) | Outcome::Unsure(_) | Outcome::Overlapping(_) => true,
    }
}
