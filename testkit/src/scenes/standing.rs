//! Scenes that show how contacts hold: what stands, falls in a row, spins and rolls.

use std::f32::consts::PI;

use rapier3d::prelude::*;

use super::containers;
use super::filler::{Filler, GAP, square_cell};

/// Half extents of a brick, in metres, before it is scaled.
pub(super) const BRICK: Vector = Vector::new(0.4, 0.15, 0.2);
/// Half extents of a domino, in metres, before it is scaled.
pub(super) const DOMINO: Vector = Vector::new(0.05, 0.5, 0.25);
/// Radians per second at which prisms turn about their axes.
const SLOW: Real = 0.5;
/// Radians per second about the axis of a coin on its rim, which leans by [`LEAN`] radians.
const FAST: Real = 12.0;
const LEAN: Real = 0.6;
/// Radians per second of the first domino, if it is a metre high.
const PUSH: Vector = Vector::new(0.0, 0.0, -2.0);
const DOMINO_ROW: usize = 64;
/// Radius of the ball that is thrown at a wall, in lengths of a brick.
const BALL: Real = 1.0;
/// It is as heavy as stone where bricks are as heavy as wood.
const BALL_DENSITY: Real = 4.0;
/// Metres per second of a ball for bricks of a metre.
const THROW: Real = 20.0;
/// Stands for the friction of rolling.
const ROLLING_DAMPING: Real = 1.0;
/// Metres per second at which hulls roll.
const ROLL: Real = 2.0;

impl Filler<'_> {
    /// Layers of bricks, each a brick shorter than that beneath it and shifted by half a brick.
    pub(super) fn wall(&mut self) {
        let brick = self.half_extents();
        let width = 2.0 * brick.x + GAP;
        let mut in_layer = (1..).find(|n| n * (n + 1) / 2 >= self.bodies).unwrap_or(1);
        containers::floor(self.world, width * in_layer as Real);
        let (mut place, mut y) = (0, brick.y + GAP);
        for i in 0..self.bodies {
            if place == in_layer {
                (in_layer, place, y) = (in_layer - 1, 0, y + 2.0 * brick.y + GAP);
            }
            let x = (place as Real - 0.5 * (in_layer - 1) as Real) * width;
            self.insert(i, Pose::translation(x, y, 0.0));
            place += 1;
        }
    }

    /// Layers of equal length, each shifted by half a brick, and a ball on its way to the middle.
    pub(super) fn breach(&mut self) {
        let brick = self.half_extents();
        let width = 2.0 * brick.x + GAP;
        let height = 2.0 * brick.y + GAP;
        let side = (self.bodies as Real).sqrt().ceil() as usize;
        let half_width = 0.75 * width * side as Real;
        containers::floor(self.world, half_width + containers::WALL);
        containers::walls(self.world, half_width, half_width);
        for i in 0..self.bodies {
            let layer = i / side;
            let shift = if layer.is_multiple_of(2) { 0.25 } else { -0.25 };
            let x = ((i % side) as Real - 0.5 * (side - 1) as Real + shift) * width;
            let y = brick.y + GAP + layer as Real * height;
            self.insert(i, Pose::translation(x, y, 0.0));
        }
        let radius = BALL * 2.0 * brick.x;
        let middle = 0.5 * height * (self.bodies / side) as Real;
        let aside = self.within(radius);
        let start = Vector::new(aside, middle.max(radius), 4.0 * radius);
        let ball = RigidBodyBuilder::dynamic()
            .translation(start)
            .linvel(Vector::Z * (-THROW * (2.0 * brick.x).sqrt()))
            .angular_damping(ROLLING_DAMPING)
            .can_sleep(self.can_sleep);
        let collider = ColliderBuilder::ball(radius).density(BALL_DENSITY);
        self.world.physics.insert(ball, collider);
    }

    fn half_extents(&self) -> Vector {
        self.shape(0).compute_local_aabb().half_extents()
    }

    /// Rows. The first domino of each is pushed.
    pub(super) fn dominoes(&mut self) {
        let domino = self.half_extents();
        let spacing = domino.y;
        let in_row = self.bodies.min(DOMINO_ROW);
        let rows = self.bodies.div_ceil(in_row);
        let half_length = spacing * in_row as Real / 2.0;
        let aisle = 4.0 * domino.z;
        let half_width = aisle * rows as Real / 2.0;
        containers::floor(self.world, half_length.max(half_width) + 2.0 * domino.y);
        for i in 0..self.bodies {
            let shake = self.within(0.05 * spacing);
            let x = spacing * (i % in_row) as Real - half_length + shake;
            let z = aisle * ((i / in_row) as Real + 0.5) - half_width;
            let (body, _) = self.insert(i, Pose::translation(x, domino.y + GAP, z));
            if i.is_multiple_of(in_row) {
                let push = PUSH / (2.0 * domino.y).sqrt();
                self.world.physics.bodies[body].set_angvel(push, true);
            }
        }
    }

    /// Prisms that turn about their axes without friction.
    pub(super) fn spinning(&mut self) -> Result<(), String> {
        let side = (self.bodies as Real).sqrt().ceil() as usize;
        let spacing = 3.0 * self.reach;
        containers::hull_floor(self.world, spacing * side as Real)?;
        for i in 0..self.bodies {
            let half_height = self.shape(i).compute_local_aabb().half_extents().y;
            let (x, z) = square_cell(i, side, spacing);
            let turn = Rotation::from_rotation_y(self.within(PI));
            let (body, collider) = self.insert(
                i,
                Pose::from_parts(Vector::new(x, half_height + GAP, z), turn),
            );
            let collider = &mut self.world.physics.colliders[collider];
            collider.set_friction(0.0);
            collider.set_friction_combine_rule(CoefficientCombineRule::Min);
            self.world.physics.bodies[body].set_angvel(Vector::Y * SLOW, true);
        }
        Ok(())
    }

    /// Coins that lean on their rims and turn about the vertical, as a spun coin does before it
    /// lies down.
    pub(super) fn tops(&mut self) {
        let side = (self.bodies as Real).sqrt().ceil() as usize;
        let spacing = 8.0 * self.reach;
        containers::floor(self.world, spacing * side as Real);
        for i in 0..self.bodies {
            let half = self.shape(i).compute_local_aabb().half_extents();
            let (x, z) = square_cell(i, side, spacing);
            let lean = Rotation::from_rotation_y(self.within(PI)) * Rotation::from_rotation_x(LEAN);
            let height = half.x * LEAN.sin() + half.y * LEAN.cos() + GAP;
            let (body, _) = self.insert(i, Pose::from_parts(Vector::new(x, height, z), lean));
            self.world.physics.bodies[body].set_angvel(Vector::Y * FAST, true);
        }
    }

    /// Hulls that roll along lanes of their own.
    pub(super) fn rolling(&mut self) {
        let spacing = 2.5 * self.reach;
        let half_width = 0.5 * spacing * self.bodies as Real + 20.0;
        containers::floor(self.world, half_width);
        for i in 0..self.bodies {
            let z = spacing * (i as Real - 0.5 * self.bodies as Real);
            let pose = self.tumbled(Vector::new(0.0, 1.1 * self.reach, z));
            let (body, _) = self.insert(i, pose);
            let body = &mut self.world.physics.bodies[body];
            body.set_linvel(Vector::X * ROLL, true);
            body.set_angvel(Vector::Z * (-ROLL / self.reach), true);
        }
    }
}
