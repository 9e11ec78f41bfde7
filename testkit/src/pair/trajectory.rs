//! A coherent trajectory of a pair.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Rotation, Vector};
use parry3d::query::QueryDispatcher;
use parry3d::shape::SharedShape;

pub const VERTICES: [usize; 5] = [10, 32, 100, 300, 1000];
pub const FRAMES: usize = 240;
/// Rapier's prediction distance where a unit is a metre.
pub const PREDICTION: f32 = 0.02;

/// Mean gap of the two hulls, whose radius is 1.
pub const GAPS: [(&str, f32); 4] = [
    ("separated", 1.0),
    ("touching", 0.0),
    ("shallow", -0.02),
    ("deep", -0.4),
];

/// Poses of the second hull in the frame of the first, each at its gap from it up to the swing.
pub fn trajectory(shapes: &[SharedShape; 2], gap: f32, speed: f32) -> Vec<Pose> {
    let direction = Vector::new(0.36, 0.48, 0.8);
    let axis = Vector::new(0.6, 0.0, 0.8);
    (0..FRAMES)
        .map(|frame| {
            let angle = speed * 0.5_f32.to_radians() * frame as f32;
            let rotation = Rotation::from_axis_angle(axis, angle);
            let swing = 0.002 * speed * (frame as f32 * 0.7).sin();
            // The distance along the line of centres at which this orientation touches.
            let far = Pose::from_parts(direction * 3.0, rotation);
            let apart = IsaGjkDispatcher::default()
                .cast_shapes(
                    &far,
                    -direction,
                    &*shapes[0],
                    &*shapes[1],
                    Default::default(),
                )
                .expect("hulls can be cast")
                .map_or(2.0, |hit| 3.0 - hit.time_of_impact);
            Pose::from_parts(direction * (apart + gap + swing), rotation)
        })
        .collect()
}
