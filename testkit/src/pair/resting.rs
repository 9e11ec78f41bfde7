//! Bodies that lie still on another one.

use parry3d::math::{Pose, Rotation, Vector};
use parry3d::shape::SharedShape;

use super::FRAMES;
use crate::scenes::hulls;

/// What bodies at rest tremble by: a thousandth of a millimetre.
pub const REST: f32 = 1e-6;
/// What shaken bodies tremble by, in metres and radians.
pub const SHAKEN: f32 = 2e-5;

/// Two prisms with so many sides, and poses of the second in the frame of the first: it lies on it, 2 mm deep, and
/// trembles.
pub fn resting(sides: u32, tremble: f32) -> ([SharedShape; 2], Vec<Pose>) {
    let shapes =
        [0.5, 0.4].map(|height| hulls::prism(sides, hulls::RADIUS, height).expect("a prism"));
    (shapes, trembling(0.898, tremble))
}

/// Poses of a body so high above the middle of another one, a little turned and shifted. It trembles by so many metres
/// and radians.
pub fn trembling(height: f32, tremble: f32) -> Vec<Pose> {
    let pose = |frame: usize| {
        let [a, b] = [0.7, 1.1].map(|rate| tremble * (rate * frame as f32).sin());
        let turn = Rotation::from_scaled_axis(Vector::new(a, 0.3, b));
        Pose::from_parts(Vector::new(0.1 + b, height + a, 0.05), turn)
    };
    (0..FRAMES).map(pose).collect()
}
