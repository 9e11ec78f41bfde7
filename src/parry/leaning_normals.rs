//! Pseudo-normals of triangles, for directions that lie in their planes too.

use glam::Vec3;
use parry3d::query::details::NormalConstraints;
use parry3d::shape::TrianglePseudoNormals;

use crate::tolerance::GRAZING;

/// Pseudo-normals of a triangle. A direction that lies in its plane up to rounding counts as one to its front, or, if it
/// has two sides, to that on which the other shape is. Hulls that stand upright in a floor have such normals.
pub(crate) struct LeaningNormals {
    normals: TrianglePseudoNormals,
    is_behind: bool,
}

impl LeaningNormals {
    /// For a shape that is beyond the triangle from `on_triangle` to `middle`.
    pub fn towards(middle: Vec3, on_triangle: Vec3, normals: TrianglePseudoNormals) -> Self {
        let is_behind = normals.two_sided && normals.face.dot(middle - on_triangle) < 0.0;
        Self { normals, is_behind }
    }
}

impl NormalConstraints for LeaningNormals {
    fn project_local_normal_mut(&self, normal: &mut Vec3) -> bool {
        let along_face = normal.dot(self.normals.face);
        let level = GRAZING as f32;
        let lean = if self.is_behind && (0.0..level).contains(&along_face) {
            -level
        } else if !self.is_behind && (-level..0.0).contains(&along_face) {
            level
        } else {
            0.0
        };
        if lean != 0.0 {
            *normal = (*normal + self.normals.face * lean).normalize();
        }
        self.normals.project_local_normal_mut(normal)
    }
}
