//! The planes of all faces of a small hull, eight at a time: whether a ball is inside of it, and which face is towards a
//! direction or beside a point.

use glam::{DVec3, Vec3};

use crate::ids::FaceId;
use crate::simd::f32x8;
use crate::tolerance::{INSET_ROUNDING, KNIFE_EDGE, PROOF_MARGIN};
use crate::tuning::CLEAR_BEND;

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
pub struct FacePlanes {
    /// Normals coordinate by coordinate, and offsets. Padding has planes at infinity.
    // Plain arrays: allocating memory for aligned ones takes four times as long.
    rows: Box<[[[f32; LANES]; 4]]>,
    /// The largest offset, or [`KNIFE_EDGE`] radii.
    farthest: f32,
}

#[inline]
fn dot([x, y, z]: [f32x8; 3], [a, b, c]: [f32x8; 3]) -> f32x8 {
    x * a + y * b + z * c
}

#[inline]
fn least_of(rows: &[f32x8; ROWS]) -> f32 {
    let least = rows.iter().copied().fold(rows[0], f32x8::fast_min);
    least.to_array().into_iter().fold(f32::INFINITY, f32::min)
}

impl FacePlanes {
    /// From the normals and offsets of all faces. Those of slivers, which have no plane, are infinite.
    pub fn new(planes: impl ExactSizeIterator<Item = (Vec3, f64)>, radius: f64) -> Self {
        let count = if planes.len() > MOST { 0 } else { planes.len() };
        let mut rows = [[
            [0.0; LANES],
            [0.0; LANES],
            [0.0; LANES],
            [f32::INFINITY; LANES],
        ]; ROWS];
        let mut farthest = (KNIFE_EDGE * radius) as f32;
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

    /// Whether a ball that touches the plane of a face from inside is known to be beneath all other planes.
    #[inline]
    pub fn hold_ball(&self, face: FaceId, center: DVec3, radius: f64) -> bool {
        let (at, rounding) = self.rounded(center);
        let least = f32x8::splat(radius as f32 + rounding);
        let (mut nearer, mut shift) = (0, 0);
        for row in &self.rows {
            let [x, y, z, offset] = row.map(f32x8::new);
            let height = offset - dot([x, y, z], at);
            // A height that is NaN is not beyond.
            nearer |= (ALL ^ height.simd_ge(least).to_bitmask()) << shift;
            shift += 8;
        }
        shift > 0 && nearer & !(1 << face.index()) == 0
    }

    /// The face whose normal is nearest to a direction.
    #[inline]
    pub fn face_towards(&self, dir: DVec3) -> Option<FaceId> {
        let dir = dir.as_vec3().to_array().map(f32x8::splat);
        let mut along = [f32x8::ZERO; ROWS];
        let mut most = f32x8::splat(f32::NEG_INFINITY);
        for (along, [x, y, z, _]) in along.iter_mut().zip(&*self.rows) {
            *along = dot([x, y, z].map(|row| f32x8::new(*row)), dir);
            most = most.fast_max(*along);
        }
        let most = most.to_array().into_iter().fold(f32::MIN, f32::max);
        self.first(&along, most)
    }

    /// How far inside a face a point of its plane is: a lower bound, which is negative if the point may be outside.
    #[inline]
    pub fn inset(&self, face: FaceId, point: DVec3) -> Option<f64> {
        let least = least_of(&self.signed_squares(face, point)?);
        Some(PROOF_MARGIN * f64::from(least.abs().sqrt().copysign(least)))
    }

    /// The face across the side of a face that is nearest to a point of its plane. `None` if the two bend by so little that
    /// another side may be nearer.
    #[inline]
    pub fn nearest_beside(&self, face: FaceId, point: DVec3) -> Option<FaceId> {
        let squares = self.signed_squares(face, point)?;
        let beside = self.first(&squares, least_of(&squares))?;
        let cosine = self.normal(face)?.dot(self.normal(beside)?);
        (1.0 - cosine * cosine > CLEAR_BEND).then_some(beside)
    }

    #[inline]
    fn normal(&self, face: FaceId) -> Option<Vec3> {
        let (row, lane) = (face.index() / LANES, face.index() % LANES);
        let [x, y, z, _] = self.rows.get(row)?;
        Some(Vec3::new(x[lane], y[lane], z[lane]))
    }

    /// The squared distances of a point in the plane of a face from where the other planes meet that one, negative
    /// beyond these.
    #[inline]
    fn signed_squares(&self, face: FaceId, point: DVec3) -> Option<[f32x8; ROWS]> {
        let (row, lane) = (face.index() / LANES, face.index() % LANES);
        let normal = self.normal(face)?.to_array().map(f32x8::splat);
        let (at, rounding) = self.rounded(point);
        let (rounding, one) = (f32x8::splat(rounding), f32x8::splat(1.0));
        let mut squares = [f32x8::splat(f32::INFINITY); ROWS];
        for (squares, row) in squares.iter_mut().zip(&*self.rows) {
            let [x, y, z, offset] = row.map(f32x8::new);
            let height = offset - dot([x, y, z], at) - rounding;
            let cosine = dot([x, y, z], normal);
            let squared_sine = (one - cosine * cosine).fast_max(f32x8::splat(CLEAR_BEND));
            *squares = height * height.abs() / squared_sine;
        }
        squares[row].as_mut_array()[lane] = f32::INFINITY;
        Some(squares)
    }

    /// The first face with this value, of a list of rows.
    #[inline]
    fn first(&self, values: &[f32x8; ROWS], value: f32) -> Option<FaceId> {
        let value = f32x8::splat(value);
        let mut rows = values.iter().zip(&*self.rows).enumerate();
        rows.find_map(|(row, (values, _))| {
            let found = values.simd_eq(value).to_bitmask();
            let lane = (0..LANES).find(|lane| found >> lane & 1 == 1)?;
            Some(FaceId::new(row * LANES + lane))
        })
    }

    /// A point in f32, and how far rounding may raise it above a plane.
    #[inline]
    fn rounded(&self, point: DVec3) -> ([f32x8; 3], f32) {
        let point = point.as_vec3();
        let size = self.farthest + point.abs().element_sum();
        let rounding = INSET_ROUNDING as f32 * size;
        (point.to_array().map(f32x8::splat), rounding)
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.rows)
    }
}
