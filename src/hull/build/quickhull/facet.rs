//! A triangle of a growing hull, and the points above it.

use glam::DVec3;

use super::orientation::ExactPlane;
use crate::at::At;

/// No point.
pub(super) const NONE: u32 = u32::MAX;

/// A triangle of the surface.
pub(super) struct HullFacet {
    /// Counter-clockwise from outside.
    pub vertices: [u32; 3],
    pub plane: ExactPlane,
    /// The facets beyond the sides from each vertex to the next.
    pub beyond: [u32; 3],
    /// The last point of its outside set, or `NONE`. Each point is in the set of one of the facets that it is above.
    pub last_above: u32,
    /// The highest of these points.
    pub peak: (f64, u32),
    pub is_removed: bool,
}

impl HullFacet {
    pub fn new(vertices: [u32; 3], plane: ExactPlane, beyond: [u32; 3]) -> Self {
        Self {
            vertices,
            plane,
            beyond,
            last_above: NONE,
            peak: (0.0, 0),
            is_removed: false,
        }
    }

    /// Notes a point above it.
    #[inline]
    pub fn raise_peak(&mut self, point: u32, height: f64, points: &[DVec3]) {
        // Among points in a plane, the first and last in coordinate order are corners.
        let place = |v: u32| points.at(v).to_array();
        let is_as_high = || height == self.peak.0 && place(point) > place(self.peak.1);
        if height > self.peak.0 || is_as_high() {
            self.peak = (height, point);
        }
    }
}
