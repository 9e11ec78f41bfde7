//! The pairs and their trajectories.

use parry3d::math::{Pose, Vector};
use parry3d::shape::SharedShape;
use testkit::pair::{self, GAPS};
use testkit::scenes::hulls;

/// Two hulls, and where the second one is in the frame of the first, from update to update.
pub struct Case {
    pub name: String,
    pub shapes: [SharedShape; 2],
    pub poses: Vec<Pose>,
}

/// Small hulls as users have them: random ones, boxes and prisms; apart, touching and deep.
pub fn all() -> impl Iterator<Item = Case> {
    pairs().flat_map(|(what, shapes)| {
        GAPS.map(|(gap, metres)| Case {
            name: format!("{what}: {gap}"),
            poses: pair::trajectory(&shapes, metres, 1.0),
            shapes: shapes.clone(),
        })
    })
}

fn pairs() -> impl Iterator<Item = (String, [SharedShape; 2])> {
    let random = [8, 16, 32, 44].map(|vertices| {
        let shapes = [pair::hull(vertices, 1), pair::hull(vertices, 2)];
        (format!("{vertices} random vertices"), shapes)
    });
    let boxes = [Vector::new(0.6, 0.5, 0.7), Vector::new(0.8, 0.4, 0.5)]
        .map(|half| hulls::cuboid(half).expect("a solid"));
    let prisms = [12, 32].map(|sides| {
        let shapes =
            [0.5, 0.7].map(|half_height| hulls::prism(sides, 1.0, half_height).expect("a solid"));
        (format!("prisms of {sides} sides"), shapes)
    });
    let boxes = ("boxes".to_owned(), boxes);
    random.into_iter().chain([boxes]).chain(prisms)
}
