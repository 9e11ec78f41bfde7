//! The pairs and their trajectories.

use parry3d::math::{Pose, Vector};
use parry3d::shape::SharedShape;
use testkit::pair::{self, GAPS};
use testkit::scenes::hulls;

/// Two hulls, and where the second one is in the frame of the first, from update to update.
pub struct Case {
    /// What hulls they are.
    pub hulls: String,
    /// How they lie.
    pub gap: &'static str,
    pub shapes: [SharedShape; 2],
    pub poses: Vec<Pose>,
}

/// The sizes of random hulls.
pub const VERTICES: [usize; 6] = [8, 16, 32, 44, 64, 128];
/// The sides of prisms that lie on each other; those of four are boxes.
const RESTING_SIDES: [u32; 6] = [3, 4, 6, 12, 32, 64];

/// Hulls as users have them: random ones, boxes and prisms; apart, touching, deep, and prisms at rest.
pub fn all() -> impl Iterator<Item = Case> {
    moving().flat_map(in_all_gaps).chain(at_rest())
}

/// What the column of hulls says of random ones.
pub fn random(vertices: usize) -> String {
    format!("{vertices} random vertices")
}

fn in_all_gaps((hulls, shapes): (String, [SharedShape; 2])) -> impl Iterator<Item = Case> {
    GAPS.into_iter().map(move |(gap, metres)| Case {
        hulls: hulls.clone(),
        gap,
        poses: pair::trajectory(&shapes, metres, 1.0),
        shapes: shapes.clone(),
    })
}

fn moving() -> impl Iterator<Item = (String, [SharedShape; 2])> {
    let hulls = VERTICES.map(|vertices| {
        let shapes = [pair::hull(vertices, 1), pair::hull(vertices, 2)];
        (random(vertices), shapes)
    });
    let boxes = [Vector::new(0.6, 0.5, 0.7), Vector::new(0.8, 0.4, 0.5)]
        .map(|half| hulls::cuboid(half).expect("a solid"));
    let upright = [12, 32].map(|sides| {
        let shapes =
            [0.5, 0.7].map(|half_height| hulls::prism(sides, 1.0, half_height).expect("a solid"));
        (prisms(sides), shapes)
    });
    let boxes = ("boxes".to_owned(), boxes);
    hulls.into_iter().chain([boxes]).chain(upright)
}

fn at_rest() -> impl Iterator<Item = Case> {
    RESTING_SIDES.into_iter().map(|sides| {
        let (shapes, poses) = pair::resting(sides, pair::REST);
        Case {
            hulls: prisms(sides),
            gap: "resting",
            shapes,
            poses,
        }
    })
}

fn prisms(sides: u32) -> String {
    format!("prisms of {sides} sides")
}
