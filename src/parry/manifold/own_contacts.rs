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
use crate::mix::{extended, mix};
use crate::parry::convert::HalfSpace;
use crate::parry::still_cache::StillCache;
use crate::pose::RelativePose;
use crate::primitive::Point;
use crate::query::{LastContacts, NORMAL_WEIGHTS, fingerprint};
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

/// Contacts of two shapes. With their normal, a number tells them from others.
#[derive(Clone, Copy)]
pub(super) struct ContactTag {
    /// Tells the shapes from others.
    shapes: u64,
    /// Tells the places from others.
    fingerprint: f64,
}

impl ContactTag {
    #[inline]
    pub fn new(shapes: [ShapeId; 2], fingerprint: f64) -> Self {
        let [first, second] = shapes.map(ShapeId::number);
        Self {
            shapes: extended(mix(first), second),
            fingerprint,
        }
    }

    /// With a stored normal: a certificate of contacts along another one proves nothing.
    #[inline]
    pub fn along(self, normal: Vec3) -> u64 {
        let both = self.fingerprint + normal.as_dvec3().dot(NORMAL_WEIGHTS);
        self.shapes ^ both.to_bits()
    }
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
            let tag = ContactTag::new([first, second], fingerprint(places));
            *cache.own_contacts(self.manifold.key()) = tag.along(self.stored_normal());
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
        let tag = ContactTag::new([first, second], last.fingerprint());
        let known = self.cache.own_contacts(self.key);
        let are_own = *known == tag.along(normals.before) || found();
        if are_own {
            *known = tag.along(normals.after);
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
