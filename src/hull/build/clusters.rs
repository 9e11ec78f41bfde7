//! Growing clusters of faces that lie nearly in one plane.

use glam::{DVec2, DVec3};

use super::faces::ClusterSeed;
use crate::hull::clusters::FaceCluster;
use crate::hull::faces::{FaceCorner, Faces};
use crate::hull::graph::EdgeGraph;
use crate::support::FaceId;
use crate::tolerance::CLUSTER_ANGLE_COS;

/// A cluster has at most this many members, so that one contact never has to process thousands of faces. The
/// rest of a larger flat region becomes another cluster.
const MAX_MEMBERS: usize = 64;

/// Grows clusters from these faces, the largest first.
pub(super) fn grow_clusters(
    points: &[DVec3],
    faces: &Faces,
    graph: &EdgeGraph,
    seeds: &[ClusterSeed],
) -> Vec<FaceCluster> {
    let mut clusters = Vec::new();
    if seeds.is_empty() {
        return clusters;
    }
    let mut taken = vec![false; faces.len()];
    let mut members = Vec::new();
    for &ClusterSeed { face, has_company } in seeds {
        let plane = SeedPlane::of(points, faces, face.into());
        if taken[usize::from(face)] || plane.normal == DVec3::ZERO {
            continue;
        }
        taken[usize::from(face)] = true;
        if !has_company {
            continue;
        }
        members.clear();
        members.push(face);
        let mut next = 0;
        while let Some(&member) = members.get(next) {
            for other in adjacent_faces(faces, graph, member) {
                let fits = members.len() < MAX_MEMBERS && !taken[usize::from(other)];
                if fits && plane.accepts(points, faces, other.into()) {
                    taken[usize::from(other)] = true;
                    members.push(other);
                }
            }
            next += 1;
        }
        if members.len() > 1 {
            let outline = plane.outline(points, faces, &members);
            clusters.push(FaceCluster {
                covered_nonmembers: covered_nonmembers(faces, graph, &members, &outline),
                members: members.clone(),
                outline,
            });
        }
    }
    clusters
}

/// The faces beyond the sides of a face.
fn adjacent_faces(faces: &Faces, graph: &EdgeGraph, face: u16) -> impl Iterator<Item = u16> {
    let sides = 0..faces.polygon(face.into()).len();
    sides.filter_map(move |i| {
        let [left, right] = graph.faces_of_edge(faces.edge(face.into(), i)?)?;
        Some(if left == face { right } else { left })
    })
}

/// The faces that are not members, but meet a vertex of a member inside the outline.
fn covered_nonmembers(
    faces: &Faces,
    graph: &EdgeGraph,
    members: &[u16],
    outline: &[u16],
) -> Vec<u16> {
    let corners = members.iter().flat_map(|&face| faces.polygon(face.into()));
    let inside = corners.map(|c| c.vertex).filter(|v| !outline.contains(v));
    let around = inside.flat_map(|vertex| graph.faces_around(vertex.into()).flatten());
    let mut covered_nonmembers: Vec<u16> = around.filter(|face| !members.contains(face)).collect();
    covered_nonmembers.sort_unstable();
    covered_nonmembers.dedup();
    covered_nonmembers
}

/// The plane of the face that a cluster grows from.
struct SeedPlane {
    normal: DVec3,
    corner: DVec3,
}

impl SeedPlane {
    fn of(points: &[DVec3], faces: &Faces, face: FaceId) -> Self {
        Self {
            normal: faces.normal(face),
            corner: points[usize::from(faces.polygon(face)[0].vertex)],
        }
    }

    /// Whether a face and all of its corners, seen from the seed, lie within the cluster's angle. A sliver
    /// has no plane and is judged by its corners alone.
    fn accepts(&self, points: &[DVec3], faces: &Faces, face: FaceId) -> bool {
        let sine = (1.0 - CLUSTER_ANGLE_COS * CLUSTER_ANGLE_COS).sqrt();
        let near = |corner: &FaceCorner| {
            let from_corner = points[usize::from(corner.vertex)] - self.corner;
            self.normal.dot(from_corner) >= -sine * from_corner.length()
        };
        let other = faces.normal(face);
        let aligned = other == DVec3::ZERO || other.dot(self.normal) >= CLUSTER_ANGLE_COS;
        aligned && faces.polygon(face).iter().all(near)
    }

    /// The convex outline of faces seen against the normal, counter-clockwise (Andrew, *Another
    /// efficient algorithm for convex hulls in two dimensions*, IPL 9(5), 1979).
    fn outline(&self, points: &[DVec3], faces: &Faces, members: &[u16]) -> Vec<u16> {
        let u = self.normal.any_orthonormal_vector();
        let v = self.normal.cross(u);
        let mut corners: Vec<(DVec2, u16)> = members
            .iter()
            .flat_map(|&face| faces.polygon(face.into()))
            .map(|&FaceCorner { vertex, .. }| {
                let p = points[usize::from(vertex)] - self.corner;
                (DVec2::new(p.dot(u), p.dot(v)), vertex)
            })
            .collect();
        corners
            .sort_by(|(a, i), (b, j)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(i.cmp(j)));
        corners.dedup();
        let mut outline = half_outline(corners.iter());
        outline.extend(half_outline(corners.iter().rev()));
        outline
    }
}

/// Half of an outline, from the first point up to the last, which is left out.
fn half_outline<'a>(corners: impl Iterator<Item = &'a (DVec2, u16)>) -> Vec<u16> {
    let mut chain: Vec<(DVec2, u16)> = Vec::new();
    for &corner in corners {
        while let [.., (a, _), (b, _)] = chain[..]
            && (b - a).perp_dot(corner.0 - a) <= 0.0
        {
            chain.pop();
        }
        chain.push(corner);
    }
    chain.pop();
    chain.into_iter().map(|(_, vertex)| vertex).collect()
}
