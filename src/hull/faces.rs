//! The faces of a hull (polygons with their planes), and the outlines of clusters.

use glam::{DVec3, Vec3};

use super::clusters::FaceClusters;
use super::graph::pack_edge;
use crate::support::{EdgeId, FaceId};

/// The faces, followed by the outlines of the clusters.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    /// There is one more entry, which ends the corners of the last one.
    pub(super) polygons: Box<[FaceRecord]>,
    pub(super) count: usize,
    pub(super) corners: Box<[FaceCorner]>,
    pub(super) clusters: FaceClusters,
}

/// A face with its supporting plane, or an outline. Values that are read together lie together, since large
/// hulls do not fit into the nearest cache.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceRecord {
    /// Rounded to f32; the offset is exact for that normal.
    pub(super) normal: Vec3,
    /// Its first corner, with a mark. The others follow, up to the first corner of the next polygon.
    pub(super) first: u32,
    pub(super) offset: f64,
}

/// The mark of a face that belongs to a cluster. Most faces do not, and then nothing else need be read. No
/// hull has so many corners that the bit is in use.
pub(super) const IN_CLUSTER: u32 = 1 << 31;

impl FaceRecord {
    #[inline]
    fn first(&self) -> usize {
        (self.first & !IN_CLUSTER) as usize
    }
}

/// A corner of a polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceCorner {
    pub vertex: u16,
    /// The slot of the edge that starts here: its id is made of this and of its lower vertex.
    pub(super) slot: u16,
}

/// The slot of a side that is no edge, but cuts across faces.
pub(super) const NO_EDGE: u16 = u16::MAX;

impl Faces {
    pub fn len(&self) -> usize {
        self.count
    }

    #[inline]
    pub fn normal(&self, face: FaceId) -> DVec3 {
        self.polygons[face.index()].normal.as_dvec3()
    }

    #[inline]
    pub fn offset(&self, face: FaceId) -> f64 {
        self.polygons[face.index()].offset
    }

    /// The corners of a face or of an outline.
    #[inline]
    pub fn polygon(&self, face: FaceId) -> &[FaceCorner] {
        let f = face.index();
        &self.corners[self.polygons[f].first()..self.polygons[f + 1].first()]
    }

    /// The id of the `i`-th side of a face or an outline, if that side is an edge.
    #[inline]
    pub fn edge(&self, face: FaceId, i: usize) -> Option<EdgeId> {
        let corners = self.polygon(face);
        let FaceCorner { vertex, slot } = corners[i];
        let next = corners[if i + 1 < corners.len() { i + 1 } else { 0 }].vertex;
        (slot != NO_EDGE).then(|| pack_edge(vertex.min(next).into(), slot))
    }

    /// The cluster that a face belongs to: the id of its outline, and the faces under the outline.
    #[inline]
    pub fn cluster(&self, face: FaceId) -> Option<(FaceId, &[u16])> {
        if self.polygons[face.index()].first & IN_CLUSTER == 0 {
            return None;
        }
        let (cluster, faces) = self.clusters.containing(face);
        Some((FaceId::new(self.len() + cluster), faces))
    }

    /// The face whose normal is nearest to direction `dir`.
    #[inline]
    pub fn most_aligned<const N: usize>(
        &self,
        candidates: impl IntoIterator<Item = [u16; N]>,
        dir: DVec3,
    ) -> FaceId {
        let (mut best, mut most) = (0, f64::NEG_INFINITY);
        for faces in candidates {
            for face in faces {
                let aligned = self.normal(face.into()).dot(dir);
                // Selections, not branches: which face is better is not predictable.
                let better = aligned > most;
                most = if better { aligned } else { most };
                best = if better { face } else { best };
            }
        }
        best.into()
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.polygons) + size_of_val(&*self.corners) + self.clusters.heap_bytes()
    }
}
