//! From a facet of the Minkowski difference to the adjacent one, without building either.
//!
//! A side of a facet is an edge of one shape at a vertex of the other. Turn the facet's normal about the
//! edge, towards the normal of the face beyond it. Either it arrives there, and the face and the vertex span
//! the next facet; or an edge at the vertex comes level on the way, and the two edges span it. (On the sphere
//! of normals: follow an arc of one shape until it leaves the region of the other shape's vertex.)

use glam::DVec3;

use super::feature::Feature;
use super::verdict::FacetEdge;
use crate::arg_max::{ArgMax, ArgMax4};
use crate::map_pair::map_pair;
use crate::pose::RelativePose;
use crate::simd::{DVec3x4, f64x4, u64x4};
use crate::support::{Cso, CsoVertex, Polytope, VertexId};

/// The features of the facet across `side`. They are a proposal and still need to be certified. `None` if the
/// side is not an edge at a vertex.
pub(super) fn adjacent_facet<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    side: &FacetEdge,
) -> Option<[Feature; 2]> {
    let [[from_1, from_2], [to_1, to_2]] = side.ends;
    let (normal, outward) = (side.normal, side.outward);
    if from_2 == to_2 {
        let pair = EdgeVertexPair {
            edge: [from_1, to_1],
            vertex: from_2,
        };
        return pair.next(cso.shape_1, cso.shape_2, cso.pose, [normal, outward]);
    }
    if from_1 != to_1 {
        return None;
    }
    let pair = EdgeVertexPair {
        edge: [from_2, to_2],
        vertex: from_1,
    };
    // In shape 2's frame, an outward direction of shape 1 points into shape 2.
    let seen = map_pair([normal, outward], |dir| -cso.pose.direction_to_2(dir));
    let pose = cso.pose.inverse();
    let [feature_2, feature_1] = pair.next(cso.shape_2, cso.shape_1, &pose, seen)?;
    Some([feature_1, feature_2])
}

/// The features of a facet at `vertex`, which is extreme along `normal`. The normal is turned towards the
/// origin until it meets the first edge around the vertex, and then along that edge to a facet.
pub(super) fn facet_at_vertex<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    vertex: &CsoVertex,
    normal: DVec3,
) -> Option<[Feature; 2]> {
    let [id_1, id_2] = vertex.ids;
    let sideways = (normal * normal.dot(vertex.w) - vertex.w).try_normalize()?;
    let seen = map_pair([normal, sideways], |dir| -cso.pose.direction_to_2(dir));
    let first_1 = first_edge_crossed(cso.shape_1, id_1, [normal, sideways]);
    let first_2 = first_edge_crossed(cso.shape_2, id_2, seen);
    let (to, top) = if first_2.value > first_1.value {
        ([id_1, VertexId::new(first_2.id)], first_2)
    } else {
        ([VertexId::new(first_1.id), id_2], first_1)
    };
    if top.value == f64::NEG_INFINITY {
        return None;
    }
    let normal = (normal - sideways * top.value).normalize();
    let beside = (cso.vertex(to).w - vertex.w).cross(normal);
    let side = FacetEdge {
        ends: [vertex.ids, to],
        normal,
        outward: beside * beside.dot(sideways).signum(),
    };
    adjacent_facet(cso, &side)
}

/// The edge at a vertex of `p` that comes level first when the normal is turned sideways: minus the tangent
/// of the angle, and the vertex at its other end. The value is negative infinity if no edge does.
#[inline(always)]
fn first_edge_crossed<P: Polytope>(
    p: &P,
    vertex: VertexId,
    [normal, sideways]: [DVec3; 2],
) -> ArgMax<f64> {
    let mut first = ArgMax4::new(f64::NEG_INFINITY);
    for (ends, edges) in edges(p, vertex) {
        let (below, rise) = (edges.dot(normal).fast_min(f64x4::ZERO), edges.dot(sideways));
        let rises = rise.simd_gt(f64x4::ZERO);
        let turn = rises.bitselect(below / rise, f64x4::splat(f64::NEG_INFINITY));
        first.update(turn, ends);
    }
    first.finish()
}

/// The edges at a vertex in fours, and the vertices at their other ends.
#[inline(always)]
fn edges<P: Polytope>(p: &P, vertex: VertexId) -> impl Iterator<Item = (u64x4, DVec3x4)> {
    let corner = p.vertex(vertex);
    p.neighbors_in_fours(vertex).map(move |ends| {
        let ids = u64x4::new(ends.map(|end| u32::from(end).into()));
        (ids, DVec3x4::gather(ends, |end| p.vertex(end)) - corner)
    })
}

/// An edge of shape `p` at a vertex of shape `q`.
struct EdgeVertexPair {
    edge: [VertexId; 2],
    vertex: VertexId,
}

impl EdgeVertexPair {
    /// The features of `p` and `q` that span the next facet. `normal` and `outward`, in the frame of `p`, are
    /// the outward normal of the present facet, and the direction in its plane across the edge.
    fn next<P: Polytope, Q: Polytope>(
        &self,
        p: &P,
        q: &Q,
        q_pose: &RelativePose,
        [normal, outward]: [DVec3; 2],
    ) -> Option<[Feature; 2]> {
        let edge = p.edge_between(self.edge[0], self.edge[1])?;
        let face = p.face_at_edge(edge, outward);
        let beyond = p.face_normal(face);
        if beyond == DVec3::ZERO {
            return None; // no plane to turn to
        }
        let [first, last] = map_pair([normal, beyond], |n| -q_pose.direction_to_2(n));
        // The way between the normals is measured from 0 to 1. This is minus the way to where the first edge
        // comes level:
        let mut nearest = ArgMax4::new(-1.0);
        for (ends, edges) in edges(q, self.vertex) {
            let (below, above) = (edges.dot(first).fast_min(f64x4::ZERO), edges.dot(last));
            let rises = above.simd_gt(f64x4::ZERO);
            let way = rises.bitselect(below / (above - below), f64x4::splat(-1.0));
            nearest.update(way, ends);
        }
        let nearest = nearest.finish();
        Some(if nearest.value == -1.0 {
            [Feature::Face(face), Feature::Vertex(self.vertex)]
        } else {
            let level = q.edge_between(self.vertex, VertexId::new(nearest.id))?;
            [Feature::Edge(edge), Feature::Edge(level)]
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::hull::Hull;
    use crate::query::certificate::facet;
    use crate::query::verdict::Verdict;
    use crate::query::vertices;
    use crate::stats::Cost;
    use glam::Vec3;
    use parry3d::math::Pose;

    fn ball_of_points(count: usize, rng: &mut oorandom::Rand64) -> Hull {
        let points: Vec<Vec3> = (0..count).map(|_| direction(rng).as_vec3()).collect();
        Hull::from_points(&points).expect("points on a ball are their own hull")
    }

    pub fn direction(rng: &mut oorandom::Rand64) -> DVec3 {
        let [x, y, z] = [(); 3].map(|()| rng.rand_float() - 0.5);
        DVec3::new(x, y, z).normalize()
    }

    /// With any rotation, and up to `far` away.
    pub fn random_pose(far: f64, rng: &mut oorandom::Rand64) -> RelativePose {
        let turn = direction(rng) * 6.0 * rng.rand_float();
        let away = direction(rng) * far * rng.rand_float();
        RelativePose::new(&Pose::new(away.as_vec3(), turn.as_vec3())).expect("a finite pose")
    }

    /// How far the outermost vertex of the difference is beyond the plane of `features`.
    fn excess(cso: &Cso<'_, Hull, Hull>, features: [Feature; 2], normal: DVec3) -> f64 {
        let [v1, v2] = vertices(cso, features);
        let outermost = cso.support(normal, [v1, v2], &mut Cost::default()).w;
        let corner = cso.shape_1.vertex(v1) - cso.pose.point_to_1(cso.shape_2.vertex(v2));
        normal.dot(outermost - corner)
    }

    /// Each step, from the first facet at a vertex on, proposes another facet of the difference.
    #[test]
    fn the_walk_goes_from_facet_to_facet() {
        let mut rng = oorandom::Rand64::new(7);
        let mut crossed = 0;
        for _ in 0..200 {
            let hulls = [40, 12].map(|count| ball_of_points(count, &mut rng));
            let pose = random_pose(3.0, &mut rng);
            let cso = Cso {
                shape_1: &hulls[0],
                shape_2: &hulls[1],
                pose: &pose,
            };
            let normal = direction(&mut rng);
            let vertex = cso.support(normal, cso.start_vertices(normal), &mut Cost::default());
            let mut features =
                facet_at_vertex(&cso, &vertex, normal).expect("the origin is beside");
            for _ in 0..20 {
                let verdict = facet::certify(
                    &cso,
                    features,
                    || None,
                    [f64::INFINITY, 1e-6],
                    &mut Cost::default(),
                );
                let side = match verdict {
                    Verdict::OutsideEdge(side) => side,
                    Verdict::Certified(_) | Verdict::Undecided(..) => break,
                    _ => panic!("{features:?} is no facet"),
                };
                assert!(excess(&cso, features, side.normal) < 1e-6);
                let next = adjacent_facet(&cso, &side).expect("a side of a facet is a pair");
                assert_ne!(next, features);
                features = next;
                crossed += 1;
            }
        }
        assert!(crossed > 200, "only {crossed} sides were crossed");
    }
}
