//! The triangulated surface behind parry's convex polyhedron.
//!
//! Parry joins triangles up to 1.5 degrees apart, so that its faces may miss vertices; but it
//! still lists all edges of the triangulation. Seen from a point inside, the edges around a
//! vertex have one cyclic order, and neighbours in that order span the triangles again.

use std::cmp::Ordering;
use std::hash::{DefaultHasher, Hash, Hasher};

use glam::{DVec2, DVec3, Vec3};
use parry3d::shape::ConvexPolyhedron;

use super::build::MAX_VERTICES;
use super::{Hull, HullError};

/// The hull of a polyhedron; that of its points where its surface is not a convex triangulation of
/// them all.
///
/// Vertex ids are indices into [`Hull::points`], which are not in the order of the polyhedron's.
impl TryFrom<&ConvexPolyhedron> for Hull {
    type Error = HullError;

    fn try_from(polyhedron: &ConvexPolyhedron) -> Result<Self, HullError> {
        let points = polyhedron.points();
        // All of them are vertices, but for those inside of flat sides: a hull builder would leave too
        // many, and take seconds.
        if points.len() > MAX_VERTICES {
            return Err(HullError::TooManyPoints);
        }
        triangles(polyhedron)
            .and_then(|triangles| Self::in_order(points.to_vec(), &triangles).ok())
            .map_or_else(|| Self::from_points(points), Ok)
    }
}

/// A number that depends on nothing but the points and edges of a polyhedron, of which its hull is
/// made; two that differ hardly ever share it.
pub(crate) fn fingerprint(polyhedron: &ConvexPolyhedron) -> u64 {
    // This hasher has no seed.
    let mut hasher = DefaultHasher::new();
    hasher.write(bytemuck::cast_slice(polyhedron.points()));
    for edge in polyhedron.edges() {
        edge.vertices.hash(&mut hasher);
    }
    hasher.finish()
}

/// Whether two polyhedra have the same points and edges, so that their hulls are the same.
pub(crate) fn is_same(a: &ConvexPolyhedron, b: &ConvexPolyhedron) -> bool {
    let [edges_a, edges_b] = [a, b].map(|p| p.edges().iter().map(|edge| edge.vertices));
    same_points(a.points(), b.points()) && edges_a.eq(edges_b)
}

/// Whether two lists of points are the same bit by bit: one comparison of memory.
#[inline]
pub(crate) fn same_points(a: &[Vec3], b: &[Vec3]) -> bool {
    bytemuck::cast_slice::<Vec3, u8>(a) == bytemuck::cast_slice::<Vec3, u8>(b)
}

/// The triangles of a polyhedron, counter-clockwise from outside; `None` if they cannot be told.
pub(crate) fn triangles(polyhedron: &ConvexPolyhedron) -> Option<Vec<[u32; 3]>> {
    let points = polyhedron.points();
    if points.iter().any(|p| !p.is_finite()) {
        return None;
    }
    let inside = points.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / points.len() as f64;
    let (first, mut targets) = neighbor_rows(points.len(), polyhedron);
    let mut triangles = Vec::with_capacity(2 * points.len());
    let mut angles = Vec::new();
    for v in 0..points.len() {
        let row = &mut targets[first[v] as usize..first[v + 1] as usize];
        let here = points[v].as_dvec3();
        let outward = (here - inside).try_normalize()?;
        let (x, y) = outward.any_orthonormal_pair();
        // Turn counter-clockwise about `outward`, whatever the handedness of the pair.
        let y = if x.cross(y).dot(outward) > 0.0 { y } else { -y };
        angles.clear();
        angles.extend(row.iter().map(|&w| {
            let edge = points[w as usize].as_dvec3() - here;
            (DVec2::new(edge.dot(x), edge.dot(y)), w)
        }));
        angles.sort_unstable_by(|a, b| by_angle(a.0, b.0));
        for (i, &(_, w)) in angles.iter().enumerate() {
            let next = angles[(i + 1) % angles.len()].1;
            // Each triangle is met at all of its corners: keep it at the lowest.
            if (v as u32) < w && (v as u32) < next {
                triangles.push([v as u32, w, next]);
            }
        }
    }
    Some(triangles)
}

/// Compressed rows of the edges at each vertex.
fn neighbor_rows(count: usize, polyhedron: &ConvexPolyhedron) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0_u32; count + 1];
    for edge in polyhedron.edges() {
        for v in edge.vertices {
            first[v as usize + 1] += 1;
        }
    }
    for v in 0..count {
        first[v + 1] += first[v];
    }
    let mut fill = first.clone();
    let mut targets = vec![0_u32; first[count] as usize];
    for edge in polyhedron.edges() {
        let [a, b] = edge.vertices;
        for (from, to) in [(a, b), (b, a)] {
            targets[fill[from as usize] as usize] = to;
            fill[from as usize] += 1;
        }
    }
    (first, targets)
}

/// Counter-clockwise from the positive x axis.
fn by_angle(a: DVec2, b: DVec2) -> Ordering {
    let lower = |p: DVec2| p.y < 0.0 || (p.y == 0.0 && p.x < 0.0);
    lower(a)
        .cmp(&lower(b))
        .then_with(|| 0.0_f64.total_cmp(&a.perp_dot(b)))
}
