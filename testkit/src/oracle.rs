//! Brute force in f64: what an answer is measured against.

use std::collections::HashMap;

use glam::DVec3;

use super::pose::ExactPose;

/// A convex polyhedron in f64.
pub struct Solid {
    pub points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    planes: Vec<Plane>,
    edges: Vec<Edge>,
}

/// The plane of a triangle: unit outward normal, and offset along it.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

/// An edge between two planes; edges inside a flat face are left out.
#[derive(Clone, Copy)]
struct Edge {
    point: DVec3,
    direction: DVec3,
    normals: [DVec3; 2],
}

impl Solid {
    /// The hull with these `points`, whose triangular `faces` turn counter-clockwise.
    pub fn new(points: Vec<DVec3>, faces: &[[u32; 3]]) -> Self {
        let mut planes = Vec::new();
        let mut edges = Vec::new();
        let mut open_edges = HashMap::new();
        for face in faces {
            let [a, b, c] = face.map(|i| points[i as usize]);
            let Some(normal) = (b - a).cross(c - a).try_normalize() else {
                continue;
            };
            planes.push(Plane {
                normal,
                offset: normal.dot(a),
            });
            for [i, j] in [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|k: usize| face[k])) {
                match open_edges.remove(&(j, i)) {
                    Some(other) => {
                        let ends = [i, j].map(|k: u32| points[k as usize]);
                        edges.extend(Edge::between(ends, [normal, other]));
                    }
                    None => {
                        open_edges.insert((i, j), normal);
                    }
                }
            }
        }
        Self {
            faces: faces.to_vec(),
            points,
            planes,
            edges,
        }
    }

    /// A single point.
    pub fn point(at: DVec3) -> Self {
        Self::new(vec![at], &[])
    }

    /// A segment: an edge whose normals go all around it, in four arcs.
    pub fn segment(ends: [DVec3; 2]) -> Self {
        let direction = ends[1] - ends[0];
        let (u, v) = direction.normalize().any_orthonormal_pair();
        let edge = |normals| Edge {
            point: ends[0],
            direction,
            normals,
        };
        Self {
            edges: [[u, v], [v, -u], [-u, -v], [-v, u]].map(edge).into(),
            ..Self::new(ends.into(), &[])
        }
    }

    /// A triangle: two faces, and edges whose normals go from one over the side to the other.
    pub fn triangle(corners: [DVec3; 3]) -> Self {
        let mut solid = Self::new(corners.into(), &[[0, 1, 2], [0, 2, 1]]);
        let normal = solid.planes[0].normal;
        for [from, to] in [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|i| corners[i])) {
            let direction = to - from;
            let across = direction.cross(normal).normalize();
            let arcs = [[normal, across], [across, -normal]];
            solid.edges.extend(arcs.map(|normals| Edge {
                point: from,
                direction,
                normals,
            }));
        }
        solid
    }

    /// Its triangles, counter-clockwise from outside.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// The same faces over points that moved.
    pub fn with_points(&self, points: impl Iterator<Item = DVec3>) -> Self {
        Self::new(points.collect(), &self.faces)
    }

    /// The same solid where `pose` puts it.
    fn placed(&self, pose: &ExactPose) -> Self {
        let place_plane = |plane: &Plane| {
            let normal = pose.rotation * plane.normal;
            Plane {
                normal,
                offset: plane.offset + normal.dot(pose.translation),
            }
        };
        let place_edge = |edge: &Edge| Edge {
            point: pose.apply(edge.point),
            direction: pose.rotation * edge.direction,
            normals: edge.normals.map(|n| pose.rotation * n),
        };
        Self {
            faces: self.faces.clone(),
            points: self.points.iter().map(|p| pose.apply(*p)).collect(),
            planes: self.planes.iter().map(place_plane).collect(),
            edges: self.edges.iter().map(place_edge).collect(),
        }
    }

    /// The point that is farthest along `direction`.
    fn support_point(&self, direction: DVec3) -> DVec3 {
        self.points
            .iter()
            .copied()
            .max_by(|p, q| p.dot(direction).total_cmp(&q.dot(direction)))
            .expect("a solid has points")
    }

    /// The largest value of `direction · p` over the solid.
    pub fn support(&self, direction: DVec3) -> f64 {
        self.points
            .iter()
            .map(|p| p.dot(direction))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// How far `point` is beyond the plane it violates most; negative inside.
    pub fn outside(&self, point: DVec3) -> f64 {
        self.planes
            .iter()
            .map(|plane| plane.normal.dot(point) - plane.offset)
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// How far `point` is from the nearest point of its faces; of a point or a segment, from that.
    pub fn distance_to_surface(&self, point: DVec3) -> f64 {
        match self.points[..] {
            [p] => return p.distance(point),
            [a, b] => return distance_to_segment(point, [a, b]),
            _ => {}
        }
        self.faces
            .iter()
            .map(|face| {
                let mut corners = face.map(|i| self.points[i as usize] - point).to_vec();
                closest_to_origin(&mut corners).length()
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// The farthest that any of its own points is beyond any of its planes.
    pub fn concavity(&self) -> f64 {
        self.planes
            .iter()
            .map(|plane| self.support(plane.normal) - plane.offset)
            .fold(0.0, f64::max)
    }

    /// The diameter of the sphere around the centre of its box.
    pub fn diameter(&self) -> f64 {
        let min = self.points.iter().copied().reduce(DVec3::min);
        let max = self.points.iter().copied().reduce(DVec3::max);
        let centre = min
            .zip(max)
            .map(|(min, max)| 0.5 * (min + max))
            .expect("a solid has points");
        2.0 * self
            .points
            .iter()
            .map(|p| p.distance(centre))
            .fold(0.0, f64::max)
    }
}

/// How far a point is from a segment, which may be a point itself.
pub fn distance_to_segment(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let axis = b - a;
    let share = (p - a).dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE);
    p.distance(a + axis * share.clamp(0.0, 1.0))
}

impl Edge {
    fn between(ends: [DVec3; 2], normals: [DVec3; 2]) -> Option<Self> {
        let bend = normals[0].cross(normals[1]).length();
        (bend > 1.0e-9).then_some(Self {
            point: ends[0],
            direction: ends[1] - ends[0],
            normals,
        })
    }

    /// Whether some plane supports A along this edge and B along the `other`, from the opposite
    /// side: then the arcs of their normals cross on the Gauss sphere.
    fn faces_edge(&self, other: &Self) -> bool {
        let [a, b] = self.normals;
        let [c, d] = other.normals.map(|n| -n);
        let (ba, dc) = (b.cross(a), d.cross(c));
        let (cba, dba, adc, bdc) = (c.dot(ba), d.dot(ba), a.dot(dc), b.dot(dc));
        cba * dba < 0.0 && adc * bdc < 0.0 && cba * bdc > 0.0
    }
}

/// `s(n) = min_b n·b − max_a n·a`: the signed distance is its maximum over all unit `n`.
fn separation_along(a: &Solid, b: &Solid, pose: &ExactPose, normal: DVec3) -> f64 {
    let in_b = pose.rotation.inverse() * normal;
    normal.dot(pose.translation) - b.support(-in_b) - a.support(normal)
}

/// How much separation a better normal would have shown. There is no better than the `exact`
/// signed distance: a normal that beats it would prove the oracle wrong.
pub fn regret(a: &Solid, b: &Solid, pose: &ExactPose, normal: DVec3, exact: f64) -> f64 {
    let shown = separation_along(a, b, pose, normal.normalize());
    let rounding = 1.0e-8 * (a.diameter() + b.diameter() + pose.translation.length());
    assert!(
        shown.is_nan() || shown <= exact + rounding,
        "{normal} separates by {shown:e}, more than the exact {exact:e}"
    );
    exact - shown
}

/// The exact signed distance, up to rounding in f64.
///
/// A polyhedron's penetration depth is reached along a normal of one of its faces or across two
/// edges; if all of those overlap the solids do, and else their distance is certified.
pub fn signed_distance(a: &Solid, b: &Solid, pose: &ExactPose) -> f64 {
    let b = b.placed(pose);
    let faces = best_face(a, &b).max(best_face(&b, a));
    let best = if faces > 0.0 {
        faces
    } else {
        faces.max(best_edge_pair(a, &b))
    };
    if best > 0.0 { distance(a, &b) } else { best }
}

/// The largest separation along a face normal of `a`.
fn best_face(a: &Solid, b: &Solid) -> f64 {
    a.planes
        .iter()
        .map(|plane| -b.support(-plane.normal) - plane.offset)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// The largest separation across an edge of `a` and an edge of `b`.
fn best_edge_pair(a: &Solid, b: &Solid) -> f64 {
    let mut best = f64::NEG_INFINITY;
    for edge_a in &a.edges {
        for edge_b in &b.edges {
            if !edge_a.faces_edge(edge_b) {
                continue;
            }
            let across = edge_a.direction.cross(edge_b.direction);
            let outward = across * across.dot(edge_a.normals[0] + edge_a.normals[1]).signum();
            if let Some(normal) = outward.try_normalize() {
                best = best.max(-b.support(-normal) - a.support(normal));
            }
        }
    }
    best
}

/// The distance of two separated solids: GJK over brute-force supports until rounding stops it,
/// with a proof that nothing is much closer.
fn distance(a: &Solid, b: &Solid) -> f64 {
    let mut simplex = vec![b.points[0] - a.points[0]];
    let mut nearest = closest_to_origin(&mut simplex);
    let mut lower = 0.0_f64;
    loop {
        let upper = nearest.length();
        let next = b.support_point(-nearest) - a.support_point(nearest);
        lower = lower.max(next.dot(nearest) / upper);
        simplex.push(next);
        nearest = closest_to_origin(&mut simplex);
        if nearest.length() >= upper {
            let gap = (upper - lower) / (a.diameter() + b.diameter() + upper);
            assert!(gap < 1.0e-7, "the oracle is unsure of a distance: {gap:e}");
            return upper;
        }
    }
}

/// The point of the simplex that is nearest to the origin, which lies outside; the simplex
/// shrinks to the corners that span it.
fn closest_to_origin(simplex: &mut Vec<DVec3>) -> DVec3 {
    let count = simplex.len();
    let (nearest, corners) = (1_u32..1 << count)
        .map(|mask| {
            (0..count)
                .filter(|i| mask & (1 << i) != 0)
                .map(|i| simplex[i])
                .collect::<Vec<_>>()
        })
        .filter_map(|corners| Some((interior_foot(&corners)?, corners)))
        .min_by(|(p, _), (q, _)| p.length_squared().total_cmp(&q.length_squared()))
        .expect("a corner is its own foot");
    *simplex = corners;
    nearest
}

/// The foot of the origin on the span of up to three corners, if it is inside.
fn interior_foot(corners: &[DVec3]) -> Option<DVec3> {
    match *corners {
        [a] => Some(a),
        [a, b] => {
            let t = -a.dot(b - a) / (b - a).length_squared();
            (t > 0.0 && t < 1.0).then(|| a + t * (b - a))
        }
        [a, b, c] => {
            let normal = (b - a).cross(c - a);
            let foot = normal * (normal.dot(a) / normal.length_squared());
            let inside = |p: DVec3, q: DVec3| normal.dot((q - p).cross(foot - p)) > 0.0;
            (inside(a, b) && inside(b, c) && inside(c, a)).then_some(foot)
        }
        _ => None,
    }
}
