//! A first tetrahedron with volume inside the Minkowski difference.

use glam::DVec3;

use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, Support};
use crate::tolerance::DEGENERATE;
use crate::tuning::GOOD_SEED;

/// Four points that span a volume: of `seeds` if these do, and support points otherwise.
pub(super) fn tetrahedron<A: Support, B: Support>(
    cso: &Cso<'_, A, B>,
    seeds: &[CsoVertex],
    cost: &mut Cost,
) -> Option<[CsoVertex; 4]> {
    let search = SeedSearch {
        cso,
        seeds,
        size: cso.size(),
    };
    let first = match seeds.first() {
        Some(seed) => *seed,
        None => cso.support(DVec3::X, cso.start_vertices(DVec3::X), cost),
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| [axis, -axis]);
    let second = search.farthest(axes.as_flattened(), cost, |p| (p - first.w).length())?;

    let along = (second.w - first.w).normalize();
    let (u, v) = along.any_orthonormal_pair();
    let third = search.farthest(&[u, -u, v, -v], cost, |p| {
        (p - first.w).reject_from_normalized(along).length()
    })?;

    let normal = along.cross(third.w - first.w).try_normalize()?;
    let fourth = search.farthest(&[normal, -normal], cost, |p| normal.dot(p - first.w).abs())?;
    Some([first, second, third, fourth])
}

struct SeedSearch<'a, 's, A, B> {
    cso: &'a Cso<'s, A, B>,
    seeds: &'a [CsoVertex],
    size: f64,
}

impl<A: Support, B: Support> SeedSearch<'_, '_, A, B> {
    /// The point with the largest `measure`, unless that is degenerate.
    fn farthest(
        &self,
        directions: &[DVec3],
        cost: &mut Cost,
        measure: impl Fn(DVec3) -> f64,
    ) -> Option<CsoVertex> {
        let mut best = None;
        let mut largest = DEGENERATE * self.size;
        let mut consider = |candidate: CsoVertex| {
            let m = measure(candidate.w);
            if m > largest {
                largest = m;
                best = Some(candidate);
            }
            m > GOOD_SEED * self.size
        };
        let mut good = false;
        for seed in self.seeds {
            good |= consider(*seed);
        }
        for &direction in directions {
            if good {
                break;
            }
            let start = self.cso.start_vertices(direction);
            good = consider(self.cso.support(direction, start, cost));
        }
        best
    }
}
