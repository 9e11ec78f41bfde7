//! Capsules and rounded polytopes with each other and with sharp ones, none of them a hull, against the oracle: signed
//! distances, normals, and the gap at each contact, without a past and with one, in either order.

use parry3d::math::{Real, Vector};
use testkit::curved::{Body, Meeting};
use testkit::generate::Rng;

use crate::tally::{GAPS, Tally};

/// The promise, as a share of the smaller diameter.
const PROMISE: f64 = 1e-5;

const BORDER: Real = 0.07;

fn cuboid(rng: &mut Rng, border: Real) -> Body {
    let half_extents = [(); 3].map(|()| rng.range(0.1, 0.8) as Real);
    Body::cuboid(Vector::from(half_extents), border)
}

pub fn triangle(rng: &mut Rng, border: Real) -> Body {
    let corners = [(); 3].map(|()| rng.direction().as_vec3() * 0.8);
    Body::triangle(corners, border)
}

pub fn capsule(rng: &mut Rng) -> Body {
    let ends = [(); 2].map(|()| rng.direction().as_vec3() * 0.6);
    Body::capsule(ends, 0.2)
}

/// Each of the rounded bodies meets each partner in all ways.
fn check(seed: u128, rounds: usize, partners: impl Fn(&mut Rng) -> Vec<Body>) {
    let mut rng = Rng::new(seed);
    let mut tally = Tally::new(|faults| faults.are_within(PROMISE));
    for _ in 0..rounds {
        let rounded = [cuboid(&mut rng, BORDER), triangle(&mut rng, BORDER)];
        for partner in partners(&mut rng) {
            for body in &rounded {
                tally.add(&mut rng, [&partner, body], &Meeting::ALL, &GAPS);
            }
        }
    }
    tally.check();
}

#[test]
fn rounded_polytopes_are_right() {
    check(341, 3, |rng| {
        vec![cuboid(rng, BORDER), triangle(rng, BORDER), capsule(rng)]
    });
}

#[test]
fn rounded_and_sharp_shapes_are_right() {
    check(342, 3, |rng| {
        vec![
            cuboid(rng, 0.0),
            triangle(rng, 0.0),
            Body::ball(0.25),
            Body::half_space(Vector::Y),
        ]
    });
}

#[test]
fn cuboids_on_triangles_are_right() {
    let mut rng = Rng::new(344);
    let mut tally = Tally::new(|faults| faults.are_within(PROMISE));
    for _ in 0..6 {
        let bodies = [&triangle(&mut rng, 0.0), &cuboid(&mut rng, 0.0)];
        tally.add(&mut rng, bodies, &Meeting::ALL, &GAPS);
    }
    tally.check();
}

#[test]
fn capsules_are_right() {
    let mut rng = Rng::new(343);
    let mut tally = Tally::new(|faults| faults.are_within(PROMISE));
    for _ in 0..3 {
        let capsule = capsule(&mut rng);
        for partner in [cuboid(&mut rng, 0.0), triangle(&mut rng, 0.0)] {
            tally.add(&mut rng, [&partner, &capsule], &Meeting::ALL, &GAPS);
        }
    }
    tally.check();
}
