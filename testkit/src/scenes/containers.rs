//! Containers for the bodies of a scene.

use std::f32::consts::PI;
use std::str::FromStr;

use parry3d::utils::Array2;
use rapier3d::prelude::*;

use super::world::World;
use super::{hulls, named};

/// Thick enough that nothing tunnels through it in a frame.
pub const WALL: Real = 1.0;

/// Narrow staves have small bounding boxes: a square drum would pair each of its sides with
/// half of the bodies.
const STAVES: usize = 12;

/// A closed drum around the z axis, turning about it.
pub fn drum(world: &mut World, apothem: Real, length: Real) {
    let body = world
        .physics
        .insert_body(RigidBodyBuilder::kinematic_position_based());
    let outer = apothem + WALL;
    // Wide enough to close the wedge that opens outwards between two staves.
    let half_width = outer * (PI / STAVES as Real).tan();
    for i in 0..STAVES {
        let turn = Rotation::from_rotation_z(2.0 * PI * i as Real / STAVES as Real);
        let centre = turn * Vector::new(apothem + WALL / 2.0, 0.0, 0.0);
        let stave = ColliderBuilder::cuboid(WALL / 2.0, half_width, length / 2.0)
            .position(Pose::from_parts(centre, turn));
        world.physics.insert_collider(stave, Some(body));
    }
    for side in [-1.0, 1.0] {
        let end = ColliderBuilder::cuboid(outer, outer, WALL / 2.0).translation(Vector::new(
            0.0,
            0.0,
            side * (length + WALL) / 2.0,
        ));
        world.physics.insert_collider(end, Some(body));
    }
    world.turn(body);
}

/// A square floor whose upper side is at height zero.
pub fn floor(world: &mut World, half_width: Real) {
    let slab = ColliderBuilder::cuboid(half_width, WALL / 2.0, half_width)
        .translation(Vector::new(0.0, -WALL / 2.0, 0.0));
    world.physics.insert_collider(slab, None);
}

/// The same floor as a hull.
pub fn hull_floor(world: &mut World, half_width: Real) -> Result<(), String> {
    let slab = hulls::cuboid(Vector::new(half_width, WALL / 2.0, half_width))?;
    let slab = ColliderBuilder::new(slab).translation(Vector::new(0.0, -WALL / 2.0, 0.0));
    world.physics.insert_collider(slab, None);
    Ok(())
}

/// Four walls around a square.
pub fn walls(world: &mut World, half_width: Real, height: Real) {
    let away = half_width + WALL / 2.0;
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        // Thin along its own axis, and long enough along the other to close the corners.
        let half = |axis: Real| WALL / 2.0 + half_width * (1.0 - axis.abs());
        let wall = ColliderBuilder::cuboid(half(x), height / 2.0 + WALL, half(z))
            .translation(Vector::new(x * away, height / 2.0, z * away));
        world.physics.insert_collider(wall, None);
    }
}

/// What the bodies of a pile fall on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ground {
    /// A level cuboid.
    #[default]
    Floor,
    /// A bumpy mesh.
    Mesh,
    /// The same with its inner edges corrected (`FIX_INTERNAL_EDGES`).
    CorrectedMesh,
    /// A bumpy height field.
    HeightField,
    /// A bumpy compound of boxes.
    Boxes,
}

impl Ground {
    /// Every ground.
    pub const ALL: [Self; 5] = [
        Self::Floor,
        Self::Mesh,
        Self::CorrectedMesh,
        Self::HeightField,
        Self::Boxes,
    ];

    /// The name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Floor => "floor",
            Self::Mesh => "mesh",
            Self::CorrectedMesh => "corrected-mesh",
            Self::HeightField => "heightfield",
            Self::Boxes => "boxes",
        }
    }

    /// Adds a square of it around height zero; bumps are about as large as `cell`.
    pub fn insert(self, world: &mut World, half_width: Real, cell: Real) -> Result<(), String> {
        match self {
            Self::Floor => floor(world, half_width),
            Self::Mesh => bumpy_mesh(world, half_width, cell, TriMeshFlags::empty())?,
            Self::CorrectedMesh => {
                bumpy_mesh(world, half_width, cell, TriMeshFlags::FIX_INTERNAL_EDGES)?;
            }
            Self::HeightField => bumpy_field(world, half_width, cell),
            Self::Boxes => bumpy_compound(world, half_width, cell),
        }
        Ok(())
    }
}

impl FromStr for Ground {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        named(text, Self::ALL, Self::name)
    }
}

/// Triangles about as large as `cell`.
fn bumpy_mesh(
    world: &mut World,
    half_width: Real,
    cell: Real,
    flags: TriMeshFlags,
) -> Result<(), String> {
    let (cells, heights) = bumps(half_width, cell);
    let along = |step: u32| half_width * (2.0 * step as Real / cells as Real - 1.0);
    let corners = (0..=cells).flat_map(|i| (0..=cells).map(move |k| (i, k)));
    let points = corners.zip(heights);
    let points = points.map(|((i, k), height)| Vector::new(along(i), height, along(k)));
    let mut triangles = Vec::new();
    for i in 0..cells {
        for k in 0..cells {
            let corner = i * (cells + 1) + k;
            let next = corner + cells + 1;
            triangles.push([corner, corner + 1, next]);
            triangles.push([corner + 1, next + 1, next]);
        }
    }
    let mesh = ColliderBuilder::trimesh_with_flags(points.collect(), triangles, flags)
        .map_err(|error| format!("the ground is no valid mesh: {error}"))?;
    world.physics.insert_collider(mesh, None);
    Ok(())
}

/// The same ground as a height field.
fn bumpy_field(world: &mut World, half_width: Real, cell: Real) {
    let (cells, heights) = bumps(half_width, cell);
    let corners = cells as usize + 1;
    let heights = Array2::new(corners, corners, heights);
    let size = Vector::new(2.0 * half_width, 1.0, 2.0 * half_width);
    let field = ColliderBuilder::heightfield(heights, size);
    world.physics.insert_collider(field, None);
}

/// Much the same ground as a compound of boxes, each as high as a corner of a cell.
fn bumpy_compound(world: &mut World, half_width: Real, cell: Real) {
    let (cells, heights) = bumps(half_width, cell);
    let along = |step: u32| half_width * (2.0 * step as Real / cells as Real - 1.0);
    let half = half_width / cells as Real;
    let corners = (0..=cells).flat_map(|i| (0..=cells).map(move |k| (i, k)));
    let boxes = corners.zip(heights).map(|((i, k), height)| {
        let place = Vector::new(along(i), height - WALL / 2.0, along(k));
        (
            Pose::from_translation(place),
            SharedShape::cuboid(half, WALL / 2.0, half),
        )
    });
    let compound = ColliderBuilder::compound(boxes.collect());
    world.physics.insert_collider(compound, None);
}

/// How many cells there are along a side, and the heights of their corners, x by x.
fn bumps(half_width: Real, cell: Real) -> (u32, Vec<Real>) {
    let cells = (2.0 * half_width / cell).ceil() as u32;
    let along = |step: u32| half_width * (2.0 * step as Real / cells as Real - 1.0);
    let bump = |x: Real, z: Real| cell * 0.4 * ((x / cell).sin() + (0.8 * z / cell).cos());
    let corners = (0..=cells).flat_map(|i| (0..=cells).map(move |k| (i, k)));
    let heights = corners.map(|(i, k)| bump(along(i), along(k)));
    (cells, heights.collect())
}
