//! Flat sides as they are scanned.

use oorandom::Rand32;
use parry3d::math::{Real, Vector};

/// A box of 1 by 0.4 by 1 with so many more points on its lower side, all within `noise` of a plane.
/// They are places of a grid, so that some of them are in line along the rim.
pub fn noisy_box(count: u32, noise: Real, rng: &mut Rand32) -> Vec<Vector> {
    let mut points: Vec<Vector> = (0..8)
        .map(|i| {
            let sign = |bit: u32| if i & bit == 0 { -0.5 } else { 0.5 };
            let y = if i & 2 == 0 { noise - 0.2 } else { 0.2 };
            Vector::new(sign(1), y, sign(4))
        })
        .collect();
    points.extend((0..count).map(|_| {
        let [x, z] = [(); 2].map(|()| rng.rand_range(0..51) as Real / 50.0 - 0.5);
        Vector::new(x, noise * rng.rand_float() - 0.2, z)
    }));
    points
}
