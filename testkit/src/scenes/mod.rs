//! Deterministic worlds to compare dispatchers on; the same parameters give the same world.

mod build;
mod containers;
mod curved;
mod families;
mod figures;
mod filler;
mod flat;
mod gripping;
pub mod hulls;
mod renewal;
mod solids;
mod standing;
mod world;

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use isa_gjk::IsaGjkDispatcher;
use rapier3d::prelude::{Real, SharedShape};

pub use containers::Ground;
pub use curved::CurvedScene;
pub use figures::{Figure, Watched};
use renewal::Renewal;
pub use solids::Solid;
pub use world::World;

/// What happens in a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// Hulls tumbling in a closed drum that turns about its horizontal axis.
    Drum,
    /// Hulls dropped between four walls.
    Pile,
    /// Towers of prisms or of flat real hulls, eight high.
    Stack,
    /// Towers of thin coins, sixteen high.
    Coins,
    /// A brick wall.
    Wall,
    /// Rows of up to 64 dominoes, the first of which falls.
    Dominoes,
    /// Prisms turning slowly about their axes on a hull.
    Spin,
    /// Coins spun on their rims.
    Top,
    /// Hulls rolling over a floor.
    Rolling,
    /// A large floor of resting hulls, nearly all asleep, and a few that bounce.
    Asleep,
    /// A pile of cuboids: no hull at all.
    Cuboids,
    /// A pile of balls: no hull at all.
    Balls,
    /// A pile of balls, cuboids, capsules, cylinders, cones and hulls.
    Mixed,
    /// A pile of bodies of chosen kinds, in several sizes.
    Solids,
    /// A pile of bodies made of two hulls each.
    Compound,
    /// Hulls dropped on a bumpy triangle mesh.
    Trimesh,
    /// Hulls dropped on a bumpy height field.
    Heightfield,
    /// A pile of hulls of 8 to 20 vertices, as large as a hand.
    Rocks,
    /// The same, flattened, or with a large flat face.
    Stones,
    /// A pile of dice of 4 to 20 sides, as large as a hand.
    Dice,
    /// A pile of rocks of 5 cm.
    Pebbles,
    /// A pile of cubes as hulls.
    Cubes,
    /// A pile of plates a hundredth as thick as wide.
    Plates,
    /// A pile of rods a hundredth as thick as long.
    Needles,
    /// A pile of prisms four times as long as wide.
    Pencils,
    /// A pile of rings, each taken apart into as many wedges as it has sides.
    Rings,
    /// A brick wall that a ball is thrown at.
    Breach,
    /// Hulls dropped on a heap of boxes that is one compound.
    Rubble,
    /// Hulls held between two fingers each.
    Grippers,
    /// The same, while the hands are shaken.
    ShakenGrippers,
    /// A pile in which every body gets a new hull before each step.
    Reshaped,
    /// A pile in which bodies with new hulls replace the oldest third every half a second.
    Bursts,
}

impl Scene {
    /// Every scene.
    pub const ALL: [Self; 32] = [
        Self::Drum,
        Self::Pile,
        Self::Stack,
        Self::Coins,
        Self::Wall,
        Self::Dominoes,
        Self::Spin,
        Self::Top,
        Self::Rolling,
        Self::Asleep,
        Self::Cuboids,
        Self::Balls,
        Self::Mixed,
        Self::Solids,
        Self::Compound,
        Self::Trimesh,
        Self::Heightfield,
        Self::Rocks,
        Self::Stones,
        Self::Dice,
        Self::Pebbles,
        Self::Cubes,
        Self::Plates,
        Self::Needles,
        Self::Pencils,
        Self::Rings,
        Self::Breach,
        Self::Rubble,
        Self::Grippers,
        Self::ShakenGrippers,
        Self::Reshaped,
        Self::Bursts,
    ];

    /// The name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Drum => "drum",
            Self::Pile => "pile",
            Self::Stack => "stack",
            Self::Coins => "coins",
            Self::Wall => "wall",
            Self::Dominoes => "dominoes",
            Self::Spin => "spin",
            Self::Top => "top",
            Self::Rolling => "rolling",
            Self::Asleep => "asleep",
            Self::Cuboids => "cuboids",
            Self::Balls => "balls",
            Self::Mixed => "mixed",
            Self::Solids => "solids",
            Self::Compound => "compound",
            Self::Trimesh => "trimesh",
            Self::Heightfield => "heightfield",
            Self::Rocks => "rocks",
            Self::Stones => "stones",
            Self::Dice => "dice",
            Self::Pebbles => "pebbles",
            Self::Cubes => "cubes",
            Self::Plates => "plates",
            Self::Needles => "needles",
            Self::Pencils => "pencils",
            Self::Rings => "rings",
            Self::Breach => "breach",
            Self::Rubble => "rubble",
            Self::Grippers => "grippers",
            Self::ShakenGrippers => "shaken-grippers",
            Self::Reshaped => "reshaped",
            Self::Bursts => "bursts",
        }
    }

    /// A number of bodies that keeps a frame within a few tens of milliseconds.
    pub const fn default_bodies(self) -> u32 {
        match self {
            Self::Drum | Self::Mixed => 512,
            Self::Pile | Self::Breach => 400,
            Self::Solids => 150,
            Self::Rocks
            | Self::Stones
            | Self::Dice
            | Self::Pebbles
            | Self::Cubes
            | Self::Plates
            | Self::Needles
            | Self::Pencils
            | Self::Rubble
            | Self::Bursts => 300,
            Self::Reshaped => 100,
            Self::Rings => 32,
            Self::Spin | Self::Top => 16,
            Self::Dominoes | Self::Rolling | Self::Grippers | Self::ShakenGrippers => 64,
            Self::Stack | Self::Wall => 128,
            Self::Coins | Self::Compound | Self::Trimesh | Self::Heightfield => 256,
            Self::Asleep | Self::Cuboids | Self::Balls => 1000,
        }
    }

    /// A few seconds. What comes to rest in a heap is not watched for long when it lies still: then
    /// rapier recycles the contacts of either dispatcher, and nothing is left to compare.
    pub const fn default_frames(self) -> u32 {
        match self {
            Self::Pile | Self::Compound | Self::Trimesh | Self::Heightfield => 240,
            _ => 480,
        }
    }

    /// The largest extent of a body in metres, of scenes that scale their shapes.
    pub const fn default_size(self) -> Option<f32> {
        match self {
            Self::Solids
            | Self::Rocks
            | Self::Stones
            | Self::Dice
            | Self::Pencils
            | Self::Rubble => Some(0.12),
            Self::Pebbles => Some(0.05),
            Self::Cubes | Self::Grippers | Self::ShakenGrippers => Some(0.1),
            Self::Plates | Self::Needles | Self::Rings => Some(0.4),
            Self::Breach => Some(0.25),
            Self::Bursts => Some(0.2),
            _ => None,
        }
    }

    /// Which hulls the scene can be filled with.
    pub const fn hulls(self) -> Hulls {
        match self {
            Self::Cuboids | Self::Balls | Self::Solids => Hulls::None,
            Self::Rocks
            | Self::Stones
            | Self::Dice
            | Self::Pebbles
            | Self::Cubes
            | Self::Plates
            | Self::Needles => Hulls::Own,
            Self::Stack => Hulls::Upright,
            Self::Coins | Self::Spin | Self::Top | Self::Pencils | Self::Rings => Hulls::Prisms,
            Self::Wall | Self::Dominoes | Self::Breach => Hulls::Boxes,
            Self::Drum
            | Self::Pile
            | Self::Rolling
            | Self::Asleep
            | Self::Mixed
            | Self::Compound
            | Self::Trimesh
            | Self::Heightfield
            | Self::Rubble
            | Self::Grippers
            | Self::ShakenGrippers
            | Self::Reshaped
            | Self::Bursts => Hulls::Any,
        }
    }

    /// Whether hulls come into being while it runs.
    pub const fn renews(self) -> bool {
        matches!(self, Self::Reshaped | Self::Bursts)
    }

    /// Whether its bodies are to stay upright.
    pub const fn stands(self) -> bool {
        matches!(self, Self::Stack | Self::Coins | Self::Wall | Self::Spin)
    }
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Scene {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        named(text, Self::ALL, Self::name)
    }
}

/// The one of `all` with this name.
fn named<T: Copy, const N: usize>(
    text: &str,
    all: [T; N],
    name: fn(T) -> &'static str,
) -> Result<T, String> {
    let found = all.into_iter().find(|&one| name(one) == text);
    found.ok_or_else(|| format!("choose one of {}", all.map(name).join(", ")))
}

/// Which hulls a scene can be filled with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hulls {
    /// It has none.
    None,
    /// Prisms only.
    Prisms,
    /// Prisms, or those of the real hulls that are flat below and above.
    Upright,
    /// Boxes of its own.
    Boxes,
    /// A family of its own.
    Own,
    /// From any source.
    Any,
}

/// Where the hulls of a scene come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HullSource {
    /// Points drawn uniformly on a sphere, each of them a vertex.
    Random {
        /// Vertices of each hull.
        vertices: u32,
    },
    /// Upright prisms over regular polygons.
    Prism {
        /// Sides of the polygon.
        sides: u32,
    },
    /// Boxes of eight vertices.
    Box,
    /// The scene's own family.
    Own,
    /// Hulls of objects that robots handle, from the test data of this crate.
    Real,
    /// The hull of the vertices of one Wavefront file.
    File(PathBuf),
}

impl fmt::Display for HullSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Random { vertices } => write!(f, "random hulls of {vertices} vertices"),
            Self::Prism { sides } => write!(f, "prisms of {sides} sides"),
            Self::Box => f.write_str("boxes as hulls"),
            Self::Own => f.write_str("hulls of its own"),
            Self::Real => f.write_str("hulls of real objects"),
            Self::File(path) => write!(f, "hull of {}", path.display()),
        }
    }
}

/// Everything a scene is built from.
#[derive(Clone, Debug)]
pub struct SceneParams {
    /// Where the hulls come from.
    pub hulls: HullSource,
    /// How many different hulls to make or to take, if the source has that many.
    pub distinct: u32,
    /// Dynamic bodies.
    pub bodies: u32,
    /// The largest extent of the largest body in metres; `None` leaves the scene's own.
    pub size: Option<Real>,
    /// The kinds of bodies in [`Scene::Solids`], in turn.
    pub solids: Vec<Solid>,
    /// What they fall on.
    pub ground: Ground,
    /// Of all colliders; `None` leaves rapier's default.
    pub friction: Option<Real>,
    /// Steps per second.
    pub hz: u32,
    /// Seed of shapes and poses.
    pub seed: u64,
    /// Whether rapier may keep the contacts of pairs that hardly moved.
    pub recycling: bool,
    /// Whether worlds with our dispatcher hold [`isa_gjk::HullShape`]s instead of plain hulls.
    pub hull_shape: bool,
    /// Whether our dispatcher is told that shapes do not change within a step.
    pub unchanged_shapes: bool,
    /// Whether no two colliders share a shape: each has a copy.
    pub own_shapes: bool,
    /// Whether bodies may fall asleep. Those that do cost nothing, and figures of time would say
    /// so of both worlds.
    pub can_sleep: bool,
}

impl SceneParams {
    /// Plain hulls in a world with rapier's own settings.
    pub fn new(hulls: HullSource, bodies: u32) -> Self {
        Self {
            distinct: if hulls == HullSource::Real {
                u32::MAX
            } else {
                16
            },
            hulls,
            bodies,
            size: None,
            solids: Solid::ALL.to_vec(),
            ground: Ground::default(),
            friction: None,
            hz: 60,
            seed: 1,
            recycling: true,
            hull_shape: false,
            unchanged_shapes: false,
            own_shapes: false,
            can_sleep: true,
        }
    }
}

impl SceneParams {
    /// What there is in `scene`, in words.
    pub fn contents(&self, scene: Scene) -> String {
        match scene.hulls() {
            Hulls::None if scene == Scene::Solids => {
                let solids: Vec<_> = self.solids.iter().map(|solid| solid.name()).collect();
                format!("{} on {}", solids.join(", "), self.ground.name())
            }
            Hulls::None => "no hulls".to_owned(),
            _ => self.hulls.to_string(),
        }
    }
}

/// Builds `scene`; without a dispatcher, rapier's own narrow phase answers.
pub fn build(
    scene: Scene,
    params: &SceneParams,
    dispatcher: Option<IsaGjkDispatcher>,
) -> Result<World, String> {
    let ours = dispatcher.is_some();
    let mut world = World::new(dispatcher, params.unchanged_shapes);
    world.physics.integration_parameters.contact_recycling = params.recycling;
    world.physics.integration_parameters.dt = 1.0 / params.hz as Real;
    build::fill(&mut world, scene, params, params.hull_shape && ours)?;
    if scene.renews() {
        world.renew(Renewal::new(scene, params, &world.physics, ours));
    }
    if let Some(friction) = params.friction {
        for (_, collider) in world.physics.colliders.iter_mut() {
            collider.set_friction(friction);
        }
    }
    if params.own_shapes {
        for (_, collider) in world.physics.colliders.iter_mut() {
            let copy = collider.shape().clone_dyn();
            collider.set_shape(SharedShape(copy.into()));
        }
    }
    Ok(world)
}
