//! The signed distance of two bodies, from below and from above.
//!
//! It is the largest separation that any unit normal shows. A branch and bound over all normals finds it:
//! the normals of a cell cannot show more than [`Cell::least_reach`] allows, and cells that cannot beat the
//! best normal so far are dropped.

use std::collections::BinaryHeap;

use glam::DVec3;

use super::body::{Body, Core};
use super::cell::{Cell, Extreme};
use crate::pose::ExactPose;

/// Of both sizes: bounds so near to each other end the search.
const GOAL: f64 = 1.0e-10;
/// A ring of equal depths takes many cells.
const MAX_CELLS: usize = 60_000;

/// The points of the first body minus those of the second, without their borders, in the frame of the first.
pub struct Difference<'a> {
    bodies: [&'a Body; 2],
    pose: ExactPose,
}

/// Bounds of a signed distance, borders included, and the normal that shows the lower one, from body 1 to
/// body 2 in the frame of body 1.
#[derive(Clone, Copy, Debug)]
pub struct SignedDistance {
    pub lower: f64,
    pub upper: f64,
    pub normal: DVec3,
}

impl<'a> Difference<'a> {
    pub fn new(bodies: [&'a Body; 2], pose: ExactPose) -> Self {
        Self { bodies, pose }
    }

    fn extreme(&self, direction: DVec3) -> Extreme {
        let in_2 = self.pose.rotation.inverse() * -direction;
        let [on_1, on_2] = [
            self.bodies[0].extreme(direction),
            self.bodies[1].extreme(in_2),
        ];
        let point = on_1 - self.pose.apply(on_2);
        Extreme { direction, point }
    }

    /// The separation that a unit normal shows, borders included. Only its own normal separates from a
    /// half-space; what f32 holds of it counts as the same.
    pub fn separation(&self, normal: DVec3) -> f64 {
        let normal = match self.plane() {
            Some(up) if up.distance(normal) < 1.0e-6 => up,
            Some(_) => return f64::NEG_INFINITY,
            None => normal,
        };
        -self.extreme(normal).reach() - self.borders()
    }

    /// The normal of a half-space, from body 1 to body 2.
    fn plane(&self) -> Option<DVec3> {
        match (&self.bodies[0].core, &self.bodies[1].core) {
            (Core::HalfSpace(up), _) => Some(*up),
            (_, Core::HalfSpace(up)) => Some(-(self.pose.rotation * *up)),
            _ => None,
        }
    }

    fn borders(&self) -> f64 {
        self.bodies[0].border + self.bodies[1].border
    }

    pub fn signed_distance(&self) -> SignedDistance {
        match self.plane() {
            Some(normal) => {
                let separation = self.separation(normal);
                SignedDistance {
                    lower: separation,
                    upper: separation,
                    normal,
                }
            }
            None => Search::new(self).run(),
        }
    }
}

struct Search<'a> {
    difference: &'a Difference<'a>,
    /// The direction along which the difference reaches least.
    best: Extreme,
    /// The distance of its nearest known point.
    nearest: f64,
    cells: BinaryHeap<Open>,
}

/// A cell that may hold a better normal.
struct Open {
    least_reach: f64,
    cell: Cell,
}

impl<'a> Search<'a> {
    fn new(difference: &'a Difference<'a>) -> Self {
        Self {
            difference,
            best: difference.extreme(DVec3::Y),
            nearest: f64::INFINITY,
            cells: BinaryHeap::new(),
        }
    }

    fn look(&mut self, direction: DVec3) -> Extreme {
        let extreme = self.difference.extreme(direction.normalize());
        if extreme.reach() < self.best.reach() {
            self.best = extreme;
        }
        extreme
    }

    fn open(&mut self, cell: Cell) {
        for guess in cell.guesses() {
            self.look(guess);
        }
        self.nearest = self.nearest.min(cell.nearest_point().length());
        let least_reach = cell.least_reach();
        if least_reach < self.best.reach() {
            self.cells.push(Open { least_reach, cell });
        }
    }

    fn run(mut self) -> SignedDistance {
        for face in octahedron() {
            let corners = face.map(|direction| self.look(direction));
            self.open(Cell(corners));
        }
        let size: f64 = self
            .difference
            .bodies
            .iter()
            .map(|body| body.diameter())
            .sum();
        let mut opened = 0;
        let upper = loop {
            let lower = -self.best.reach();
            let Some(Open { least_reach, cell }) = self.cells.pop() else {
                break lower;
            };
            let upper = self.nearest.min(-least_reach);
            if upper - lower <= GOAL * (size + lower.abs()) || opened >= MAX_CELLS {
                break upper;
            }
            opened += 4;
            for part in self.parts(&cell) {
                self.open(part);
            }
        };
        let borders = self.difference.borders();
        let lower = -self.best.reach();
        SignedDistance {
            lower: lower - borders,
            upper: upper.max(lower) - borders,
            normal: self.best.direction,
        }
    }

    /// The cell in four.
    fn parts(&mut self, cell: &Cell) -> [Cell; 4] {
        let [a, b, c] = cell.0;
        let [ab, bc, ca] =
            [[a, b], [b, c], [c, a]].map(|[from, to]| self.look(from.direction + to.direction));
        [
            Cell([a, ab, ca]),
            Cell([ab, b, bc]),
            Cell([ca, bc, c]),
            Cell([ab, bc, ca]),
        ]
    }
}

/// Its faces turn counter-clockwise.
fn octahedron() -> impl Iterator<Item = [DVec3; 3]> {
    (0..8).map(|i| {
        let sign = |bit: usize| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let [x, y, z] = [DVec3::X * sign(0), DVec3::Y * sign(1), DVec3::Z * sign(2)];
        if sign(0) * sign(1) * sign(2) > 0.0 {
            [x, y, z]
        } else {
            [x, z, y]
        }
    })
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.least_reach.total_cmp(&self.least_reach)
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}
