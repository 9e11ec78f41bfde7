//! Linear time of impact by the GJK ray cast (van den Bergen, *Ray casting against general convex
//! objects with application to continuous collision detection*, 2004).
//!
//! Shape 2 moving by `x` touches shape 1 when `x` enters their Minkowski difference: the time of
//! impact is where the ray `x = time * velocity` hits it. GJK looks for the point of the
//! difference nearest to `x`, and whenever a support plane separates the two, `x` jumps along the
//! ray onto this plane. No jump can skip the shape, so the time is a *lower bound* throughout.
//!
//! A target distance moves every plane outwards by as much: the ray hits the difference rounded
//! by a ball. Round shapes are cast as their cores, with the sum of their radii added to it.

use glam::DVec3;

use crate::gjk::{Simplex, climb_start};
use crate::simplex::{DistanceSubalgorithm, Nearest};
use crate::stats::Cost;
use crate::support::{Cso, Support};
use crate::tolerance::RAY_TOUCHING;

/// A ray that grazes a smooth shape halves its distance in each iteration and takes forty. This limit only
/// guards against a stall that no other test detects.
const MAX_ITERATIONS: usize = 256;

/// The result of a ray cast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RayCast {
    /// There is no contact within the maximum time, or the input is not finite.
    Miss,
    /// The moving shape touches the other.
    Hit(Impact),
    /// The shapes overlap, or are within the target distance, from the beginning.
    Overlap,
}

/// The first contact of a moving shape; vectors in frame 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The time of impact: no earlier contact is possible, and at this time the shapes are within the target
    /// distance, up to [`RAY_TOUCHING`].
    pub time: f64,
    /// Unit direction from shape 1 to shape 2.
    pub normal: DVec3,
    /// The touching point of shape 1.
    pub on_1: DVec3,
    /// The touching point of shape 2, at the time of impact.
    pub on_2: DVec3,
}

/// Finds when shape 2, moving by `velocity` relative to shape 1 (in frame 1) without turning, first comes
/// within `target_distance` of shape 1. Neither `target_distance` nor `max_time` may be negative; `max_time`
/// may be infinite.
pub fn ray_cast<S: DistanceSubalgorithm, A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    velocity: DVec3,
    max_time: f64,
    target_distance: f64,
    cost: &mut Cost,
) -> RayCast {
    let start = cso.vertex_towards_origin(cost);
    let mut ray = Ray {
        velocity,
        target_distance,
        size: cso.size(),
        time: 0.0,
        separating: None,
    };
    let mut simplex = Simplex::default();
    simplex.push(start);
    let mut ids = start.ids;
    // The point of the simplex nearest to the point of the ray, relative to the latter.
    let mut nearest = simplex.nearest::<S>(ray.point());
    for iteration in 0..MAX_ITERATIONS {
        cost.iterations += 1;
        let toward = nearest.point;
        let norm = toward.length();
        if !norm.is_finite() {
            return RayCast::Miss;
        }
        if norm <= target_distance + ray.tolerance() {
            return ray.impact(&simplex, &nearest);
        }
        let vertex = cso.support(-toward, climb_start(cso, iteration, -toward, ids), cost);
        ids = vertex.ids;
        let advanced = match ray.advance(toward / norm, vertex.w) {
            Advance::Advanced if ray.time <= max_time => true,
            Advance::NoProgress => false,
            Advance::Advanced | Advance::Diverges => return RayCast::Miss,
        };
        let known = simplex.contains(&vertex);
        if !known {
            simplex.push(vertex);
        }
        let next = simplex.nearest::<S>(ray.point());
        // Without progress, the nearest point is as near as rounding allows, and no plane separates it: this
        // is the impact.
        if !advanced && (known || next.point.length_squared() >= norm * norm) {
            return ray.impact(&simplex, &nearest);
        }
        simplex.keep(next.face);
        nearest = next;
    }
    // A contact that is too early is better than none.
    cost.fallbacks += 1;
    ray.impact(&simplex, &nearest)
}

/// The point that moves along the ray.
struct Ray {
    velocity: DVec3,
    target_distance: f64,
    size: f64,
    time: f64,
    /// The last direction (unit, towards the difference) whose support plane moved the point.
    separating: Option<DVec3>,
}

/// How a support plane advances the point of the ray.
enum Advance {
    /// The plane separated, and the point is on it now.
    Advanced,
    /// The plane does not separate.
    NoProgress,
    /// The plane separates, and the ray never crosses it.
    Diverges,
}

impl Ray {
    fn point(&self) -> DVec3 {
        self.velocity * self.time
    }

    fn tolerance(&self) -> f64 {
        RAY_TOUCHING * (self.size + self.point().length())
    }

    /// Advances to the support plane through `vertex` with the inward normal `direction`.
    fn advance(&mut self, direction: DVec3, vertex: DVec3) -> Advance {
        let separation = direction.dot(vertex - self.point()) - self.target_distance;
        if separation <= 0.0 {
            return Advance::NoProgress;
        }
        let approach = direction.dot(self.velocity);
        let time = self.time + separation / approach;
        // This also holds for NaN, and for a plane so slanted that it is never reached.
        if !(approach > 0.0 && time.is_finite()) {
            return Advance::Diverges;
        }
        if time <= self.time {
            return Advance::NoProgress;
        }
        self.time = time;
        self.separating = Some(direction);
        Advance::Advanced
    }

    fn impact(&self, simplex: &Simplex, nearest: &Nearest) -> RayCast {
        let Some(separating) = self.separating else {
            return RayCast::Overlap;
        };
        // Across a gap the nearest points show the normal. Where they coincide they show
        // nothing, but the ray rests on the plane of the last jump.
        let direction = if self.target_distance > self.tolerance() {
            nearest.point.normalize_or(separating)
        } else {
            separating
        };
        let on_1 = simplex.on_1(nearest);
        RayCast::Hit(Impact {
            time: self.time,
            normal: -direction,
            on_1,
            on_2: on_1 - nearest.point,
        })
    }
}
