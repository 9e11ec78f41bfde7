//! The round edge of cylinders and cones.

use glam::DVec3;

/// A circle about the y axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    pub radius: f64,
}

impl Rim {
    /// The extreme point of the disc at some `height`, and how far the disc reaches along the part of `dir`
    /// that is square to the axis. Along the axis the whole disc ties, and the point is its centre.
    #[inline]
    pub fn support(&self, dir: DVec3, height: f64) -> (DVec3, f64) {
        let length = length_across(dir);
        let point = if length > 0.0 {
            let (x, z) = (dir.x / length, dir.z / length);
            DVec3::new(self.radius * x, height, self.radius * z)
        } else {
            DVec3::new(0.0, height, 0.0)
        };
        (point, self.radius * length)
    }
}

/// The length of the part of a vector that is square to the y axis. Directions of any length keep their
/// direction.
#[inline]
fn length_across(dir: DVec3) -> f64 {
    let squared = dir.x * dir.x + dir.z * dir.z;
    // perf: `hypot` is a call, which took a seventh of an update. Squares of such sizes have all their digits.
    // The others are far smaller than any shape, so pairs of all sizes are answered alike.
    if (f64::MIN_POSITIVE / f64::EPSILON..=f64::MAX).contains(&squared) {
        squared.sqrt()
    } else {
        dir.x.hypot(dir.z)
    }
}
