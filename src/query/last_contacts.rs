//! The contacts of the previous frame, at the present poses.

use glam::DVec3;

use crate::pose::RelativePose;
use crate::simd::{DVec3x4, LANES, f64x4, sum};

/// Four contacts in frame 1. If there were fewer, some are repeated.
#[derive(Clone, Copy)]
pub(crate) struct LastContacts {
    /// The points on shape 1.
    on_1: DVec3x4,
    /// The vectors from there to the points on shape 2.
    between: DVec3x4,
}

impl LastContacts {
    /// Takes the points on each shape in its own frame.
    #[inline(always)]
    pub fn new(on_1: DVec3x4, on_2: DVec3x4, pose: &RelativePose) -> Self {
        Self {
            on_1,
            between: pose.points_to_1(on_2) - on_1,
        }
    }

    /// The distances along a normal.
    #[inline(always)]
    pub fn distances(&self, normal: DVec3) -> f64x4 {
        self.between.dot(normal)
    }

    /// Whether the two points of each contact are at most `drift` apart, perpendicular to a normal.
    #[inline(always)]
    pub fn are_within(&self, normal: DVec3, drift: f64) -> bool {
        let distances = self.distances(normal);
        let squared = self.between.length_squared() - distances * distances;
        // A drift that is NaN counts as too far.
        squared.simd_le(f64x4::splat(drift * drift)).all()
    }

    /// The contact that is deepest along a normal.
    #[inline]
    pub fn deepest(&self, normal: DVec3) -> usize {
        first_least(self.distances(normal).to_array())
    }

    /// The points of the contact that is deepest along a normal, on shape 1 and on shape 2.
    pub fn deepest_points(&self, normal: DVec3) -> [DVec3; 2] {
        let lane = self.deepest(normal);
        let of = |points: DVec3x4| DVec3::from(points.0.map(|row| row.to_array()[lane]));
        let on_1 = of(self.on_1);
        [on_1, on_1 + of(self.between)]
    }

    /// The least distance along a normal.
    #[inline]
    pub fn least(&self, normal: DVec3) -> f64 {
        let distances = self.distances(normal).to_array();
        distances[first_least(distances)]
    }

    /// The points on both shapes, each in the frame of its shape.
    pub fn points(&self, pose: &RelativePose) -> [[DVec3; LANES]; 2] {
        let on_2 = pose.points_to_2(self.on_1 + self.between);
        [self.on_1, on_2].map(|points| {
            let [x, y, z] = points.0.map(|coordinate| coordinate.to_array());
            std::array::from_fn(|i| DVec3::new(x[i], y[i], z[i]))
        })
    }

    /// Tells these points on shape 1 from others.
    #[inline]
    pub fn fingerprint(&self) -> f64 {
        fingerprint(self.on_1)
    }

    /// The mean of the points on shape 1.
    #[inline]
    pub fn middle(&self) -> DVec3 {
        self.on_1.sum() / LANES as f64
    }

    /// A mean of the points on shape 1 in which the deepest contacts along a normal, up to `tie`, have most
    /// of the weight.
    pub fn middle_of_deepest(&self, normal: DVec3, tie: f64) -> DVec3 {
        let distances = self.distances(normal);
        let array = distances.to_array();
        let above = distances - array[first_least(array)];
        let weights = f64x4::splat(1.0) / (above + tie);
        (self.on_1 * weights).sum() / sum(weights)
    }
}

/// A number that tells four points from others: a weighted sum of their coordinates. If one coordinate differs by a
/// rounding of f32, so does the sum, if no other one is 2^28 times as large.
#[inline]
pub(crate) fn fingerprint(points: DVec3x4) -> f64 {
    sum(points.dot_each(DVec3x4(WEIGHTS.map(f64x4::new))))
}

/// Square roots of primes: no two coordinates have weights in a simple ratio.
const WEIGHTS: [[f64; LANES]; 3] = [
    [1.732_050_8, 2.236_068_0, 2.645_751_3, 3.316_624_8],
    [3.605_551_3, 4.123_105_6, 4.358_898_9, 4.795_831_5],
    [5.385_164_8, 5.567_764_4, 6.082_762_5, 6.403_124_2],
];

/// The weights of a normal in such a sum.
pub(crate) const NORMAL_WEIGHTS: DVec3 = DVec3::new(6.557_438_5, 6.855_654_6, 7.280_109_9);

/// The index of the least value; of equal ones, the first.
#[inline]
pub(crate) fn first_least(values: [f64; LANES]) -> usize {
    let mut least = 0;
    for lane in 1..LANES {
        if values[lane] < values[least] {
            least = lane;
        }
    }
    least
}
