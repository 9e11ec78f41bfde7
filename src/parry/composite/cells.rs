//! Shapes made of cells in a grid: height fields and voxels.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::{Cuboid, HeightField, Shape, Voxels};

use crate::tuning::LOOSE_BOX;

#[derive(Clone, Copy)]
pub(super) enum Cells<'a> {
    Field(&'a HeightField),
    Voxels(&'a Voxels),
}

/// A convex part: a triangle of a height field, or a voxel.
pub(super) struct Cell<'a> {
    pub id: u32,
    /// The origin of the part in the whole shape; their axes are the same.
    pub place: Vector,
    pub shape: &'a dyn Shape,
}

impl Cell<'_> {
    /// The pose of another shape in the frame of the cell, from that in the frame of the whole.
    pub fn pose_of(&self, pos12: &Pose) -> Pose {
        Pose::from_parts(pos12.translation - self.place, pos12.rotation)
    }

    /// The box around it, in the frame of the whole.
    pub fn aabb(&self) -> Aabb {
        self.shape.compute_local_aabb().translated(self.place)
    }
}

impl<'a> Cells<'a> {
    pub fn of(shape: &'a dyn Shape) -> Option<Self> {
        let field = shape.as_heightfield().map(Self::Field);
        field.or_else(|| shape.as_voxels().map(Self::Voxels))
    }

    pub fn aabb(self) -> Aabb {
        match self {
            Self::Field(field) => field.local_aabb(),
            Self::Voxels(voxels) => voxels.local_aabb(),
        }
    }

    /// The longest side of a cell, without its height if it is a triangle.
    pub fn pitch(self) -> Real {
        match self {
            Self::Field(field) => field.cell_width().max(field.cell_height()),
            Self::Voxels(voxels) => voxels.voxel_size().max_element(),
        }
    }

    /// Calls `f` for the cells whose boxes meet a box, and perhaps for some beside it.
    pub fn each_near(self, aabb: &Aabb, mut f: impl FnMut(&Cell<'_>)) {
        // Counts of cells in an endless box would overflow.
        let all = self.aabb().loosened(self.pitch());
        let Some(near) = aabb.intersection(&all) else {
            return;
        };
        let near = loose(&near);
        match self {
            Self::Field(field) => field.map_elements_in_local_aabb(&near, &mut |id, triangle| {
                f(&Cell {
                    id,
                    place: Vector::ZERO,
                    shape: triangle,
                });
            }),
            Self::Voxels(voxels) => {
                let cuboid = Cuboid::new(voxels.voxel_size() / 2.0);
                for voxel in voxels.voxels_intersecting_local_aabb(&near) {
                    if !voxel.state.is_empty() {
                        f(&Cell {
                            id: u32::try_from(voxel.linear_id.flat_id()).unwrap_or(u32::MAX),
                            place: voxel.center,
                            shape: &cuboid,
                        });
                    }
                }
            }
        }
    }

    /// The cell with the least measure up to `most`. No measure of a cell is less than the distance of its box from the
    /// box of the `other` shape. Cells are looked for in boxes that grow until what is found is nearer than what was not
    /// looked at.
    pub fn nearest<T>(
        self,
        other: &Aabb,
        most: Real,
        mut measure: impl FnMut(&Cell<'_>) -> Option<(Real, T)>,
    ) -> Option<T> {
        let all = self.aabb();
        let mut nearest: Option<(Real, T)> = None;
        let mut reach = (gap(&all, other) + self.pitch()).max(Real::MIN_POSITIVE);
        loop {
            let near = other.loosened(reach);
            self.each_near(&near, |cell| {
                let least = nearest.as_ref().map_or(most, |(least, _)| *least);
                if gap(&cell.aabb(), other) > least {
                    return;
                }
                let is_new = |found: &(Real, T)| nearest.is_none() || found.0 < least;
                if let Some(found) = measure(cell).filter(is_new) {
                    nearest = Some(found);
                }
            });
            let least = nearest.as_ref().map(|(least, _)| *least);
            let is_enough = least.unwrap_or(most) <= reach || near.contains(&all);
            if is_enough || !reach.is_finite() {
                return nearest.map(|(_, found)| found);
            }
            reach = least.unwrap_or(2.0 * reach);
        }
    }
}

/// A box that contains this one although its sides are rounded.
pub(super) fn loose(aabb: &Aabb) -> Aabb {
    let extent = aabb.mins.abs().max(aabb.maxs.abs()).max_element();
    aabb.loosened(LOOSE_BOX * extent)
}

/// The distance between two boxes.
fn gap(a: &Aabb, b: &Aabb) -> Real {
    let apart = (a.mins - b.maxs).max(b.mins - a.maxs);
    apart.max(Vector::ZERO).length()
}
