//! The planes of all faces of a small hull, eight at a time: whether a ball is inside of it.

use std::array;

use glam::{DVec3, Vec3};

use crate::simd::f32x8;
use crate::support::FaceId;
use crate::tolerance::INSET_ROUNDING;

/// With more faces than this, the number of bits of a mask, a look at the sides of one face costs less.
const MOST: usize = 32;

/// How many planes are compared at once.
const LANES: usize = 8;
/// The bits of all of them.
const ALL: u32 = (1 << LANES) - 1;

/// The planes of the faces, in their order. There are none of a larger hull.
#[derive(Clone, Debug)]
pub(super) struct FacePlanes {
    /// Normals coordinate by coordinate, and offsets. Padding has planes at infinity.
    rows: Box<[[f32x8; 4]]>,
    /// The largest offset.
    farthest: f32,
}

impl FacePlanes {
    /// From the normals and offsets of all faces. Those of slivers, which have no plane, are infinite.
    pub fn new(planes: impl ExactSizeIterator<Item = (Vec3, f64)>) -> Self {
        let mut known: Vec<(Vec3, f32)> = Vec::new();
        if planes.len() <= MOST {
            known.extend(planes.map(|(normal, offset)| (normal, offset as f32)));
        }
        if known.iter().any(|(_, offset)| offset.is_infinite()) {
            known.clear();
        }
        let row = |chunk: &[(Vec3, f32)]| {
            let plane = |i: usize| chunk.get(i).map_or((Vec3::ZERO, f32::INFINITY), |p| *p);
            let lanes: [(Vec3, f32); LANES] = array::from_fn(plane);
            [
                f32x8::new(lanes.map(|(normal, _)| normal.x)),
                f32x8::new(lanes.map(|(normal, _)| normal.y)),
                f32x8::new(lanes.map(|(normal, _)| normal.z)),
                f32x8::new(lanes.map(|(_, offset)| offset)),
            ]
        };
        let offsets = known.iter().map(|(_, offset)| offset.abs());
        Self {
            farthest: offsets.fold(0.0, f32::max),
            rows: known.chunks(LANES).map(row).collect(),
        }
    }

    /// Whether all planes but that of a face are known to be at least `radius` above a point.
    #[inline]
    pub fn are_beyond(&self, face: FaceId, point: DVec3, radius: f64) -> bool {
        let point = point.as_vec3();
        let size = self.farthest + point.abs().element_sum();
        let least = f32x8::splat(radius as f32 + INSET_ROUNDING as f32 * size);
        let [x, y, z] = point.to_array().map(f32x8::splat);
        let (mut nearer, mut shift) = (0, 0);
        for [normal_x, normal_y, normal_z, offset] in &self.rows {
            let height = *offset - (*normal_x * x + *normal_y * y + *normal_z * z);
            // A height that is NaN is not beyond.
            nearer |= (ALL ^ height.simd_ge(least).to_bitmask()) << shift;
            shift += 8;
        }
        shift > 0 && nearer & !(1 << face.index()) == 0
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.rows)
    }
}
