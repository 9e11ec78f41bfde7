//! The checks that the surface of a hull must pass.

use glam::{DVec3, Vec3};

use super::area_vectors::{AreaVectors, Volume, longest_side};
use crate::at::{At, to_u32};
use crate::hull::HullError;
use crate::hull::climb::{self, HillClimb};
use crate::hull::faces::Faces;
use crate::mix::mix;
use crate::support::FaceId;
use crate::tolerance::{BOWL, MAX_INWARD_HEIGHT, MIN_EXTENT};

/// The largest number of vertices of a hull: the ids of its at most `2 n - 4` faces must fit into 16 bits.
pub(super) const MAX_VERTICES: usize = 32_768;

pub(super) fn validate_finite(points: &[Vec3]) -> Result<(), HullError> {
    match points.iter().position(|p| !p.is_finite()) {
        Some(i) => Err(HullError::NotFinite(i)),
        None => Ok(()),
    }
}

pub(super) fn validate_triangles(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), HullError> {
    let bad = |&[a, b, c]: &[u32; 3]| {
        a == b || b == c || c == a || [a, b, c].iter().any(|&v| points.try_at(v).is_none())
    };
    match triangles.iter().position(bad) {
        Some(i) => Err(HullError::BadTriangle(i)),
        None => Ok(()),
    }
}

/// Refuses points that coincide, such as corners of a mesh that was not welded.
pub(super) fn validate_distinct(points: &[Vec3]) -> Result<(), HullError> {
    // A hash table of indices, of which at most half is full.
    let mut table = vec![NOTHING; (2 * points.len()).next_power_of_two()];
    let mask = table.len() - 1;
    for (i, point) in points.iter().enumerate() {
        let mut place = hash(*point) & mask;
        while table[place] != NOTHING {
            if points.at(table[place]) == *point {
                return Err(HullError::DuplicateVertex(i));
            }
            place = (place + 1) & mask;
        }
        table[place] = to_u32(i);
    }
    Ok(())
}

/// A place of the table without a point.
const NOTHING: u32 = u32::MAX;

/// Equal for equal points. Adding zero turns -0 into 0.
fn hash(point: Vec3) -> usize {
    let [x, y, z] = (point + Vec3::ZERO)
        .to_array()
        .map(|x| u64::from(x.to_bits()));
    mix(mix(x << 32 | y) ^ z) as usize
}

/// The centre of volume, and the largest distance of a vertex from it.
pub(super) fn center_and_radius(
    points: &[DVec3],
    inside: &Volume,
) -> Result<(DVec3, f64), HullError> {
    let origin = inside.origin;
    let farthest = |from: DVec3| {
        let distances = points.iter().map(|p| (*p - from).length_squared());
        // No value is NaN here, so the NaN check of `f64::max` is not needed.
        distances
            .fold(0.0, |a: f64, b| if a > b { a } else { b })
            .sqrt()
    };
    // For a flat surface, rounding decides the sign.
    if inside.volume <= 0.0 {
        let is_flat = inside.volume >= -MIN_EXTENT * farthest(origin).powi(3);
        return Err(if is_flat {
            HullError::Flat
        } else {
            HullError::InsideOut
        });
    }
    let center = origin + inside.moment / (4.0 * inside.volume);
    Ok((center, farthest(center)))
}

/// Refuses faces with much of the hull in front of their plane. Each edge of a bowl is a dent within
/// rounding, but many of them add up: climbing from the face leads to the rim.
pub(super) fn validate_no_bowl(
    climb: HillClimb<'_>,
    faces: &Faces,
    overtopped: &[u16],
) -> Result<(), HullError> {
    for face in overtopped.iter().copied().map(FaceId::from) {
        let normal = faces.normal(face);
        let corner = faces.polygon(face)[0].vertex.into();
        let (summit, height) = climb::nearest_summit(climb, normal, corner);
        if height - faces.offset(face) > BOWL * climb.radius {
            return Err(HullError::NotConvex(summit.index()));
        }
    }
    Ok(())
}

/// Refuses a surface that does not go around the centre exactly once: no triangle may face the centre, unless
/// rounding turned a sliver, and a ray from the centre must leave only once. Returns whether it leaves exactly
/// once, and no triangle faces the centre. Then the surface is connected, and no two vertices are at the same place.
///
/// All edges of a fold may be convex, and so may be all edges of two connected layers. Hull builders that
/// work in f32 leave such surfaces on needles, whose cross-section they mistake for rounding. A climb would
/// be trapped there, far below the top.
pub(super) fn validate_single_layer(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    surface: &AreaVectors,
    center: DVec3,
    radius: f64,
) -> Result<bool, HullError> {
    let not_convex = |[vertex, ..]: &[u32; 3]| HullError::NotConvex(*vertex as usize);
    let mut some_inward = false;
    for (triangle, vector) in triangles.iter().zip(&surface.triangles) {
        let outward = vector.vector.dot(points.at(triangle[0]) - center);
        if outward <= 0.0 {
            some_inward = true;
            let height = MAX_INWARD_HEIGHT * radius;
            let is_sliver = || vector.area <= height * longest_side(points, *triangle);
            if outward < 0.0 && !is_sliver() {
                return Err(not_convex(triangle));
            }
        }
    }
    let mut met = met_by_ray(points, triangles, center);
    let meets_one = met.next().is_some();
    match met.next() {
        Some(second) => Err(not_convex(second)),
        None => Ok(meets_one && !some_inward),
    }
}

/// The triangles that a ray from the centre meets.
pub(super) fn met_by_ray<'a>(
    points: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    center: DVec3,
) -> impl Iterator<Item = &'a [u32; 3]> {
    let (x, y) = TEST_RAY.normalize().any_orthonormal_pair();
    let seen_from_ray = |p: &DVec3| quadrant((*p - center).dot(x), (*p - center).dot(y));
    let quadrants: Vec<u8> = points.iter().map(seen_from_ray).collect();
    triangles.iter().filter(move |&&[a, b, c]| {
        // A triangle on one side of a plane through the ray does not meet it.
        let beside = quadrants.at(a) & quadrants.at(b) & quadrants.at(c);
        beside == 0 && meets_ray([a, b, c].map(|v| points.at(v) - center))
    })
}

/// On which sides of two planes through the test ray a point lies, with some distance.
fn quadrant(x: f64, y: f64) -> u8 {
    u8::from(x > 0.0) | u8::from(x < 0.0) << 1 | u8::from(y > 0.0) << 2 | u8::from(y < 0.0) << 3
}

/// Whether the test ray passes on the left of all sides of a triangle.
fn meets_ray([a, b, c]: [DVec3; 3]) -> bool {
    let passes = |from: DVec3, to: DVec3| from.cross(to).dot(TEST_RAY) > 0.0;
    passes(a, b) && passes(b, c) && passes(c, a)
}

/// A direction in which a hull is unlikely to have an edge.
const TEST_RAY: DVec3 = DVec3::new(0.267_3, -0.534_7, 0.801_7);
