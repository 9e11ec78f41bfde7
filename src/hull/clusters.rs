//! Face clusters: neighbouring faces that lie nearly in one plane, such as those of a scanned or triangulated
//! flat end. Bodies rest on whole clusters, not on single faces.

use crate::support::FaceId;

/// The cluster of each face, and the faces under the outline of each cluster. Whether a face belongs to a
/// cluster is stored with the face.
#[derive(Clone, Debug, Default)]
pub(super) struct FaceClusters {
    /// Empty if there are no clusters.
    of_face: Box<[u16]>,
    first: Box<[u32]>,
    faces: Box<[u16]>,
}

/// One cluster.
pub(super) struct FaceCluster {
    pub members: Vec<u16>,
    /// Faces that are not members, but lie partly under the outline where that cuts across a bay.
    pub covered_nonmembers: Vec<u16>,
    /// The corners of the convex outline.
    pub outline: Vec<u16>,
}

impl FaceClusters {
    pub fn new(clusters: &[FaceCluster], face_count: usize) -> Self {
        if clusters.is_empty() {
            return Self::default();
        }
        let mut of_face = vec![0; face_count];
        let mut first = vec![0];
        let mut faces = Vec::new();
        for (i, cluster) in clusters.iter().enumerate() {
            for &face in &cluster.members {
                of_face[usize::from(face)] = i as u16;
            }
            faces.extend_from_slice(&cluster.members);
            faces.extend_from_slice(&cluster.covered_nonmembers);
            first.push(faces.len() as u32);
        }
        Self {
            of_face: of_face.into(),
            first: first.into(),
            faces: faces.into(),
        }
    }

    /// The number of the cluster that contains `face`, and all faces under its outline. The face must be in a
    /// cluster.
    #[inline]
    pub fn containing(&self, face: FaceId) -> (usize, &[u16]) {
        let cluster = usize::from(self.of_face[face.index()]);
        let faces = self.first[cluster] as usize..self.first[cluster + 1] as usize;
        (cluster, &self.faces[faces])
    }

    pub fn heap_bytes(&self) -> usize {
        size_of_val(&*self.of_face) + size_of_val(&*self.first) + size_of_val(&*self.faces)
    }
}
