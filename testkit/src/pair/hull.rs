//! Random hulls.

use parry3d::math::Vector;
use parry3d::shape::SharedShape;

/// A hull of points on the unit sphere.
pub fn hull(vertices: usize, seed: u128) -> SharedShape {
    let mut random = oorandom::Rand32::new(seed as u64);
    let points: Vec<Vector> = (0..vertices)
        .map(|_| {
            loop {
                let p = Vector::new(
                    random.rand_float() * 2.0 - 1.0,
                    random.rand_float() * 2.0 - 1.0,
                    random.rand_float() * 2.0 - 1.0,
                );
                if (0.1..1.0).contains(&p.length()) {
                    return p.normalize();
                }
            }
        })
        .collect();
    SharedShape::convex_hull(&points).expect("random points have volume")
}
