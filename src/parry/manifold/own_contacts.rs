//! Whether contacts that may stay as they are belong to the present shapes, which may have been exchanged or reshaped
//! since the contacts were chosen.
//!
//! Each shape is looked at in its own frame, along the stored normals: so while the shapes stay the same, the answer
//! does too, however they move. The [`StillCache`] notes for which shapes contacts were chosen, and for which they were
//! found to be right. This only saves time.
//!
//! [`StillCache`]: crate::parry::still_cache::StillCache

use glam::DVec3;
use parry3d::math::Pose;

use crate::gjk::{self, Outcome};
use crate::parry::convert::HalfSpace;
use crate::pose::RelativePose;
use crate::primitive::Point;
use crate::simd::LANES;
use crate::simplex::Preferred;
use crate::stats::Cost;
use crate::support::{Cso, Support};
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
        let rounding = OWN_ROUNDING * (shape.center().length() + shape.radius());
        let reach = self.border_radius + OWN_PLACE * self.radius + rounding;
        let top = shape.extent(self.normal) + self.border_radius - rounding;
        let are_near = self.points.iter().all(|&p| is_near(shape, p, reach));
        are_near.then(|| self.points.map(|p| top - self.normal.dot(p)))
    }

    /// The same for a half-space.
    pub fn depths_in(&self, half_space: &HalfSpace) -> Option<[f64; LANES]> {
        let is_same = self.normal.distance(half_space.normal) <= STILL_TILT;
        is_same.then(|| self.points.map(|p| half_space.normal.dot(p).abs()))
    }
}

/// Whether contacts at these depths belong to a pair whose smaller shape has this radius: some contact is on the
/// supporting planes of both shapes.
pub(super) fn some_is_on_both([on_1, on_2]: [[f64; LANES]; 2], radius: f64) -> bool {
    let mut depths = on_1.iter().zip(&on_2);
    depths.any(|(a, b)| a + b <= OWN_HEIGHT * radius)
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
