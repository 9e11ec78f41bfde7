//! A shape as its extreme points.

use glam::DVec3;

use crate::ids::{ShapeId, VertexId};
use crate::stats::Cost;

/// A convex shape as its support mapping, in its own frame.
pub trait Support {
    /// A point that is extreme in direction `dir` (of any length), and its vertex.
    ///
    /// `start` is the vertex where the search begins, usually the answer of a similar query. A bad choice
    /// costs time, never accuracy.
    ///
    /// # Panics
    ///
    /// May panic if the shape has no vertex `start`: see [`clamp_vertex`](Self::clamp_vertex).
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId);

    /// The greatest `dir · p` over the shape. This is exact even on a surface that rounding has dented, where
    /// [`support`](Self::support) may find a vertex that is only nearly extreme.
    #[inline]
    fn extent(&self, dir: DVec3) -> f64 {
        let start = self.start_vertex(dir);
        let (extreme, _) = self.support(dir, start, &mut Cost::default());
        dir.dot(extreme)
    }

    /// A start vertex for [`support`](Self::support) if no similar query is known.
    #[inline]
    fn start_vertex(&self, _dir: DVec3) -> VertexId {
        VertexId::default()
    }

    /// `vertex` if the shape has it, and some other vertex if not.
    #[inline]
    fn clamp_vertex(&self, _vertex: VertexId) -> VertexId {
        VertexId::default()
    }

    /// An upper bound of the greatest `dir · p` over the shape, for about a unit vector `dir`. It is close where
    /// there is one that costs less than a support point.
    fn extent_bound(&self, dir: DVec3, cost: &mut Cost) -> Option<f64> {
        let _ = (dir, cost);
        None
    }

    /// How far the shape may reach beyond a support point, if that is rounded to f32.
    fn rounding(&self) -> f64 {
        0.0
    }

    /// Whether contacts roll over a round surface if their outward unit normal turns from one to another.
    #[inline]
    fn rolls(&self, _from: DVec3, _to: DVec3) -> bool {
        false
    }

    /// Whether [`rolls`](Self::rolls) is worth a question.
    #[inline]
    fn may_roll(&self) -> bool {
        true
    }

    /// Tells the shape from all others, if it has such an id.
    #[doc(hidden)]
    fn id(&self) -> Option<ShapeId> {
        None
    }

    /// A point inside, and not on the boundary if the shape has volume.
    #[inline]
    fn center(&self) -> DVec3 {
        DVec3::ZERO
    }

    /// The largest distance of a point from [`center`](Self::center).
    fn radius(&self) -> f64;
}
