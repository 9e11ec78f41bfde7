//! A GJK that is watched: which vertices leave the simplex, whether they return, and what another
//! choice of direction would do.

use std::collections::HashSet;

use glam::DVec3;
use isa_gjk::internals::simplex::{DistanceSubalgorithm, Voronoi};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Cso, CsoVertex, Support};
use isa_gjk::internals::tolerance::{GJK_GAP_OF_DISTANCE, GJK_GAP_OF_SIZE, MIN_DIRECTED_DISTANCE};

/// How the next support direction is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// From the nearest point to the origin.
    Gilbert,
    /// With momentum (Montaut et al., *Collision detection accelerated: an optimization
    /// perspective*, 2022), until the gap closes; then as Gilbert, to prove it.
    Nesterov,
}

/// Observations of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Observation {
    pub distance: f64,
    pub iterations: u32,
    /// Support points that had been dropped from the simplex before.
    pub returned: u32,
    /// Ended by the bound instead of by the certificate.
    pub unfinished: bool,
}

/// As `isa_gjk::internals::gjk::distance`, which does not let itself be watched. `WATCH`: keep the books of
/// discarded vertices, which costs time.
pub fn run<const WATCH: bool, A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    start: CsoVertex,
    direction: Direction,
) -> Observation {
    const MOST: u32 = 1000;
    let cost = &mut Cost::default();
    let size = cso.size();
    let mut seen = Observation::default();
    let mut discarded = HashSet::new();
    let mut simplex = vec![start];
    let (mut x, mut last, mut d) = (start.w, start, start.w);
    let mut accelerated = direction == Direction::Nesterov;
    while seen.iterations < MOST {
        seen.distance = x.length();
        if seen.distance <= MIN_DIRECTED_DISTANCE * size {
            return seen;
        }
        d = if accelerated {
            momentum(d, x, last.w, seen.iterations)
        } else {
            x
        };
        seen.iterations += 1;
        last = cso.support(-d, last.ids, cost);
        let gap = seen.distance - x.dot(last.w) / seen.distance;
        let closed = gap <= GJK_GAP_OF_DISTANCE * seen.distance || gap <= GJK_GAP_OF_SIZE * size;
        if closed || simplex.iter().any(|v| v.w == last.w) {
            if accelerated {
                accelerated = false;
                continue;
            }
            return seen;
        }
        seen.returned += u32::from(WATCH && discarded.contains(&last.ids));
        let mut grown = simplex.clone();
        grown.push(last);
        let points: Vec<DVec3> = grown.iter().map(|v| v.w).collect();
        let nearest = Voronoi::nearest(&points);
        if nearest.point.length_squared() >= x.length_squared() {
            if accelerated {
                accelerated = false;
                continue;
            }
            return seen;
        }
        x = nearest.point;
        simplex.clear();
        for (i, vertex) in grown.iter().enumerate() {
            if nearest.face >> i & 1 == 1 {
                simplex.push(*vertex);
            } else if WATCH {
                discarded.insert(vertex.ids);
            }
        }
    }
    seen.unfinished = true;
    seen
}

/// The direction of the last step, averaged with where this one would go.
fn momentum(d: DVec3, x: DVec3, s: DVec3, k: u32) -> DVec3 {
    let keep = f64::from(k + 1) / f64::from(k + 3);
    let y = x * keep + s * (1.0 - keep);
    (d * keep).normalize_or_zero() * keep + y.normalize_or_zero() * (1.0 - keep)
}
