//! Pairs of every kind: flat, sharp and round hulls, in poses at random or with features parallel.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DQuat, DVec3, Vec3};

use crate::cases::Hull;
use crate::generate::{Rng, hull_of};

const WEDGE: [[i8; 3]; 6] = [
    [-1, 0, 0],
    [1, 0, 0],
    [-1, 1, 1],
    [1, 1, 1],
    [-1, 1, -1],
    [1, 1, -1],
];
const TENT: [[i8; 3]; 4] = [[-1, 0, 0], [1, 0, 0], [0, 1, 1], [0, 1, -1]];
const BLADE: [[i8; 3]; 4] = [[-1, 0, 0], [1, 0, 0], [1, 1, 1], [1, 1, -1]];
const BOX: [[i8; 3]; 8] = [
    [-1, -1, -1],
    [1, -1, -1],
    [-1, 1, -1],
    [1, 1, -1],
    [-1, -1, 1],
    [1, -1, 1],
    [-1, 1, 1],
    [1, 1, 1],
];

impl Rng {
    /// A wedge, blade, needle, tetrahedron, box, prism or round hull of about this size, perhaps very
    /// thin.
    pub fn any_hull(&mut self, size: f64) -> Hull {
        loop {
            let thin = 10_f64.powf(self.range(-2.5, 0.0));
            let breadth = self.range(0.3, 1.0);
            let (points, extents) = match self.count(0, 6) {
                0 => (of(&WEDGE), [1.0, breadth, thin]),
                1 => (of(&TENT), [1.0, breadth, thin]),
                2 => (of(&BLADE), [1.0, breadth, thin]),
                3 => (of(&BLADE), [1.0, thin, thin]),
                4 => (of(&BOX), [1.0, breadth, thin]),
                5 => (prism(self.count(3, 12)), [1.0, 1.0, thin]),
                _ => {
                    let corners = self.count(4, 40);
                    return self.hull(corners, size);
                }
            };
            let is_turned = self.count(0, 1) == 0;
            let turn = if is_turned {
                self.rotation()
            } else {
                DQuat::IDENTITY
            };
            let half = 0.5 * size * DVec3::from(extents);
            let points: Vec<Vec3> = points
                .iter()
                .map(|p| (turn * (half * *p)).as_vec3())
                .collect();
            if let Some(hull) = hull_of(&points) {
                return hull;
            }
        }
    }

    /// A turn that leaves edges parallel to faces in two cases of three, if the hulls were not turned.
    pub fn any_turn(&mut self) -> DQuat {
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][self.count(0, 2)];
        let quarters = DQuat::from_axis_angle(axis, self.count(0, 3) as f64 * FRAC_PI_2);
        match self.count(0, 2) {
            0 => self.rotation(),
            1 => quarters,
            _ => DQuat::from_rotation_y(self.range(-1.0, 1.0)) * quarters,
        }
    }

    /// A place no farther than `reach`; on a grid in one case of two.
    pub fn any_place(&mut self, reach: f64) -> DVec3 {
        let place = self.direction() * self.range(0.0, 1.0);
        let is_on_grid = self.count(0, 1) == 0;
        let place = if is_on_grid {
            (place * 8.0).round() / 8.0
        } else {
            place
        };
        place * reach
    }
}

fn of(corners: &[[i8; 3]]) -> Vec<DVec3> {
    corners
        .iter()
        .map(|corner| DVec3::from(corner.map(f64::from)))
        .collect()
}

/// Along z.
fn prism(sides: usize) -> Vec<DVec3> {
    (0..sides)
        .flat_map(|i| {
            let (sin, cos) = (TAU * i as f64 / sides as f64).sin_cos();
            [-1.0, 1.0].map(|z| DVec3::new(cos, sin, z))
        })
        .collect()
}
