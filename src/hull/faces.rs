//! The faces of a hull (polygons with their planes), and the outlines of clusters.

use std::sync::OnceLock;

use glam::{DVec3, Vec3};

use super::clusters::FaceClusters;
use super::graph::{FaceCorner, NO_EDGE, pack_edge};
use crate::at::At;
use crate::face_planes::FacePlanes;
use crate::oriented_box::OrientedBox;
use crate::support::{EdgeId, FaceCorners, FaceId, VertexId};
use crate::tuning::ROUND_SIDES;

/// The faces, and the clusters of some of them.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    /// There is one more entry, which ends the corners of the last one.
    pub(super) polygons: Box<[FaceRecord]>,
    pub(super) count: usize,
    pub(super) corners: Box<[FaceCorner]>,
    /// Grown when the first of them is looked up: few hulls ever rest on one.
    pub(super) clusters: OnceLock<Box<FaceClusters>>,
    planes: FacePlanes,
    /// Whether there may be a side as of a prism that rolls.
    pub has_many_quads: bool,
}

/// A face with its supporting plane. Values that are read together lie together, since large hulls do not
/// fit into the nearest cache.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceRecord {
    /// Rounded to f32; the offset is exact for that normal.
    pub(super) normal: Vec3,
    /// Its first corner, with a mark. The others follow, up to the first corner of the next polygon.
    pub(super) first: u32,
    pub(super) offset: f64,
}

/// The mark of a face with a neighbour of about the same direction: only such faces are in clusters. Most
/// faces have none, and then nothing else need be read. No hull has so many corners that the bit is in use.
pub(super) const HAS_SIMILAR_NEIGHBOR: u32 = 1 << 31;

/// A face or an outline, with the points of its hull.
#[derive(Clone, Copy)]
pub(super) struct PolygonCorners<'a> {
    pub points: &'a [Vec3],
    pub corners: &'a [FaceCorner],
}

impl FaceCorners for PolygonCorners<'_> {
    #[inline]
    fn count(self) -> usize {
        self.corners.len()
    }

    #[inline]
    fn vertex(self, i: usize) -> VertexId {
        self.corners[i].vertex.into()
    }

    #[inline]
    fn point(self, i: usize) -> Vec3 {
        self.points[usize::from(self.corners[i].vertex)]
    }

    #[inline]
    fn edge(self, i: usize) -> Option<EdgeId> {
        edge(self.corners, i)
    }
}

/// The id of the `i`-th side of a polygon, if that side is an edge.
#[inline]
fn edge(corners: &[FaceCorner], i: usize) -> Option<EdgeId> {
    let FaceCorner { vertex, slot } = corners[i];
    let next = corners[if i + 1 < corners.len() { i + 1 } else { 0 }].vertex;
    (slot != NO_EDGE).then(|| pack_edge(vertex.min(next).into(), slot))
}

impl FaceRecord {
    /// What comes after the last face: only where its corners end is read.
    pub(super) fn end(corners: &[FaceCorner]) -> Self {
        Self {
            normal: Vec3::ZERO,
            first: corners.short_len(),
            offset: f64::INFINITY,
        }
    }

    #[inline]
    fn first(&self) -> usize {
        (self.first & !HAS_SIMILAR_NEIGHBOR) as usize
    }
}

impl Faces {
    /// From the faces, with an end, and their corners.
    pub(super) fn from_lists(
        polygons: Box<[FaceRecord]>,
        corners: Box<[FaceCorner]>,
        radius: f64,
    ) -> Self {
        let count = polygons.len() - 1;
        let planes = polygons[..count]
            .iter()
            .map(|face| (face.normal, face.offset));
        let ends = polygons
            .windows(2)
            .map(|pair| [pair[0].first(), pair[1].first()]);
        let are_triangles = corners.len() == 3 * count;
        let has_many_quads =
            !are_triangles && ends.filter(|[first, end]| end - first == 4).count() >= ROUND_SIDES;
        Self {
            planes: FacePlanes::new(planes, radius),
            has_many_quads,
            polygons,
            count,
            corners,
            clusters: OnceLock::new(),
        }
    }

    /// The box that the hull is, if it is one.
    pub(super) fn oriented_box(&self, points: &[Vec3], radius: f64) -> Option<Box<OrientedBox>> {
        let faces = &self.polygons[..self.count];
        let normals = faces.iter().map(|face| face.normal);
        OrientedBox::with_corners(points, normals, radius).map(Box::new)
    }

    /// The planes of all faces.
    #[inline]
    pub fn planes(&self) -> &FacePlanes {
        &self.planes
    }

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
        if f < self.count {
            &self.corners[self.polygons[f].first()..self.polygons[f + 1].first()]
        } else {
            self.outline(f - self.count)
        }
    }

    #[cold]
    #[inline(never)]
    fn outline(&self, cluster: usize) -> &[FaceCorner] {
        let clusters = self.clusters.get();
        clusters.map_or(&[], |clusters| clusters.outline(cluster))
    }

    /// The id of the `i`-th side of a face or an outline, if that side is an edge.
    #[inline]
    pub fn edge(&self, face: FaceId, i: usize) -> Option<EdgeId> {
        edge(self.polygon(face), i)
    }

    /// Whether a neighbour of a face has about the same direction.
    #[inline]
    pub fn has_similar_neighbor(&self, face: FaceId) -> bool {
        self.polygons[face.index()].first & HAS_SIMILAR_NEIGHBOR != 0
    }

    /// The cluster that a face belongs to: the id of its outline, and the faces under the outline. `grow` finds
    /// all clusters when the first of them is looked up.
    #[inline]
    pub fn cluster(
        &self,
        face: FaceId,
        grow: impl FnOnce() -> Box<FaceClusters>,
    ) -> Option<(FaceId, &[u16])> {
        if !self.has_similar_neighbor(face) {
            return None;
        }
        let (cluster, faces) = self.clusters.get_or_init(grow).containing(face)?;
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

    /// With clusters, if they have been grown.
    pub fn heap_bytes(&self) -> usize {
        let clusters = self
            .clusters
            .get()
            .map_or(0, |clusters| clusters.heap_bytes());
        size_of_val(&*self.polygons)
            + size_of_val(&*self.corners)
            + self.planes.heap_bytes()
            + clusters
    }
}
