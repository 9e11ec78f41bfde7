//! Features in contact, and the proof that they still are.
//!
//! A pair of features spans a facet of the Minkowski difference: a face and a vertex, or two
//! edges that cross. Re-evaluated at the present poses it is again a polygon inside of the
//! Minkowski difference. One support pair along its normal tells whether its plane supports the
//! difference: then its signed distance from the origin bounds the true one from one side. From
//! the other side,
//!
//! - if the plane separates the shapes: the origin projects into the polygon, so a point of the
//!   difference is that near;
//! - if they overlap by `d`: the pyramid from the polygon to the difference's centre lies in the
//!   difference, and when the origin is at least `d` inside of all of its sides, so does the ball
//!   of radius `d`; no direction has a smaller depth. *Globally*: no other face was looked at.

use std::cmp::Ordering;

use glam::DVec3;

use super::Proximity;
use crate::epa::Penetration;
use crate::gjk::SeparatingAxis;
use crate::pose::RelativePose;
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex, FaceId, Polytope, VertexId};
use crate::tolerance::PARALLEL_EDGES;

/// A part of a polytope's boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// A vertex.
    Vertex(VertexId),
    /// An edge, by its name.
    Edge(u32),
    /// A face.
    Face(FaceId),
}

/// What a pair of features turned out to prove.
#[expect(
    clippy::large_enum_variant,
    reason = "lives for one call, on the stack"
)]
pub(super) enum Verdict {
    /// The facet's plane separates the shapes by more than was asked about.
    Apart(SeparatingAxis),
    /// The facet's signed distance is that of the shapes.
    Certified(Proximity),
    /// The origin projects beyond this side of the facet: another one is nearest by now.
    Beyond(Side),
    /// The facet's plane, with this normal, cuts through the difference: this vertex is beyond it.
    Cut(CsoVertex, DVec3),
    /// The shapes overlap, perhaps less elsewhere. Points of the Minkowski difference around the
    /// facet, to go on from, and the answer if the facet turns out to be the nearest.
    Unproved(Seeds, Proximity),
    /// These features do not span a facet.
    NoPlane,
}

/// A side of a facet. In frame 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Its end points.
    pub ends: [CsoVertex; 2],
    /// The facet's normal, from shape 1 to shape 2.
    pub normal: DVec3,
    /// The unit direction in the facet's plane out of the facet.
    pub outward: DVec3,
}

impl Side {
    fn new(from: CsoVertex, to: CsoVertex, normal: DVec3) -> Self {
        Self {
            ends: [from, to],
            normal,
            outward: (to.w - from.w).cross(normal).normalize_or_zero(),
        }
    }
}

/// A few points of the Minkowski difference.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seeds {
    points: [CsoVertex; 5],
    len: usize,
}

impl Seeds {
    pub fn new(points: &[CsoVertex]) -> Self {
        let mut seeds = Self::default();
        points.iter().for_each(|point| seeds.push(*point));
        seeds
    }

    pub fn as_slice(&self) -> &[CsoVertex] {
        &self.points[..self.len]
    }

    pub fn push(&mut self, point: CsoVertex) {
        if self.len < self.points.len() {
            self.points[self.len] = point;
            self.len += 1;
        }
    }
}

/// Re-evaluates the facet that `features` span.
pub(super) fn certify<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    features: [Feature; 2],
    max_distance: f64,
    tolerance: f64,
    cost: &mut Cost,
) -> Verdict {
    let test = Test {
        max_distance,
        tolerance,
    };
    let [v1, v2] = vertices(cso, features);
    match features {
        [Feature::Edge(e1), Feature::Edge(e2)] => {
            match (cso.shape_1.edge(e1), cso.shape_2.edge(e2)) {
                (Some(ends_1), Some(ends_2)) => test.edges(cso, features, ends_1, ends_2, cost),
                _ => Verdict::NoPlane,
            }
        }
        [Feature::Face(f1), _] if cso.shape_1.has_face(f1) => {
            test.face(cso.shape_1, cso.shape_2, cso.pose, [f1, v2], cost)
        }
        [_, Feature::Face(f2)] if cso.shape_2.has_face(f2) => {
            let pose = cso.pose.inverse();
            test.face(cso.shape_2, cso.shape_1, &pose, [f2, v1], cost)
                .mirrored(cso.pose)
        }
        _ => Verdict::NoPlane,
    }
}

/// A vertex of each feature, valid for its shape.
pub fn vertices<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    features: [Feature; 2],
) -> [VertexId; 2] {
    [
        vertex_of(cso.shape_1, features[0]),
        vertex_of(cso.shape_2, features[1]),
    ]
}

fn vertex_of(shape: &impl Polytope, feature: Feature) -> VertexId {
    let vertex = match feature {
        Feature::Vertex(v) => v,
        Feature::Edge(e) => shape.edge(e).map_or(0, |ends| ends[0]),
        Feature::Face(f) if shape.has_face(f) => shape.face_vertex(f, 0),
        Feature::Face(_) => 0,
    };
    shape.valid_start(vertex)
}

/// The features that the vertices of a simplex span. `normal` in frame 1, from shape 1 to 2.
pub(super) fn of_simplex<'v, A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    simplex: impl Iterator<Item = &'v CsoVertex> + Clone,
    normal: DVec3,
) -> [Feature; 2] {
    let ids_2 = simplex.clone().map(|v| v.ids[1]);
    let outward_2 = -cso.pose.direction_to_2(normal);
    [
        spanned(cso.shape_1, simplex.map(|v| v.ids[0]), normal),
        spanned(cso.shape_2, ids_2, outward_2),
    ]
}

fn spanned(
    shape: &impl Polytope,
    mut ids: impl Iterator<Item = VertexId>,
    outward: DVec3,
) -> Feature {
    let first = ids.next().unwrap_or(0);
    let mut second = None;
    for id in ids {
        match second {
            _ if id == first => {}
            None => second = Some(id),
            Some(s) if s == id => {}
            Some(_) => return Feature::Face(shape.face_at(first, outward)),
        }
    }
    match second {
        None => Feature::Vertex(first),
        // Two vertices without an edge between them are a diagonal of a face.
        Some(s) => match shape.edge_id(first, s) {
            Some(edge) => Feature::Edge(edge),
            None => Feature::Face(shape.face_at(first, outward)),
        },
    }
}

struct Test {
    max_distance: f64,
    tolerance: f64,
}

impl Test {
    /// A face of `p` against `q`; everything in the frame of `p`. `ids` are the face and a
    /// vertex of `q` to climb from.
    fn face<P: Polytope, Q: Polytope>(
        &self,
        p: &P,
        q: &Q,
        q_pose: &RelativePose,
        [face, start]: [u32; 2],
        cost: &mut Cost,
    ) -> Verdict {
        let normal = p.face_normal(face);
        if normal == DVec3::ZERO {
            return Verdict::NoPlane; // a sliver without a plane
        }
        let (on_q, q_id) = q.support(-q_pose.direction_to_2(normal), start, cost);
        let on_q = q_pose.point_to_1(on_q);
        let signed_distance = normal.dot(on_q) - p.face_offset(face);
        if signed_distance > self.max_distance {
            return Verdict::Apart(SeparatingAxis {
                axis: normal,
                separation: signed_distance,
                ids: [p.face_vertex(face, 0), q_id],
            });
        }
        let count = p.face_len(face);
        let corner = |i: usize| p.vertex(p.face_vertex(face, i)) - on_q;
        let vertex = |i: usize| {
            let id = p.face_vertex(face, i);
            let on_1 = p.vertex(id);
            CsoVertex {
                w: on_1 - on_q,
                on_1,
                ids: [id, q_id],
            }
        };
        let certified = Proximity {
            signed_distance,
            normal,
            on_1: on_q - normal * signed_distance,
            on_2: on_q,
            features: [Feature::Face(face), Feature::Vertex(q_id)],
        };
        if let Some(i) = side_beyond(count, corner, normal, self.tolerance) {
            return Verdict::Beyond(Side::new(vertex(i), vertex((i + 1) % count), normal));
        }
        let apex = p.center() - q_pose.point_to_1(q.center());
        let depth = -signed_distance - self.tolerance;
        if signed_distance >= 0.0 || pyramid_holds_ball(count, corner, apex, depth) {
            return Verdict::Certified(certified);
        }
        let mut seeds = Seeds::default();
        // Corners spread around the face, whatever their number.
        let spread = count.min(4);
        for i in 0..spread {
            seeds.push(vertex(i * count / spread));
        }
        seeds.push(CsoVertex {
            w: apex,
            on_1: p.center(),
            ids: seeds.points[0].ids,
        });
        Verdict::Unproved(seeds, certified)
    }

    /// Two edges that cross; everything in frame 1.
    fn edges<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        features: [Feature; 2],
        ends_1: [VertexId; 2],
        ends_2: [VertexId; 2],
        cost: &mut Cost,
    ) -> Verdict {
        let [a0, a1] = ends_1.map(|v| cso.shape_1.vertex(v));
        let [b0, b1] = ends_2.map(|v| cso.pose.point_to_1(cso.shape_2.vertex(v)));
        let (along_1, along_2) = (a1 - a0, b1 - b0);
        let cross = along_1.cross(along_2);
        let area_squared = cross.length_squared();
        let lengths = along_1.length_squared() * along_2.length_squared();
        let crossing_angle = area_squared.partial_cmp(&(PARALLEL_EDGES * lengths));
        if crossing_angle != Some(Ordering::Greater) {
            return Verdict::NoPlane;
        }
        let center = cso.center();
        let offset = a0 - b0;
        let outward = if cross.dot(offset - center) >= 0.0 {
            1.0
        } else {
            -1.0
        };
        let normal = cross * (outward / area_squared.sqrt());
        let extreme = cso.support(normal, [ends_1[0], ends_2[0]], cost);
        let signed_distance = -normal.dot(extreme.w);
        if signed_distance > self.max_distance {
            return Verdict::Apart(SeparatingAxis {
                axis: normal,
                separation: signed_distance,
                ids: extreme.ids,
            });
        }
        if -normal.dot(offset) - signed_distance > self.tolerance {
            return Verdict::Cut(extreme, normal);
        }
        // `along_1` then `-along_2` turn clockwise about `cross`.
        let turn = if outward < 0.0 {
            [0, 1, 2, 3]
        } else {
            [3, 2, 1, 0]
        };
        let vertices = turn.map(|i| {
            let (a, b) = ([0, 1, 1, 0][i], [0, 0, 1, 1][i]);
            let on_1 = [a0, a1][a];
            CsoVertex {
                w: on_1 - [b0, b1][b],
                on_1,
                ids: [ends_1[a], ends_2[b]],
            }
        });
        let corner = |i: usize| vertices[i].w;
        if let Some(i) = side_beyond(4, corner, normal, self.tolerance) {
            return Verdict::Beyond(Side::new(vertices[i], vertices[(i + 1) % 4], normal));
        }
        let [s, _] = crossing(offset, along_1, along_2);
        let on_1 = a0 + along_1 * s;
        let proximity = Proximity {
            signed_distance,
            normal,
            on_1,
            on_2: on_1 + normal * signed_distance,
            features,
        };
        let depth = -signed_distance - self.tolerance;
        if signed_distance >= 0.0 || pyramid_holds_ball(4, corner, center, depth) {
            return Verdict::Certified(proximity);
        }
        let mut seeds = Seeds::default();
        vertices.iter().for_each(|vertex| seeds.push(*vertex));
        seeds.push(center_seed(cso, extreme.ids));
        Verdict::Unproved(seeds, proximity)
    }
}

/// Where the lines `a + s along_1` and `b + t along_2`, `offset` being `a - b`, are nearest.
fn crossing(offset: DVec3, along_1: DVec3, along_2: DVec3) -> [f64; 2] {
    let cross = along_1.cross(along_2);
    let area_squared = cross.length_squared();
    [along_2, along_1].map(|along| -offset.dot(along.cross(cross)) / area_squared)
}

/// The witness points of a penetration depth, from its features where these determine them: a
/// facet may be larger than the triangle that was found of it.
pub(super) fn witnesses<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    features: [Feature; 2],
    depth: &Penetration,
) -> [DVec3; 2] {
    let through = depth.normal * depth.depth;
    match features {
        [Feature::Vertex(v), _] => {
            let on_1 = cso.shape_1.vertex(v);
            [on_1, on_1 - through]
        }
        [_, Feature::Vertex(v)] => {
            let on_2 = cso.pose.point_to_1(cso.shape_2.vertex(v));
            [on_2 + through, on_2]
        }
        [Feature::Edge(e1), Feature::Edge(e2)] => {
            edge_witnesses(cso, e1, e2).unwrap_or([depth.on_1, depth.on_2])
        }
        _ => [depth.on_1, depth.on_2],
    }
}

/// The nearest points of two edges that cross.
fn edge_witnesses<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    e1: u32,
    e2: u32,
) -> Option<[DVec3; 2]> {
    let [a0, a1] = cso.shape_1.edge(e1)?.map(|v| cso.shape_1.vertex(v));
    let [b0, b1] = cso
        .shape_2
        .edge(e2)?
        .map(|v| cso.pose.point_to_1(cso.shape_2.vertex(v)));
    let [s, t] = crossing(a0 - b0, a1 - a0, b1 - b0);
    let on_edges = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    on_edges.then(|| [a0.lerp(a1, s), b0.lerp(b1, t)])
}

/// The centre of the Minkowski difference: inside, so that it never is a corner of the answer.
/// `ids` only tell climbs where to start.
pub(super) fn center_seed<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    ids: [VertexId; 2],
) -> CsoVertex {
    CsoVertex {
        w: cso.center(),
        on_1: cso.shape_1.center(),
        ids,
    }
}

/// The side of a polygon, counter-clockwise about `normal`, beyond which the origin projects
/// farthest, as the index of its first corner; `None` if it projects inside, up to `tolerance`.
fn side_beyond(
    count: usize,
    corner: impl Fn(usize) -> DVec3,
    normal: DVec3,
    tolerance: f64,
) -> Option<usize> {
    let mut beyond = None;
    let mut farthest = tolerance * tolerance;
    let mut from = corner(count - 1);
    for i in 0..count {
        let to = corner(i);
        let inward = normal.cross(to - from);
        let height = -inward.dot(from);
        from = to;
        if height < 0.0 {
            let squared = height * height / inward.length_squared();
            if squared > farthest {
                farthest = squared;
                beyond = Some((i + count - 1) % count);
            }
        }
    }
    beyond
}

/// Whether the origin is at least `depth` inside of all side planes of the pyramid over a
/// polygon, counter-clockwise seen from outside, whose apex is beneath it.
fn pyramid_holds_ball(
    count: usize,
    corner: impl Fn(usize) -> DVec3,
    apex: DVec3,
    depth: f64,
) -> bool {
    let depth = depth.max(0.0);
    let mut from = corner(count - 1);
    (0..count).all(|i| {
        let to = corner(i);
        let inward = (to - from).cross(apex - from);
        let height = -inward.dot(from);
        from = to;
        height >= 0.0 && height * height >= depth * depth * inward.length_squared()
    })
}

impl Verdict {
    /// From the frame of shape 2, with the shapes swapped, to frame 1.
    fn mirrored(self, pose: &RelativePose) -> Self {
        match self {
            Self::Apart(apart) => Self::Apart(SeparatingAxis {
                axis: -pose.direction_to_1(apart.axis),
                separation: apart.separation,
                ids: [apart.ids[1], apart.ids[0]],
            }),
            Self::Certified(proximity) => Self::Certified(mirrored_proximity(&proximity, pose)),
            Self::Beyond(side) => Self::Beyond(Side {
                ends: side.ends.map(|vertex| mirrored(&vertex, pose)),
                normal: -pose.direction_to_1(side.normal),
                outward: -pose.direction_to_1(side.outward),
            }),
            Self::Cut(vertex, normal) => {
                Self::Cut(mirrored(&vertex, pose), -pose.direction_to_1(normal))
            }
            Self::Unproved(mut seeds, candidate) => {
                for seed in &mut seeds.points[..seeds.len] {
                    *seed = mirrored(seed, pose);
                }
                Self::Unproved(seeds, mirrored_proximity(&candidate, pose))
            }
            Self::NoPlane => Self::NoPlane,
        }
    }
}

fn mirrored(vertex: &CsoVertex, pose: &RelativePose) -> CsoVertex {
    CsoVertex {
        w: -pose.direction_to_1(vertex.w),
        on_1: pose.point_to_1(vertex.on_2()),
        ids: [vertex.ids[1], vertex.ids[0]],
    }
}

fn mirrored_proximity(p: &Proximity, pose: &RelativePose) -> Proximity {
    Proximity {
        signed_distance: p.signed_distance,
        normal: -pose.direction_to_1(p.normal),
        on_1: pose.point_to_1(p.on_2),
        on_2: pose.point_to_1(p.on_1),
        features: [p.features[1], p.features[0]],
    }
}
