//! The areas of the triangles of a surface, coordinate by coordinate.

use glam::DVec3;

use crate::hull::build::adjacency::TRIANGLES;
use crate::hull::build::area_vectors::FourAreaVectors;
use crate::simd::LANES;

/// Twice the area of each triangle: the coordinates of a vector, and its length.
pub(super) struct Areas(Box<[[f64; TRIANGLES]; 4]>);

impl Default for Areas {
    fn default() -> Self {
        Self(Box::new([[0.0; _]; _]))
    }
}

impl Areas {
    /// Stores the areas of the `number`-th four triangles.
    #[inline]
    pub fn set_four(&mut self, number: usize, four: &FourAreaVectors) {
        let first = number * LANES % TRIANGLES;
        let [x, y, z] = four.vectors.0;
        for (row, values) in self.0.iter_mut().zip([x, y, z, four.areas]) {
            row[first..][..LANES].copy_from_slice(&values.to_array());
        }
    }

    #[inline]
    pub fn vector(&self, triangle: usize) -> DVec3 {
        let [x, y, z, _] = &*self.0;
        let t = triangle % TRIANGLES;
        DVec3::new(x[t], y[t], z[t])
    }

    #[inline]
    pub fn length(&self, triangle: usize) -> f64 {
        self.0[3][triangle % TRIANGLES]
    }
}
