//! The triangles of parry's polyhedron as its faces tell them. parry merges triangles into faces, but lists the
//! edges within a face, too.

use glam::{DVec3, Vec3};
use parry3d::shape::ConvexPolyhedron;

use crate::tuning::SEEMS_FLAT;

/// The triangles of a polyhedron.
pub(super) struct FaceTriangles {
    /// Each from its lowest corner, in the order of their corners.
    pub triangles: Vec<[u32; 3]>,
    /// Whether there seem to be flat sides.
    pub seem_flat: bool,
}

impl FaceTriangles {
    /// `None` if the faces miss vertices.
    pub fn of(polyhedron: &ConvexPolyhedron) -> Option<Self> {
        let points = polyhedron.points();
        let count = (2 * points.len()).checked_sub(4)?;
        let mut keys = Vec::with_capacity(count);
        let mut within = EdgesWithin::default();
        let mut seem_flat = false;
        for (number, face) in (0..).zip(polyhedron.faces()) {
            let first = face.first_vertex_or_edge as usize;
            let end = first + face.num_vertices_or_edges as usize;
            let corners = polyhedron.vertices_adj_to_face().get(first..end)?;
            if let &[a, b, c] = corners {
                keys.push(key([a, b, c]));
            } else {
                within.find(polyhedron);
                within.split(number, corners, &mut keys)?;
                seem_flat |= seems_flat(points, corners);
            }
        }
        if keys.len() != count {
            return None;
        }
        keys.sort_unstable();
        Some(Self {
            triangles: keys.into_iter().map(corners_of).collect(),
            seem_flat,
        })
    }
}

/// A triangle from its lowest corner as a number. Ids of vertices have fewer than 21 bits.
fn key([a, b, c]: [u32; 3]) -> u64 {
    let [a, b, c] = if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    };
    u64::from(a) << 42 | u64::from(b) << 21 | u64::from(c)
}

fn corners_of(key: u64) -> [u32; 3] {
    [42, 21, 0].map(|shift| (key >> shift) as u32 & ((1 << 21) - 1))
}

/// Whether the first four corners of a face lie nearly in a plane. This only decides what is tried first.
fn seems_flat(points: &[Vec3], corners: &[u32]) -> bool {
    let at = |i: usize| points[corners[i] as usize].as_dvec3();
    let [a, b, c] = [1, 2, 3].map(|i| at(i) - at(0));
    let normal: DVec3 = a.cross(b);
    let height = normal.dot(c);
    height * height <= SEEMS_FLAT * SEEMS_FLAT * normal.length_squared() * b.length_squared()
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
    fn split(&mut self, face: u32, corners: &[u32], keys: &mut Vec<u64>) -> Option<()> {
        let rest = &self.edges[self.next..];
        let count = rest.iter().take_while(|edge| edge.0 == face).count();
        if count + 3 != corners.len() {
            return None;
        }
        for v in rest[..count].iter().flat_map(|edge| edge.1) {
            *self.ends.get_mut(v as usize)? += 1;
        }
        self.next += count;
        let mut left = count;
        let mut chain: Vec<u32> = Vec::with_capacity(corners.len());
        for &corner in corners {
            chain.push(corner);
            while let [.., a, b, c] = chain[..]
                && *self.ends.get(b as usize)? == 0
            {
                keys.push(key([a, b, c]));
                chain.truncate(chain.len() - 2);
                chain.push(c);
                if left > 0 {
                    left -= 1;
                    for v in [a, c] {
                        let ends = self.ends.get_mut(v as usize)?;
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
            assert_eq!(Some(faces.triangles), triangles_of_edges(&polyhedron));
        }
        assert!(told >= 11, "only {told} of {} are told", clouds.len());
    }
}
