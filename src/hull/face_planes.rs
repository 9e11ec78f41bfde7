//! The planes of all faces of a small hull, eight at a time: whether a ball is inside of it.

use glam::{DVec3, Vec3};

use crate::simd::f32x8;
use crate::support::FaceId;
use crate::tolerance::INSET_ROUNDING;

/// With more faces than this, the number of bits of a mask, a look at the sides of one face costs less.
const MOST: usize = 32;

/// How many planes are compared at once.
const LANES: usize = 8;
/// Room for the planes of the most faces.
const ROWS: usize = MOST / LANES;

/// The bits of all of them.
const ALL: u32 = (1 << LANES) - 1;

/// The planes of the faces, in their order. There are none of a larger hull.
#[derive(Clone, Debug)]
pub(super) struct FacePlanes {
    /// Normals coordinate by coordinate, and offsets. Padding has planes at infinity.
    // Plain arrays: allocating memory for aligned ones takes four times as long.
    rows: Box<[[[f32; LANES]; 4]]>,
    /// The largest offset.
    farthest: f32,
}

impl FacePlanes {
    /// From the normals and offsets of all faces. Those of slivers, which have no plane, are infinite.
    pub fn new(planes: impl ExactSizeIterator<Item = (Vec3, f64)>) -> Self {
        let count = if planes.len() > MOST { 0 } else { planes.len() };
        let mut rows = [[
            [0.0; LANES],
            [0.0; LANES],
            [0.0; LANES],
            [f32::INFINITY; LANES],
        ]; ROWS];
        let mut farthest = 0.0_f32;
        for (i, (normal, offset)) in planes.take(count).enumerate() {
            let [x, y, z, distance] = &mut rows[i / LANES % ROWS];
            let (lane, offset) = (i % LANES, offset as f32);
            [x[lane], y[lane], z[lane]] = normal.to_array();
            distance[lane] = offset;
            farthest = farthest.max(offset.abs());
        }
        let used = if farthest.is_finite() { count } else { 0 };
        Self {
            rows: rows[..used.div_ceil(LANES)].into(),
            farthest,
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
        for row in &self.rows {
            let [normal_x, normal_y, normal_z, offset] = row.map(f32x8::new);
            let height = offset - (normal_x * x + normal_y * y + normal_z * z);
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
