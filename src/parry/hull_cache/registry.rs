//! Prepared hulls of plain polyhedra, shared between threads and equal polyhedra.
//!
//! Each thread of a pool meets every hull sooner or later. In a loaded world each collider has its own shape,
//! and worlds that are simulated side by side have equal shapes. One prepared hull serves all of them: it is
//! prepared once, and is in the processor's caches once.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use glam::Vec3;
use parry3d::shape::ConvexPolyhedron;

use crate::hull::Hull;
use crate::hull::build::identity::{Diagonals, fingerprint, same_points};
use crate::hull::build::polyhedron::hull_and_diagonals;
use crate::parry::hull_cache::digest::Digest;
use crate::parry::int_hash::IntMap;

/// The prepared hull of a polyhedron. [`matches`](Self::matches) verifies whether it belongs to a given one.
#[derive(Debug)]
pub(crate) struct PreparedHull {
    /// `None` if no hull can be built: such a shape is left to parry.
    hull: Option<Hull>,
    source: PointIdentity,
    diagonals: Diagonals,
    /// The fingerprint of the polyhedron.
    key: u64,
    /// What it takes as it is prepared, without what a few hulls need later.
    bytes: usize,
}

/// How the points from which it was built are recognised.
#[derive(Debug)]
enum PointIdentity {
    /// Many points, by a digest.
    Digest(Box<Digest>),
    /// They are the points of the hull.
    Hull,
    Points(Box<[Vec3]>),
}

impl PointIdentity {
    fn heap_bytes(&self) -> usize {
        match self {
            Self::Points(points) => size_of_val(&**points),
            Self::Digest(_) => size_of::<Digest>(),
            Self::Hull => 0,
        }
    }
}

impl PreparedHull {
    /// The prepared hull of another polyhedron with the same points and edges, if one is in use; otherwise a
    /// new one.
    pub fn get_or_build(polyhedron: &ConvexPolyhedron) -> Arc<Self> {
        let key = fingerprint(polyhedron);
        let known = HullRegistry::with(|registry| registry.find(key));
        if let Some(known) = known.filter(|known| known.matches(polyhedron)) {
            return known;
        }
        // Other threads do not wait until it is built. If several build the same, the first one wins.
        let new = Arc::new(Self::new(key, polyhedron));
        match HullRegistry::with(|registry| registry.find_or_add(&new)) {
            Some(known) if known.matches(polyhedron) => known,
            // Another polyhedron with the same fingerprint. Only one of them is shared.
            Some(_) => {
                HullRegistry::with(|registry| registry.replace(&new));
                new
            }
            None => new,
        }
    }

    fn new(key: u64, polyhedron: &ConvexPolyhedron) -> Self {
        let points = polyhedron.points();
        let (hull, diagonals) = hull_and_diagonals(polyhedron);
        let hull = hull.ok();
        let own = hull.as_ref().map(Hull::points);
        let source = match Digest::of(points) {
            Some(digest) => PointIdentity::Digest(digest.into()),
            None if own.is_some_and(|own| same_points(own, points)) => PointIdentity::Hull,
            None => PointIdentity::Points(points.into()),
        };
        let bytes = size_of::<Self>()
            + hull.as_ref().map_or(0, Hull::heap_bytes)
            + source.heap_bytes()
            + diagonals.heap_bytes();
        Self {
            hull,
            source,
            diagonals,
            key,
            bytes,
        }
    }

    /// Whether it was made from this polyhedron; for many points, up to the error probability of [`Digest`].
    // perf: asked twice in each pair of hulls, most of which are proved apart in a thousand instructions.
    #[inline(always)]
    pub fn matches(&self, polyhedron: &ConvexPolyhedron) -> bool {
        self.has_points(polyhedron.points()) && self.diagonals.are_of(polyhedron)
    }

    // perf: as above.
    #[inline(always)]
    fn has_points(&self, points: &[Vec3]) -> bool {
        match &self.source {
            PointIdentity::Digest(digest) => digest.matches(points),
            PointIdentity::Hull => {
                (self.hull.as_ref()).is_some_and(|own| same_points(own.points(), points))
            }
            PointIdentity::Points(source) => same_points(source, points),
        }
    }

    /// Equal polyhedra have equal fingerprints; others seldom do.
    pub fn key(&self) -> u64 {
        self.key
    }

    #[inline]
    pub fn hull(&self) -> Option<&Hull> {
        self.hull.as_ref()
    }

    #[inline]
    pub fn bytes(&self) -> usize {
        self.bytes
    }
}

/// The registry forgets what nobody uses.
impl Drop for PreparedHull {
    fn drop(&mut self) {
        HullRegistry::with(|registry| registry.forget(self.key));
    }
}

/// Prepared hulls in use by any thread, by fingerprint; of several with the same one, the latest. A thread looks a
/// polyhedron up here only on first use.
struct HullRegistry(IntMap<u64, Weak<PreparedHull>>);

/// The registry gives memory back when fewer than one of so many places are in use.
const SPARSE: usize = 16;

static REGISTRY: Mutex<HullRegistry> = Mutex::new(HullRegistry(HashMap::with_hasher(
    BuildHasherDefault::new(),
)));

impl HullRegistry {
    /// No hull may be dropped meanwhile, since that asks for the registry again.
    fn with<T>(work: impl FnOnce(&mut Self) -> T) -> T {
        // A panic elsewhere leaves this in a consistent state.
        work(&mut REGISTRY.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn find(&self, key: u64) -> Option<Arc<PreparedHull>> {
        self.0.get(&key)?.upgrade()
    }

    /// Adds a hull, unless there is one with its fingerprint, which is returned.
    fn find_or_add(&mut self, new: &Arc<PreparedHull>) -> Option<Arc<PreparedHull>> {
        let known = self.find(new.key);
        if known.is_none() {
            self.replace(new);
        }
        known
    }

    fn replace(&mut self, new: &Arc<PreparedHull>) {
        self.0.insert(new.key, Arc::downgrade(new));
    }

    /// Forgets the hull with this fingerprint if nobody uses it.
    fn forget(&mut self, key: u64) {
        let Self(hulls) = self;
        if hulls.get(&key).is_some_and(|hull| hull.strong_count() == 0) {
            hulls.remove(&key);
            if hulls.len() < hulls.capacity() / SPARSE {
                hulls.shrink_to(2 * hulls.len());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    /// A square pyramid, over either diagonal of its base.
    fn pyramid(height: f32, other_diagonal: bool) -> ConvexPolyhedron {
        let base = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        let mut points: Vec<Vec3> = base.map(|[x, z]| Vec3::new(x, 0.0, z)).into();
        points.push(Vec3::new(0.0, height, 0.0));
        let mut triangles = vec![[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]];
        triangles.extend(if other_diagonal {
            [[0, 1, 3], [1, 2, 3]]
        } else {
            [[0, 1, 2], [0, 2, 3]]
        });
        ConvexPolyhedron::from_convex_mesh(points, &triangles).expect("parry takes it")
    }

    #[test]
    fn equal_polyhedra_share_what_is_prepared() {
        let here = PreparedHull::get_or_build(&pyramid(1.0, false));
        assert!(here.hull().is_some());
        let there = thread::spawn(|| PreparedHull::get_or_build(&pyramid(1.0, false)));
        let there = there.join().expect("no panic");
        assert!(Arc::ptr_eq(&here, &there));
        let higher = PreparedHull::get_or_build(&pyramid(1.5, false));
        assert!(!Arc::ptr_eq(&here, &higher));
        assert!(higher.matches(&pyramid(1.5, false)));
    }

    /// We choose the diagonals of flat sides, so any others lead to the same hull.
    #[test]
    fn the_diagonals_of_flat_sides_do_not_matter() {
        let [one, other] =
            [false, true].map(|diagonal| PreparedHull::get_or_build(&pyramid(1.0, diagonal)));
        assert!(one.matches(&pyramid(1.0, false)) && one.matches(&pyramid(1.0, true)));
        let [one, other] = [one, other].map(|prepared| format!("{:?}", prepared.hull()));
        assert_eq!(one, other);
    }

    /// With a vertex inside a flat side, the ids of features depend on the edges.
    #[test]
    fn other_edges_are_another_polyhedron() {
        let [one, other] = [false, true].map(|cut| PreparedHull::get_or_build(&six_sided(cut)));
        assert!(one.hull().is_some() && other.hull().is_some());
        assert!(one.matches(&six_sided(false)) && !one.matches(&six_sided(true)));
        assert!(other.matches(&six_sided(true)) && !other.matches(&six_sided(false)));
        // They have one fingerprint, by which the latest is found.
        let again = [true, false].map(|cut| PreparedHull::get_or_build(&six_sided(cut)));
        assert!(Arc::ptr_eq(&other, &again[0]) && again[1].matches(&six_sided(false)));
    }

    /// A pyramid with a vertex inside its base, which has edges to all corners, or to all but one.
    fn six_sided(cut: bool) -> ConvexPolyhedron {
        let corner = |i: u32| {
            let (sin, cos) = (i as f32 * std::f32::consts::FRAC_PI_3).sin_cos();
            Vec3::new(cos, 0.0, sin)
        };
        let mut points: Vec<Vec3> = (0..6).map(corner).collect();
        points.extend([Vec3::ZERO, Vec3::Y]);
        let mut triangles: Vec<[u32; 3]> = (0..6).map(|i| [i, 7, (i + 1) % 6]).collect();
        if cut {
            triangles.extend([[0, 1, 2], [0, 2, 6]]);
            triangles.extend((2..6).map(|i| [i, (i + 1) % 6, 6]));
        } else {
            triangles.extend((0..6).map(|i| [i, (i + 1) % 6, 6]));
        }
        ConvexPolyhedron::from_convex_mesh(points, &triangles).expect("parry takes it")
    }

    #[test]
    fn that_there_is_no_hull_is_shared_as_well() {
        let [flat, again] = [(); 2].map(|()| PreparedHull::get_or_build(&pyramid(1e-9, false)));
        assert!(flat.hull().is_none());
        assert!(Arc::ptr_eq(&flat, &again));
    }

    #[test]
    fn what_nobody_uses_is_not_kept() {
        let used = PreparedHull::get_or_build(&pyramid(2.0, false));
        let is_known = |key| HullRegistry::with(|registry| registry.0.contains_key(&key));
        for i in 0..1000 {
            let hull = PreparedHull::get_or_build(&pyramid(3.0 + i as f32, false));
            let key = hull.key();
            assert!(is_known(key));
            drop(hull);
            assert!(!is_known(key), "number {i} is kept");
        }
        assert!(is_known(used.key()));
        assert!(Arc::ptr_eq(
            &used,
            &PreparedHull::get_or_build(&pyramid(2.0, false))
        ));
    }
}
