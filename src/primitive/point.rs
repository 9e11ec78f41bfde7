//! A point.

use glam::DVec3;

use crate::stats::Cost;
use crate::support::{Support, VertexId};

/// The origin as a shape.
pub(crate) struct Point;

impl Support for Point {
    fn support(&self, _: DVec3, _: VertexId, _: &mut Cost) -> (DVec3, VertexId) {
        (DVec3::ZERO, VertexId::default())
    }

    fn radius(&self) -> f64 {
        0.0
    }
}
