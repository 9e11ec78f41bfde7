//! Faces of a hull: coplanar triangles joined to polygons, with their planes.

use glam::{DVec3, Vec3};

use super::caps::{self, Caps};
use super::graph::EdgeGraph;
use crate::support::FaceId;
use crate::tolerance::{FACE_ANGLE_COS, FACE_FLATNESS, SLIVER};

/// Planes, and polygons in compressed rows: those of the faces, then the outlines of the caps.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    planes: Box<[Plane]>,
    first: Box<[u32]>,
    vertices: Box<[u16]>,
    /// The names of the edges that start at `vertices`.
    edges: Box<[u32]>,
    caps: Caps,
}

/// The side of an outline that cuts across faces.
const NO_EDGE: u32 = u32::MAX;

/// A supporting plane. The normal is rounded to f32; the offset is exact for that normal.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: Vec3,
    offset: f64,
}

impl Plane {
    /// That of a sliver whose direction is rounding only: no plane of the hull, and farther out
    /// than any.
    const UNSUPPORTED: Self = Self {
        normal: Vec3::ZERO,
        offset: f64::INFINITY,
    };

    /// Through the outermost of the polygon's corners and their neighbours: on a convex hull no
    /// vertex is farther out.
    fn new(points: &[Vec3], polygon: &[u16], graph: &EdgeGraph, radius: f64) -> Self {
        let normal = polygon_normal(points, polygon).as_vec3();
        let height = |v: u16| normal.as_dvec3().dot(points[v as usize].as_dvec3());
        let (mut lowest, mut offset) = (f64::INFINITY, f64::NEG_INFINITY);
        for &corner in polygon {
            lowest = lowest.min(height(corner));
            offset = offset.max(height(corner));
            for &neighbor in graph.neighbors(corner.into()) {
                offset = offset.max(height(neighbor));
            }
        }
        if offset - lowest > 2.0 * FACE_FLATNESS * radius {
            Self::UNSUPPORTED
        } else {
            Self { normal, offset }
        }
    }
}

impl Faces {
    /// Joins the `triangles` of `graph`, and says to which face each of them went. Edges have no names
    /// before [`add_caps`](Self::add_caps).
    pub fn new(
        points: &[Vec3],
        triangles: &[[u32; 3]],
        graph: &EdgeGraph,
        radius: f64,
    ) -> (Self, Vec<u16>) {
        let regions = Regions::grow(points, triangles, radius);
        let mut first = vec![0];
        let mut vertices = Vec::with_capacity(triangles.len() * 3);
        let mut planes = Vec::new();
        let mut face_of = vec![0_u16; triangles.len()];
        for region in regions.all {
            for polygon in polygons(points, triangles, &region, radius) {
                for &t in &polygon.triangles {
                    face_of[t] = planes.len() as u16;
                }
                planes.push(Plane::new(points, &polygon.vertices, graph, radius));
                vertices.extend_from_slice(&polygon.vertices);
                first.push(vertices.len() as u32);
            }
        }
        let faces = Self {
            planes: planes.into(),
            first: first.into(),
            vertices: vertices.into(),
            edges: Box::default(),
            caps: Caps::default(),
        };
        (faces, face_of)
    }

    /// Finds the caps, when the `graph` knows the faces.
    pub fn add_caps(&mut self, points: &[Vec3], graph: &EdgeGraph) {
        let caps = caps::grow(points, self, graph);
        self.caps = Caps::new(&caps, self.len());
        let (mut first, mut vertices) = (self.first.to_vec(), self.vertices.to_vec());
        for cap in &caps {
            vertices.extend_from_slice(&cap.outline);
            first.push(vertices.len() as u32);
        }
        (self.first, self.vertices) = (first.into(), vertices.into());
        self.name_edges(graph);
    }

    fn name_edges(&mut self, graph: &EdgeGraph) {
        let polygons = 0..self.first.len() - 1;
        let edges = polygons.flat_map(|polygon| {
            let corners = self.polygon(polygon as FaceId);
            let ends = corners.iter().cycle().skip(1);
            let name = |(&from, &to): (&u16, &u16)| graph.edge_id(from.into(), to.into());
            corners
                .iter()
                .zip(ends)
                .map(move |side| name(side).unwrap_or(NO_EDGE))
        });
        self.edges = edges.collect();
    }

    pub fn len(&self) -> usize {
        self.planes.len()
    }

    #[inline]
    pub fn normal(&self, face: FaceId) -> DVec3 {
        self.planes[face as usize].normal.as_dvec3()
    }

    #[inline]
    pub fn offset(&self, face: FaceId) -> f64 {
        self.planes[face as usize].offset
    }

    #[inline]
    pub fn polygon(&self, face: FaceId) -> &[u16] {
        let f = face as usize;
        &self.vertices[self.first[f] as usize..self.first[f + 1] as usize]
    }

    /// The name of the `i`-th edge of a face, or of an outline where that is an edge.
    #[inline]
    pub fn edge(&self, face: FaceId, i: usize) -> Option<u32> {
        let edge = self.edges[self.first[face as usize] as usize + i];
        (edge != NO_EDGE).then_some(edge)
    }

    /// The cap around a face: the name of its outline, and the faces under that.
    #[inline]
    pub fn cap(&self, face: FaceId) -> Option<(FaceId, &[u16])> {
        let (cap, faces) = self.caps.around(face)?;
        Some(((self.len() + cap) as FaceId, faces))
    }

    /// Of these faces the one that looks most in direction `dir`.
    #[inline]
    pub fn most_aligned(&self, candidates: &[u16], dir: DVec3) -> FaceId {
        let mut best = (f64::NEG_INFINITY, 0);
        for &face in candidates {
            let aligned = self.normal(face.into()).dot(dir);
            if aligned > best.0 {
                best = (aligned, face);
            }
        }
        best.1.into()
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.planes)
            + size_of_val(&*self.first)
            + size_of_val(&*self.vertices)
            + size_of_val(&*self.edges)
            + self.caps.heap_bytes()
    }
}

/// Twice the area vector of a triangle.
fn area_vector(points: &[Vec3], triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|v| points[v as usize].as_dvec3());
    (b - a).cross(c - a)
}

fn longest_side(points: &[Vec3], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|v| points[v as usize].as_dvec3());
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

/// Twice the area vector of a polygon, normalised (Newell's method, about its first vertex).
fn polygon_normal(points: &[Vec3], polygon: &[u16]) -> DVec3 {
    let at = |i: usize| points[polygon[i] as usize].as_dvec3();
    let origin = at(0);
    let sum: DVec3 = (1..polygon.len() - 1)
        .map(|i| (at(i) - origin).cross(at(i + 1) - origin))
        .sum();
    sum.normalize_or(DVec3::Z)
}

/// Sets of triangles that lie in one plane each.
struct Regions {
    all: Vec<Vec<usize>>,
}

impl Regions {
    /// Grows from the largest triangles, whose normals are the most reliable.
    fn grow(points: &[Vec3], triangles: &[[u32; 3]], radius: f64) -> Self {
        let areas: Vec<DVec3> = triangles.iter().map(|&t| area_vector(points, t)).collect();
        let neighbors = triangle_neighbors(triangles);
        let mut order: Vec<usize> = (0..triangles.len()).collect();
        order.sort_by(|&a, &b| {
            let (a, b) = (areas[a].length_squared(), areas[b].length_squared());
            b.total_cmp(&a)
        });
        let mut taken = vec![false; triangles.len()];
        let mut all = Vec::new();
        for seed in order {
            if taken[seed] {
                continue;
            }
            taken[seed] = true;
            let normal = areas[seed].normalize_or_zero();
            let level = normal.dot(points[triangles[seed][0] as usize].as_dvec3());
            let mut region = vec![seed];
            let mut next = 0;
            while next < region.len() {
                for t in neighbors[region[next]] {
                    let flat = triangles[t].iter().all(|&v| {
                        let height = normal.dot(points[v as usize].as_dvec3()) - level;
                        height.abs() <= FACE_FLATNESS * radius
                    });
                    // The direction of a sliver is rounding only; its neighbours decide.
                    let area = areas[t].length();
                    let sliver = area <= SLIVER * radius * longest_side(points, triangles[t]);
                    let turned = !sliver && normal.dot(areas[t]) < FACE_ANGLE_COS * area;
                    if !taken[t] && flat && !turned {
                        taken[t] = true;
                        region.push(t);
                    }
                }
                next += 1;
            }
            all.push(region);
        }
        Self { all }
    }
}

/// For each triangle the three that share an edge with it. The surface is closed.
pub(super) fn triangle_neighbors(triangles: &[[u32; 3]]) -> Vec<[usize; 3]> {
    let mut edges: Vec<(u32, u32, usize, usize)> = Vec::with_capacity(triangles.len() * 3);
    for (t, triangle) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            edges.push((a.min(b), a.max(b), t, k));
        }
    }
    edges.sort_unstable();
    let mut neighbors = vec![[0; 3]; triangles.len()];
    for pair in edges.chunks_exact(2) {
        let [(_, _, t0, k0), (_, _, t1, k1)] = [pair[0], pair[1]];
        neighbors[t0][k0] = t1;
        neighbors[t1][k1] = t0;
    }
    neighbors
}

/// A polygon and the triangles it was made from.
struct Polygon {
    vertices: Vec<u16>,
    triangles: Vec<usize>,
}

/// The boundary of a region as one polygon; triangle by triangle where it is not one convex loop.
fn polygons(
    points: &[Vec3],
    triangles: &[[u32; 3]],
    region: &[usize],
    radius: f64,
) -> Vec<Polygon> {
    let single = |t: usize| Polygon {
        vertices: triangles[t].map(|v| v as u16).into(),
        triangles: vec![t],
    };
    if let [t] = region {
        return vec![single(*t)];
    }
    let convex = |vertices: &Vec<u16>| is_convex(points, vertices, radius);
    match boundary_loop(triangles, region).filter(convex) {
        Some(vertices) => vec![Polygon {
            vertices,
            triangles: region.into(),
        }],
        None => region.iter().map(|&t| single(t)).collect(),
    }
}

/// Whether no corner is a dent, beyond rounding.
fn is_convex(points: &[Vec3], polygon: &[u16], radius: f64) -> bool {
    let normal = polygon_normal(points, polygon);
    let count = polygon.len();
    let at = |i: usize| points[polygon[i % count] as usize].as_dvec3();
    (0..count).all(|i| {
        let (before, here, after) = (at(i), at(i + 1), at(i + 2));
        let chord = after - before;
        let outward = normal.dot((here - before).cross(chord));
        outward >= -FACE_FLATNESS * radius * chord.length()
    })
}

fn boundary_loop(triangles: &[[u32; 3]], region: &[usize]) -> Option<Vec<u16>> {
    let mut edges: Vec<(u32, u32)> = region
        .iter()
        .flat_map(|&t| {
            let [a, b, c] = triangles[t];
            [(a, b), (b, c), (c, a)]
        })
        .collect();
    edges.sort_unstable();
    let boundary: Vec<(u32, u32)> = edges
        .iter()
        .copied()
        .filter(|&(a, b)| edges.binary_search(&(b, a)).is_err())
        .collect();
    let start = boundary.first()?.0;
    let mut polygon = Vec::with_capacity(boundary.len());
    let mut at = start;
    for _ in 0..boundary.len() {
        polygon.push(at as u16);
        let i = boundary.partition_point(|&(a, _)| a < at);
        at = boundary.get(i).filter(|&&(a, _)| a == at)?.1;
        if at == start {
            break;
        }
    }
    (polygon.len() == boundary.len() && at == start).then_some(polygon)
}
