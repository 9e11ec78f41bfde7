//! Face clusters: neighbouring faces that lie nearly in one plane, such as those of a scanned or triangulated
//! flat end. Bodies rest on whole clusters, not on single faces.

use super::graph::FaceCorner;
use super::lists::Rows;
use crate::at::to_u16;
use crate::support::FaceId;

/// The cluster of each face, and the faces under the outline of each cluster.
#[derive(Clone, Debug, Default)]
pub(super) struct FaceClusters {
    /// Empty if there are no clusters.
    of_face: Box<[u16]>,
    faces: Rows<u16>,
    /// The corners of the convex outlines.
    outlines: Rows<FaceCorner>,
}

/// A face that is in no cluster. There are fewer clusters than faces, which are fewer than this.
const NONE: u16 = u16::MAX;

impl FaceClusters {
    /// The number of the cluster that contains `face`, and all faces under its outline.
    #[inline]
    pub fn containing(&self, face: FaceId) -> Option<(usize, &[u16])> {
        let cluster = *self.of_face.get(face.index())?;
        (cluster != NONE).then(|| (cluster.into(), self.faces.row(cluster.into())))
    }

    pub fn outline(&self, cluster: usize) -> &[FaceCorner] {
        self.outlines.row(cluster)
    }

    pub fn heap_bytes(&self) -> usize {
        size_of::<Self>()
            + size_of_val(&*self.of_face)
            + self.faces.heap_bytes()
            + self.outlines.heap_bytes()
    }

    /// Adds a cluster of a hull with `faces` faces: its members, the other faces covered by its outline, and
    /// the corners of the outline.
    pub fn push(
        &mut self,
        faces: usize,
        members: &[u16],
        covered: Vec<u16>,
        outline: impl IntoIterator<Item = FaceCorner>,
    ) {
        if self.of_face.is_empty() {
            self.of_face = vec![NONE; faces].into();
        }
        let number = to_u16(self.faces.len());
        for &face in members {
            self.of_face[usize::from(face)] = number;
        }
        self.faces.push(members.iter().copied().chain(covered));
        self.outlines.push(outline);
    }
}
