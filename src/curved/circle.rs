//! The normal with the greatest separation that satisfies a ruling: a search on the circle of all normals
//! that do.

use glam::DVec3;

use super::curvature::Curvature;
use super::piece::across;
use super::separation::NormalSeparation;
use super::surface_pieces::{Ruling, SurfacePieces};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex};
use crate::tolerance::SETTLED_ANGLE;
use crate::tuning::{LONGEST_STEP, MAX_NEWTON_STEPS};

/// The circle of the unit vectors that satisfy a ruling.
#[derive(Clone, Copy)]
struct NormalCircle {
    center: DVec3,
    u: DVec3,
    v: DVec3,
}

impl NormalCircle {
    /// The circle starts at the normal nearest to `about`.
    fn new(ruling: &Ruling, about: DVec3) -> Self {
        let beside = across(about, ruling.axis);
        let across = beside.unwrap_or_else(|| ruling.axis.any_orthonormal_vector());
        let radius = (1.0 - ruling.sine * ruling.sine).sqrt();
        let u = across * radius;
        Self {
            center: ruling.axis * ruling.sine,
            u,
            v: ruling.axis.cross(u),
        }
    }

    /// The same circle, with its start turned by a small angle (up to third order).
    fn turned(&self, angle: f64) -> Self {
        let tangent = 0.5 * angle;
        let scale = 1.0 / (1.0 + tangent * tangent);
        let (cos, sin) = ((1.0 - tangent * tangent) * scale, 2.0 * tangent * scale);
        Self {
            center: self.center,
            u: self.u * cos + self.v * sin,
            v: self.v * cos - self.u * sin,
        }
    }

    /// The normal at the start.
    fn normal(&self) -> DVec3 {
        self.center + self.u
    }
}

/// The greatest separation along normals that satisfy a ruling, close to the normal `about` and its extreme
/// vertex `near`. The extreme vertex gives the slope of the separation, and Newton's method finds where it
/// vanishes. `None` if a step is too long or the extreme point does not move smoothly.
pub(super) fn along_ruling<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    ruling: &Ruling,
    (about, near): (DVec3, &CsoVertex),
    cost: &mut Cost,
) -> Option<NormalSeparation> {
    let mut circle = NormalCircle::new(ruling, about);
    let mut found = NormalSeparation::along(cso, circle.normal(), near, cost);
    for _ in 0..MAX_NEWTON_STEPS {
        let NormalCircle { u, v, .. } = circle;
        let w = found.extreme.w;
        let slope = -v.dot(w);
        if slope == 0.0 {
            return Some(found);
        }
        let fall = Curvature::of(cso, &found)?.between(v, v) - u.dot(w);
        let step = slope / fall;
        if !(fall > 0.0 && step.abs() < LONGEST_STEP) {
            return None;
        }
        if step.abs() < SETTLED_ANGLE {
            return Some(found);
        }
        circle = circle.turned(step);
        found = NormalSeparation::along(cso, circle.normal(), &found.extreme, cost);
    }
    None
}
