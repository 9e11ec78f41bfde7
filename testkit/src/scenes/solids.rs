//! Bodies of chosen kinds: hulls, and all that is not one.

use std::str::FromStr;

use oorandom::Rand32;
use rapier3d::prelude::*;

use super::{hulls, named};

/// The smallest body over the largest.
const SMALLEST: Real = 0.4;
/// Length of long bodies over their width.
const LONG: Real = 4.0;
/// Width of coins over their height.
const FLAT: Real = 5.0;
/// Points of a hull.
const POINTS: u32 = 12;

/// A kind of body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    Ball,
    Cuboid,
    RoundedCuboid,
    /// A capsule about as long as wide.
    Capsule,
    /// As high as wide, like cones.
    Cylinder,
    RoundedCylinder,
    /// A cylinder four times as long as wide.
    Log,
    /// A flat cylinder.
    Coin,
    Cone,
    /// A random one of twelve points.
    Hull,
}

impl Solid {
    pub const ALL: [Self; 10] = [
        Self::Ball,
        Self::Cuboid,
        Self::RoundedCuboid,
        Self::Capsule,
        Self::Cylinder,
        Self::RoundedCylinder,
        Self::Log,
        Self::Coin,
        Self::Cone,
        Self::Hull,
    ];

    /// The name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Cuboid => "cuboid",
            Self::RoundedCuboid => "rounded-cuboid",
            Self::Capsule => "capsule",
            Self::Cylinder => "cylinder",
            Self::RoundedCylinder => "rounded-cylinder",
            Self::Log => "log",
            Self::Coin => "coin",
            Self::Cone => "cone",
            Self::Hull => "hull",
        }
    }

    /// A body that reaches at most `half` from its centre along each axis.
    fn make(self, half: Real, random: &mut Rand32) -> Result<SharedShape, String> {
        let mut side = || half * (0.4 + 0.6 * random.rand_float());
        Ok(match self {
            Self::Ball => SharedShape::ball(half),
            Self::Cuboid => SharedShape::cuboid(side(), side(), half),
            Self::RoundedCuboid => {
                let border = 0.1 * half;
                let [x, y, z] = [side(), side(), half].map(|side| side - border);
                SharedShape::round_cuboid(x, y, z, border)
            }
            Self::Capsule => SharedShape::capsule_y(0.5 * half, 0.5 * half),
            Self::Cylinder => SharedShape::cylinder(half, half),
            Self::RoundedCylinder => {
                SharedShape::round_cylinder(0.9 * half, 0.9 * half, 0.1 * half)
            }
            Self::Log => SharedShape::cylinder(half, half / LONG),
            Self::Coin => SharedShape::cylinder(half / FLAT, half),
            Self::Cone => SharedShape::cone(half, half),
            Self::Hull => {
                let points = hulls::sphere_points(POINTS, half, random);
                hulls::hull(&points, "the points of a hull")?
            }
        })
    }
}

/// `count` bodies of these kinds in turn.
pub(super) fn make(
    solids: &[Solid],
    count: u32,
    random: &mut Rand32,
) -> Result<Vec<SharedShape>, String> {
    let kinds = solids.iter().cycle().take(count as usize);
    let bodies = kinds.map(|kind| {
        let share = SMALLEST + (1.0 - SMALLEST) * random.rand_float();
        kind.make(hulls::RADIUS * share, random)
    });
    bodies.collect()
}

impl FromStr for Solid {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        named(text, Self::ALL, Self::name)
    }
}
