//! The checks that the surface of a hull must pass.

use glam::{DVec3, Vec3};

use super::flat_edges::{AreaVectors, longest_side};
use super::half_edge::{HalfEdgeMesh, next, triangle};
use crate::hull::HullError;
use crate::hull::climb::{self, HillClimb};
use crate::hull::faces::Faces;
use crate::support::FaceId;
use crate::tolerance::{BOWL, FLAT_EDGE, MAX_DENT, MAX_INWARD_HEIGHT, MIN_EXTENT, STEEP_EDGE};

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
        a == b || b == c || c == a || [a, b, c].iter().any(|&v| v as usize >= points.len())
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
            if points[table[place] as usize] == *point {
                return Err(HullError::DuplicateVertex(i));
            }
            place = (place + 1) & mask;
        }
        table[place] = i as u32;
    }
    Ok(())
}

/// A place of the table without a point.
const NOTHING: u32 = u32::MAX;

/// Equal for equal points. Adding zero turns -0 into 0.
fn hash(point: Vec3) -> usize {
    let [x, y, z] = (point + Vec3::ZERO).to_array().map(f32::to_bits);
    let mixed = (u64::from(x) << 32 | u64::from(y)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ mixed >> 32 ^ u64::from(z)).wrapping_mul(0xD6E8_FEB8_6659_FD93);
    (mixed >> 32) as usize
}

/// The centre of volume, and the largest distance of a vertex from it.
pub(super) fn center_and_radius(
    points: &[DVec3],
    triangles: &[[u32; 3]],
) -> Result<(DVec3, f64), HullError> {
    let origin = points[0];
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize] - origin);
        let v = a.dot(b.cross(c));
        volume += v;
        moment += (a + b + c) * v;
    }
    let farthest = |from: DVec3| {
        let distances = points.iter().map(|p| (*p - from).length_squared());
        distances.fold(0.0, f64::max).sqrt()
    };
    // For a flat surface, rounding decides the sign.
    if volume < -MIN_EXTENT * farthest(origin).powi(3) {
        return Err(HullError::InsideOut);
    }
    if volume <= 0.0 {
        return Err(HullError::Flat);
    }
    let center = origin + moment / (4.0 * volume);
    Ok((center, farthest(center)))
}

/// Refuses edges that are dents, beyond rounding. A closed surface in a single layer is convex if it is
/// convex at every edge. Returns how much it bends.
///
/// The depth of a dent is how far its edge passes beneath the other diagonal of its two triangles. (Heights
/// over the planes of the triangles mean nothing if these are slivers.)
pub(super) fn validate_convex(
    points: &[DVec3],
    mesh: &HalfEdgeMesh<'_>,
    surface: &AreaVectors,
    radius: f64,
) -> Result<Bends, HullError> {
    let mut bends = Bends {
        at_flat_edge: vec![false; points.len()],
        is_steep: vec![true; points.len()],
        everywhere: true,
    };
    let at = |v: u32| points[v as usize];
    for h in 0..3 * mesh.triangles.len() as u32 {
        let twin = mesh.twin(h);
        if h < twin {
            let ends = [mesh.start(h), mesh.end(h)];
            let [third, opposite] = [h, twin].map(|h| mesh.end(next(h)));
            let ([a, b], c, d) = (ends.map(at), at(third), at(opposite));
            let rise = (b - a).cross(c - a).dot(d - a);
            let [one, other] = [h, twin].map(|h| surface.areas[triangle(h)]);
            let area = if one > other { one } else { other };
            // The two diagonals span at most both areas, so such an edge is far from a dent.
            if -rise > STEEP_EDGE * radius * area {
                continue;
            }
            bends.is_steep[ends[0] as usize] = false;
            bends.is_steep[ends[1] as usize] = false;
            // Twice, since the centre may be anywhere.
            bends.everywhere &= -rise > 2.0 * FLAT_EDGE * radius * area;
            let across = (b - a).cross(d - c);
            let rounding = MAX_DENT * radius * across.length();
            if rise > rounding {
                return Err(HullError::NotConvex(opposite as usize));
            }
            if rise >= -rounding {
                for v in ends.into_iter().chain([third, opposite]) {
                    bends.at_flat_edge[v as usize] = true;
                }
            }
        }
    }
    Ok(bends)
}

/// How much a surface bends at its edges.
pub(super) struct Bends {
    /// The vertices of two triangles that are flat up to rounding.
    pub at_flat_edge: Vec<bool>,
    /// The vertices at which all edges are steep: no neighbour of theirs is as high as the planes around them.
    pub is_steep: Vec<bool>,
    /// Whether no edge is a [`FLAT_EDGE`], whatever point inside the radius is measured from.
    pub everywhere: bool,
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
/// rounding turned a sliver, and a ray from the centre must leave only once.
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
) -> Result<(), HullError> {
    let mut crossings = 0;
    for (&triangle, (&normal, &area)) in triangles
        .iter()
        .zip(surface.vectors.iter().zip(&surface.areas))
    {
        let [a, b, c] = triangle.map(|v| points[v as usize] - center);
        let is_sliver = || area <= MAX_INWARD_HEIGHT * radius * longest_side(points, triangle);
        let is_fold = normal.dot(a) < 0.0 && !is_sliver();
        // The ray passes on the left of the sides.
        let passes = |from: DVec3, to: DVec3| from.cross(to).dot(TEST_RAY) > 0.0;
        crossings += u32::from(passes(a, b) && passes(b, c) && passes(c, a));
        if is_fold || crossings > 1 {
            return Err(HullError::NotConvex(triangle[0] as usize));
        }
    }
    Ok(())
}

/// A direction in which a hull is unlikely to have an edge.
const TEST_RAY: DVec3 = DVec3::new(0.267_3, -0.534_7, 0.801_7);
