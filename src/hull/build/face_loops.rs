//! The triangles of parry's polyhedron, from its faces. parry merges triangles into faces, but also lists the
//! edges within a face.

use std::ops::Range;

use glam::{DVec3, Vec3};
use parry3d::shape::ConvexPolyhedron;

use super::flat_sides::{FlatFaces, SideBorder, from_lowest, side_normal};
use crate::at::At;
use crate::hull::lists::Rows;
use crate::tuning::SEEMS_FLAT;

impl FlatFaces {
    /// `None` if the faces are not the flat sides of the polyhedron.
    pub fn of(polyhedron: &ConvexPolyhedron, points: &[DVec3], radius: f64) -> Option<Self> {
        let (faces, corners) = (polyhedron.faces(), polyhedron.vertices_adj_to_face());
        let mut flat = Self::with_capacity(points.len(), faces.len(), corners.len())?;
        // The border of the first of the two sides along each edge.
        let mut borders: Vec<Option<SideBorder>> = vec![None; polyhedron.edges().len()];
        let mut open = 0_usize;
        let mut polygon = Vec::with_capacity(points.len());
        for face in faces {
            let range = places(face.first_vertex_or_edge, face.num_vertices_or_edges);
            let corners = corners.get(range.clone())?;
            let edges = polyhedron.edges_adj_to_face().get(range)?;
            let (lowest, _) = corners.iter().enumerate().min_by_key(|(_, v)| **v)?;
            polygon.clear();
            polygon.extend_from_slice(&corners[lowest..]);
            polygon.extend_from_slice(&corners[..lowest]);
            let normal = side_normal(points, &polygon, radius)?;
            for (i, &edge) in edges.iter().enumerate() {
                let corner = if i < lowest { i + corners.len() } else { i } - lowest;
                let here = SideBorder::new(points, &polygon, corner, normal)?;
                let border = borders.get_mut(usize::try_from(edge).ok()?)?;
                match border.take() {
                    Some(there) if here.bends(&there, radius) => open -= 1,
                    Some(_) => return None,
                    None => {
                        *border = Some(here);
                        open += 1;
                    }
                }
            }
            flat.push(&polygon);
        }
        (open == 0).then_some(flat)
    }
}

/// The range of a face's corners, and of its edges, in parry's lists.
fn places(first: u32, count: u32) -> Range<usize> {
    first as usize..first as usize + count as usize
}

/// Whether the first face of more than three corners seems to be flat. This only decides what is tried first.
pub(super) fn has_flat_sides(polyhedron: &ConvexPolyhedron) -> bool {
    let mut faces = polyhedron.faces().iter();
    let large = faces.find(|face| face.num_vertices_or_edges > 3);
    large.is_some_and(|face| {
        let range = places(face.first_vertex_or_edge, 4);
        let corners = polyhedron.vertices_adj_to_face().get(range);
        corners.is_some_and(|corners| bends_upward(polyhedron.points(), corners).is_none())
    })
}

/// The triangles of a polyhedron.
pub(super) struct FaceTriangles {
    /// In the order of the faces.
    pub triangles: Vec<[u32; 3]>,
    /// Whether there seem to be flat sides.
    pub seem_flat: bool,
}

impl FaceTriangles {
    /// `None` if the faces miss vertices.
    pub fn of(polyhedron: &ConvexPolyhedron) -> Option<Self> {
        let points = polyhedron.points();
        let count = (2 * points.len()).checked_sub(4)?;
        let mut triangles = Vec::with_capacity(count);
        let mut within = EdgesWithin::default();
        let mut seem_flat = false;
        for (number, face) in (0..).zip(polyhedron.faces()) {
            let range = places(face.first_vertex_or_edge, face.num_vertices_or_edges);
            let corners = polyhedron.vertices_adj_to_face().get(range)?;
            // Nearly all faces are triangles.
            if let &[a, b, c] = corners {
                triangles.push([a, b, c]);
                continue;
            }
            let upward = bends_upward(points, corners);
            if let (&[a, b, c, d], Some(upward)) = (corners, upward) {
                triangles.extend(if upward {
                    [[b, c, d], [d, a, b]]
                } else {
                    [[a, b, c], [c, d, a]]
                });
            } else {
                within.find(polyhedron);
                within.split(number, corners, &mut triangles)?;
                seem_flat |= upward.is_none();
            }
        }
        (triangles.len() == count).then_some(Self {
            triangles,
            seem_flat,
        })
    }
}

/// Triangles, each from its lowest corner, in the order of their corners. `None` if a lowest corner is not below
/// `corners`.
pub(super) fn sorted(triangles: &[[u32; 3]], corners: usize) -> Option<Vec<[u32; 3]>> {
    let mut rows = Rows::by_key(
        corners,
        triangles
            .iter()
            .map(|&t| from_lowest(t))
            .map(|triangle| (triangle[0], triangle)),
    )?;
    rows.each_mut(|row| match row {
        // Most vertices are the lowest of two triangles.
        [] | [_] => {}
        [one, other] => {
            if one[1] > other[1] {
                std::mem::swap(one, other);
            }
        }
        all => all.sort_unstable_by_key(|&[_, b, c]| u64::from(b) << 32 | u64::from(c)),
    });
    Some(rows.into_items())
}

/// Whether the fourth corner of a face is above the first three; `None` if there is none, or it is nearly in their
/// plane.
fn bends_upward(points: &[Vec3], corners: &[u32]) -> Option<bool> {
    let &first: &[u32; 4] = corners.first_chunk()?;
    let [origin, a, b, c] = first.map(|v| points.at(v).as_dvec3());
    let [a, b, c] = [a - origin, b - origin, c - origin];
    let normal: DVec3 = a.cross(b);
    let height = normal.dot(c);
    let is_flat =
        height * height <= SEEMS_FLAT * SEEMS_FLAT * normal.length_squared() * b.length_squared();
    (!is_flat).then_some(height > 0.0)
}

/// The edges within faces of more than three corners.
#[derive(Default)]
struct EdgesWithin {
    /// The face of each edge, and its ends, in the order of the faces.
    edges: Vec<(u32, [u32; 2])>,
    /// The next edge to be used.
    next: usize,
    /// How many edges within the current face end at each vertex.
    ends: Vec<u32>,
}

impl EdgesWithin {
    fn find(&mut self, polyhedron: &ConvexPolyhedron) {
        if !self.ends.is_empty() {
            return;
        }
        let within = polyhedron
            .edges()
            .iter()
            .filter(|e| e.faces[0] == e.faces[1]);
        self.edges = within.map(|e| (e.faces[0], e.vertices)).collect();
        self.edges.sort_unstable();
        self.ends = vec![0; polyhedron.points().len()];
    }

    /// Cuts a face into triangles along the edges within it: a corner without such an edge is cut off.
    fn split(&mut self, face: u32, corners: &[u32], triangles: &mut Vec<[u32; 3]>) -> Option<()> {
        let skipped = self.edges[self.next..].iter();
        self.next += skipped.take_while(|edge| edge.0 < face).count();
        let rest = &self.edges[self.next..];
        let count = rest.iter().take_while(|edge| edge.0 == face).count();
        if count + 3 != corners.len() {
            return None;
        }
        for v in rest[..count].iter().flat_map(|edge| edge.1) {
            *self.ends.try_at_mut(v)? += 1;
        }
        self.next += count;
        let mut left = count;
        let mut chain: Vec<u32> = Vec::with_capacity(corners.len());
        for &corner in corners {
            chain.push(corner);
            while let [.., a, b, c] = chain[..]
                && *self.ends.try_at(b)? == 0
            {
                triangles.push([a, b, c]);
                chain.truncate(chain.len() - 2);
                chain.push(c);
                if left > 0 {
                    left -= 1;
                    for v in [a, c] {
                        let ends = self.ends.try_at_mut(v)?;
                        *ends = ends.checked_sub(1)?;
                    }
                }
            }
        }
        (chain.len() == 2).then_some(())
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use super::super::polyhedron::triangles_of_edges;
    use super::*;

    fn prism(sides: usize) -> Vec<Vec3> {
        let corner = |i: usize| {
            let (sin, cos) = (TAU * (i / 2) as f32 / sides as f32).sin_cos();
            Vec3::new(cos, if i.is_multiple_of(2) { -0.5 } else { 0.5 }, sin)
        };
        (0..2 * sides).map(corner).collect()
    }

    /// parry's faces of these have three corners, some of them more, or all of them.
    #[test]
    fn faces_and_edges_have_the_same_triangles() {
        let mut rng = oorandom::Rand64::new(17);
        let mut coordinate = || 2.0 * rng.rand_float() as f32 - 1.0;
        let mut sphere = |count: usize| -> Vec<Vec3> {
            let point = |_| Vec3::from([(); 3].map(|()| coordinate())).normalize_or(Vec3::X);
            (0..count).map(point).collect()
        };
        let mut clouds: Vec<Vec<Vec3>> = [4, 8, 30, 100, 300, 1000].map(&mut sphere).into();
        clouds.extend([3, 4, 5, 7, 32, 100].map(prism));
        let mut told = 0;
        for points in &clouds {
            let polyhedron = ConvexPolyhedron::from_convex_hull(points).expect("a hull");
            let Some(faces) = FaceTriangles::of(&polyhedron) else {
                continue;
            };
            told += 1;
            let triangles = sorted(&faces.triangles, polyhedron.points().len());
            assert!(triangles.is_some());
            assert_eq!(triangles, triangles_of_edges(&polyhedron));
        }
        assert!(told >= 11, "only {told} of {} are told", clouds.len());
    }
}
