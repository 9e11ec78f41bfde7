//! Grows the face clusters of a hull, when the first of them is looked up.

use glam::{DVec2, DVec3, Vec3};

use super::clusters::FaceClusters;
use super::convex_outline::{convex_outline, crosses};
use super::faces::Faces;
use super::graph::{EdgeGraph, FaceCorner, NO_EDGE};
use super::lists::largest_first;
use crate::support::FaceId;
use crate::tolerance::CLUSTER_ANGLE_COS;

/// A cluster has at most this many members, so that one contact never has to process thousands of faces. The
/// rest of a larger flat region becomes another cluster.
const MAX_MEMBERS: usize = 64;

/// Grows clusters from the faces with a neighbour of about the same direction, the largest first.
pub(super) fn grow_clusters(points: &[Vec3], faces: &Faces, graph: &EdgeGraph) -> FaceClusters {
    let mut clusters = FaceClusters::default();
    let mut taken: Vec<bool> = (0..faces.len())
        .map(|face| !faces.has_similar_neighbor(FaceId::new(face)))
        .collect();
    for seed in seeds(points, faces) {
        if taken[usize::from(seed)] || faces.normal(seed.into()) == DVec3::ZERO {
            continue;
        }
        let mut cluster = Cluster::new(points, faces, graph, seed);
        cluster.grow(&mut taken);
        if cluster.members.len() > 1 {
            cluster.add_to(&mut clusters);
        }
    }
    clusters
}

/// The faces with a neighbour of about the same direction, the largest first.
fn seeds(points: &[Vec3], faces: &Faces) -> impl Iterator<Item = u16> {
    let seeds = (0..)
        .take(faces.len())
        .filter(|&face: &u16| faces.has_similar_neighbor(face.into()));
    largest_first(seeds, |face| area(points, faces, face))
}

/// Twice the area of a face.
fn area(points: &[Vec3], faces: &Faces, face: u16) -> f64 {
    let corners = faces.polygon(face.into());
    let first = at_first(points, corners);
    let at = |i: usize| points[usize::from(corners[i].vertex)].as_dvec3() - first;
    let fan = (1..corners.len() - 1).map(|i| at(i).cross(at(i + 1)));
    fan.sum::<DVec3>().length()
}

fn at_first(points: &[Vec3], corners: &[FaceCorner]) -> DVec3 {
    points[usize::from(corners[0].vertex)].as_dvec3()
}

/// A cluster that grows.
struct Cluster<'a> {
    points: &'a [Vec3],
    faces: &'a Faces,
    graph: &'a EdgeGraph,
    /// The plane of the face that it grows from.
    normal: DVec3,
    corner: DVec3,
    /// Two unit vectors in it.
    axes: [DVec3; 2],
    members: Vec<u16>,
}

impl<'a> Cluster<'a> {
    fn new(points: &'a [Vec3], faces: &'a Faces, graph: &'a EdgeGraph, seed: u16) -> Self {
        let normal = faces.normal(seed.into());
        let u = normal.any_orthonormal_vector();
        Self {
            points,
            faces,
            graph,
            normal,
            axes: [u, normal.cross(u)],
            corner: at_first(points, faces.polygon(seed.into())),
            members: vec![seed],
        }
    }

    fn add_to(&self, clusters: &mut FaceClusters) {
        let corners = self.corners().map(|corner| self.place(corner.vertex));
        let outline = convex_outline(corners.collect());
        let covered = self.covered_nonmembers(&outline);
        let ends = outline.iter().cycle().skip(1);
        let corners = outline.iter().zip(ends).map(|(&(_, from), &(_, to))| {
            let slot = self.graph.edge_slot(from.into(), to.into());
            FaceCorner {
                vertex: from,
                slot: slot.unwrap_or(NO_EDGE),
            }
        });
        clusters.push(self.faces.len(), &self.members, covered, corners);
    }

    fn grow(&mut self, taken: &mut [bool]) {
        taken[usize::from(self.members[0])] = true;
        let mut next = 0;
        while let Some(&member) = self.members.get(next) {
            let polygon: FaceId = member.into();
            for side in 0..self.faces.polygon(polygon).len() {
                let Some(other) = self.face_beyond(member, side) else {
                    continue;
                };
                let fits = self.members.len() < MAX_MEMBERS && !taken[usize::from(other)];
                if fits && self.accepts(other.into()) {
                    taken[usize::from(other)] = true;
                    self.members.push(other);
                }
            }
            next += 1;
        }
    }

    /// The face beyond a side of a face.
    fn face_beyond(&self, face: u16, side: usize) -> Option<u16> {
        let edge = self.faces.edge(face.into(), side)?;
        let [left, right] = self.graph.faces_of_edge(edge)?;
        Some(if left == face { right } else { left })
    }

    fn way_to(&self, corner: &FaceCorner) -> DVec3 {
        self.points[usize::from(corner.vertex)].as_dvec3() - self.corner
    }

    /// Whether a face and all of its corners, seen from the first face, lie within the cluster's angle. A
    /// sliver has no plane and is judged by its corners alone.
    fn accepts(&self, face: FaceId) -> bool {
        let sine = (1.0 - CLUSTER_ANGLE_COS * CLUSTER_ANGLE_COS).sqrt();
        let near = |corner: &FaceCorner| {
            let way = self.way_to(corner);
            self.normal.dot(way) >= -sine * way.length()
        };
        let other = self.faces.normal(face);
        let aligned = other == DVec3::ZERO || other.dot(self.normal) >= CLUSTER_ANGLE_COS;
        aligned && self.faces.polygon(face).iter().all(near)
    }

    fn corners(&self) -> impl Iterator<Item = &'a FaceCorner> {
        let faces = self.faces;
        let members = self.members.iter();
        members.flat_map(move |&face| faces.polygon(face.into()))
    }

    /// A vertex seen against the normal.
    fn place(&self, vertex: u16) -> (DVec2, u16) {
        let p = self.points[usize::from(vertex)].as_dvec3() - self.corner;
        (self.axes.map(|axis| p.dot(axis)).into(), vertex)
    }

    /// The faces that are not members, but lie partly under the outline, where it cuts across a bay: those around a
    /// vertex of a member inside it, and those beyond edges that cross it, from one face to the next.
    fn covered_nonmembers(&self, outline: &[(DVec2, u16)]) -> Vec<u16> {
        let is_inside = |v: &u16| outline.iter().all(|(_, corner)| corner != v);
        let inside = self.corners().map(|c| c.vertex).filter(is_inside);
        let around = inside.flat_map(|vertex| self.graph.faces_around(vertex.into()).flatten());
        let mut covered: Vec<u16> = around.filter(|face| !self.members.contains(face)).collect();
        covered.sort_unstable();
        covered.dedup();
        let mut next = 0;
        while let Some(&face) = covered.get(next) {
            for side in 0..self.faces.polygon(face.into()).len() {
                if let Some(other) = self.seen_beyond(face, side)
                    && !self.members.contains(&other)
                    && !covered.contains(&other)
                    && crosses(self.side(face, side), outline)
                {
                    covered.push(other);
                }
            }
            next += 1;
        }
        covered
    }

    /// The face beyond a side of a face, if it is seen against the normal or a sliver.
    fn seen_beyond(&self, face: u16, side: usize) -> Option<u16> {
        let other = self.face_beyond(face, side)?;
        let normal = self.faces.normal(other.into());
        (normal == DVec3::ZERO || normal.dot(self.normal) > 0.0).then_some(other)
    }

    /// Both ends of a side of a face, seen against the normal.
    fn side(&self, face: u16, side: usize) -> [DVec2; 2] {
        let corners = self.faces.polygon(face.into());
        [side, (side + 1) % corners.len()].map(|i| self.place(corners[i].vertex).0)
    }
}
