//! A support point that GJK dropped from its simplex can come back: five points suffice.

use glam::DVec3;
use isa_gjk::internals::simplex::{DistanceSubalgorithm, Johnson, SignedVolumes, Voronoi};

/// Found, and followed step by step, in rational arithmetic: no rounding brings the vertex back.
const POINTS: [[f64; 3]; 5] = [
    [-5.0, -5.0, 3.0],
    [0.0, 0.0, 3.0],
    [-2.0, 4.0, 6.0],
    [2.0, 4.0, 3.0],
    [-5.0, 0.0, 2.0],
];

/// The support points that GJK finds, starting from the first point, until it finds `count`.
fn supports<S: DistanceSubalgorithm>(count: usize) -> Vec<usize> {
    let points = POINTS.map(DVec3::from_array);
    let mut simplex = vec![0];
    let mut v = points[0];
    let mut found = Vec::new();
    for _ in 0..count {
        let heights = points.map(|p| v.dot(p));
        let next = (0..points.len())
            .min_by(|&a, &b| heights[a].total_cmp(&heights[b]))
            .expect("there are points");
        assert!(heights[next] < v.length_squared() - 1.0e-3, "converged");
        found.push(next);
        assert!(!simplex.contains(&next), "not a step");
        simplex.push(next);
        let corners: Vec<DVec3> = simplex.iter().map(|&i| points[i]).collect();
        let nearest = S::nearest(&corners);
        assert!(nearest.point.length() < v.length() - 1.0e-6, "no progress");
        v = nearest.point;
        let mut bits = (0..4).map(|i| nearest.face >> i & 1 == 1);
        simplex.retain(|_| bits.next().expect("at most four corners"));
    }
    found
}

#[test]
fn a_dropped_support_point_comes_back() {
    // Every support point that is found was not in the simplex: the second 3 was dropped before.
    for found in [
        supports::<Voronoi>(4),
        supports::<Johnson>(4),
        supports::<SignedVolumes>(4),
    ] {
        assert_eq!(found, [3, 1, 4, 3]);
    }
}
