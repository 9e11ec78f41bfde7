//! The normal that suits an edge or a ruled side, and separates most: a search on the circle of all that suit it.

use glam::DVec3;

use super::body::{Body, Ruling};
use super::curvature::Curvature;
use super::piece::across;
use super::stationary::{Effort, MAX_NEWTON_STEPS, NormalSeparation};
use crate::stats::Cost;
use crate::support::Cso;
use crate::tolerance::SETTLED_ANGLE;
use crate::tuning::{FIRST_STEP, LONGEST_STEP};

/// Steps of such a search. Each is a support pair.
const MAX_STEPS: usize = 16;

/// The circle of unit vectors with one sine to an axis.
#[derive(Clone, Copy)]
struct NormalCircle {
    center: DVec3,
    u: DVec3,
    v: DVec3,
}

impl NormalCircle {
    /// The first one is nearest to `about`.
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

    /// The circle with another first one, turned by nearly an angle that is small.
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

    /// A normal, and the direction in which it turns.
    fn at(&self, angle: f64) -> [DVec3; 2] {
        let (sin, cos) = angle.sin_cos();
        [
            self.center + self.u * cos + self.v * sin,
            self.v * cos - self.u * sin,
        ]
    }
}

/// The greatest separation along the normals that suit a ruling: where its slope, which the extreme
/// vertices show, vanishes.
pub(super) fn along_ruling<A: Body, B: Body>(
    cso: &Cso<'_, A, B>,
    ruling: &Ruling,
    at: &NormalSeparation,
    effort: Effort,
    cost: &mut Cost,
) -> Option<NormalSeparation> {
    let circle = NormalCircle::new(ruling, at.normal);
    let best = NormalSeparation::along(cso, circle.center + circle.u, &at.extreme, cost);
    let slope = -circle.v.dot(best.extreme.w);
    if slope == 0.0 {
        return Some(best);
    }
    let mut search = CircleSearch {
        cso,
        circle,
        best,
        steps_left: MAX_STEPS,
        cost,
    };
    if let Some(found) = search.by_newton(best) {
        return Some(found);
    }
    if effort == Effort::Near {
        return None;
    }
    let bracket = search.bracket([0.0, slope])?;
    search.close(bracket);
    Some(search.best)
}

/// An angle on a circle of normals, and the slope of the separation there.
type AngleAndSlope = [f64; 2];

/// A search for the greatest separation on a circle of normals.
struct CircleSearch<'a, 'c, A, B> {
    cso: &'a Cso<'c, A, B>,
    circle: NormalCircle,
    best: NormalSeparation,
    steps_left: usize,
    cost: &'a mut Cost,
}

impl<A: Body, B: Body> CircleSearch<'_, '_, A, B> {
    fn look(&mut self, angle: f64) -> AngleAndSlope {
        self.steps_left = self.steps_left.saturating_sub(1);
        let [normal, turn] = self.circle.at(angle);
        let near = self.best.extreme;
        let found = NormalSeparation::along(self.cso, normal, &near, self.cost);
        self.best = self.best.or(found);
        [angle, -turn.dot(found.extreme.w)]
    }

    /// Newton's method, as long as its steps are small and the extreme point moves smoothly.
    fn by_newton(&mut self, mut found: NormalSeparation) -> Option<NormalSeparation> {
        let mut circle = self.circle;
        for _ in 0..MAX_NEWTON_STEPS {
            let NormalCircle { center, u, v } = circle;
            let w = found.extreme.w;
            let slope = -v.dot(w);
            let fall = Curvature::of(self.cso, &found)?.between(v, v) - u.dot(w);
            let step = slope / fall;
            if !(fall > 0.0 && step.abs() < LONGEST_STEP) {
                return None;
            }
            if step.abs() < SETTLED_ANGLE {
                return Some(found);
            }
            circle = circle.turned(step);
            let normal = center + circle.u;
            found = NormalSeparation::along(self.cso, normal, &found.extreme, self.cost);
        }
        None
    }

    /// Two angles between which the slope changes its sign.
    fn bracket(&mut self, mut from: AngleAndSlope) -> Option<[AngleAndSlope; 2]> {
        let mut step = FIRST_STEP.copysign(from[1]);
        while self.steps_left > 0 && from[0].abs() < std::f64::consts::PI {
            let to = self.look(from[0] + step);
            if to[1] * from[1] <= 0.0 {
                return Some([from, to]);
            }
            // Where the slope would vanish if it went on falling so, but not much farther than before.
            let ahead = step * to[1] / (from[1] - to[1]);
            let farther = step * 4.0;
            step = if ahead / step > 0.0 && ahead.abs() < farther.abs() {
                ahead * 1.2
            } else {
                farther
            };
            from = to;
        }
        None
    }

    /// Closes a bracket by the Illinois variant of regula falsi (Dowell, Jarratt, BIT 11, 1971).
    fn close(&mut self, [mut low, mut high]: [AngleAndSlope; 2]) {
        while self.steps_left > 0 && (high[0] - low[0]).abs() > SETTLED_ANGLE && high[1] != 0.0 {
            let between = high[0] - high[1] * (high[0] - low[0]) / (high[1] - low[1]);
            let found = self.look(between);
            if (between - high[0]).abs() < SETTLED_ANGLE {
                return;
            }
            if found[1] * high[1] < 0.0 {
                low = high;
            } else {
                low[1] *= 0.5;
            }
            high = found;
        }
    }
}
