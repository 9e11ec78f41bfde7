//! Grippers that hold one object each between two fingers.

use std::f32::consts::TAU;

use rapier3d::prelude::*;

use super::filler::{Filler, GAP, square_cell};
use super::{Scene, containers, hulls};

/// Half extents of a finger, in reaches of the largest object; fingers move along x.
const FINGER: Vector = Vector::new(0.2, 0.8, 0.6);
/// How high the hands are above the floor, and how far apart, in the same unit.
const HEIGHT: Real = 4.0;
const SPACING: Real = 6.0;
/// Metres per second at which fingers close.
const CLOSING: Real = 0.5;
/// What a finger presses with, in weights of the object.
const GRIP: Real = 4.0;
/// How strictly the motor keeps its speed, in weights of the object per metre and second.
const DAMPING: Real = 1000.0;
/// Of the rubber on the fingers.
const PAD_FRICTION: Real = 1.5;
/// How far hands are shaken, in metres, and how often in a second.
const SHAKE: Vector = Vector::new(0.003, 0.005, 0.002);
const SHAKE_HZ: Real = 3.0;

/// Hands that are shaken, and where each was at the start.
pub(super) type Shaken = Vec<(RigidBodyHandle, Vector)>;

/// Moves hands to where they are after a time.
pub(super) fn shake(hands: &Shaken, bodies: &mut RigidBodySet, time: Real) {
    let offset = SHAKE * (TAU * SHAKE_HZ * time).sin();
    for &(hand, place) in hands {
        bodies[hand].set_next_kinematic_translation(place + offset);
    }
}

impl Filler<'_> {
    /// Hands above the floor, and an object between the fingers of each.
    pub(super) fn grippers(&mut self, scene: Scene) -> Result<(), String> {
        let finger = hulls::cuboid(FINGER * self.reach)?;
        let side = (self.bodies as Real).sqrt().ceil() as usize;
        let spacing = SPACING * self.reach;
        containers::floor(self.world, spacing * side as Real);
        let mut shaken = Vec::new();
        for i in 0..self.bodies {
            let (x, z) = square_cell(i, side, spacing);
            let place = Vector::new(x, HEIGHT * self.reach, z);
            let pose = self.tumbled(place);
            let (object, _) = self.insert(i, pose);
            let sides = self.shape(i).compute_aabb(&pose);
            let hand = self.hand(place, object, [sides.mins.x, sides.maxs.x], &finger);
            if scene == Scene::ShakenGrippers {
                shaken.push((hand, place));
            }
        }
        self.world.shake(shaken);
        Ok(())
    }

    /// A hand around an object.
    fn hand(
        &mut self,
        place: Vector,
        object: RigidBodyHandle,
        sides: [Real; 2],
        finger: &SharedShape,
    ) -> RigidBodyHandle {
        let physics = &mut self.world.physics;
        let weight = physics.bodies[object].mass() * physics.gravity.length();
        let hand = RigidBodyBuilder::kinematic_position_based().translation(place);
        let hand = physics.insert_body(hand);
        for (away, side) in [-1.0, 1.0].into_iter().zip(sides) {
            let open = Vector::X * (side - place.x + away * (FINGER.x * self.reach + GAP));
            let body = RigidBodyBuilder::dynamic()
                .translation(place + open)
                .can_sleep(self.can_sleep);
            let pad = ColliderBuilder::new(finger.clone()).friction(PAD_FRICTION);
            let (body, _) = physics.insert(body, pad);
            let slide = PrismaticJointBuilder::new(Vector::X)
                .local_anchor1(open)
                .motor_model(MotorModel::ForceBased)
                .motor_velocity(-away * CLOSING, DAMPING * weight)
                .motor_max_force(GRIP * weight);
            physics.insert_impulse_joint(hand, body, slide);
        }
        hand
    }
}
