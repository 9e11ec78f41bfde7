//! Distance sub-algorithms: the point of a simplex nearest to the origin.
//!
//! Three algorithms for one problem, which can be compared and exchanged freely. Each returns a convex
//! combination of the vertices, whatever rounding does to its case distinctions: a wrong decision costs
//! distance, never membership. Coordinates may range from 1e-40 to 1e40; beyond that, products over- or
//! underflow, and the answer degrades to a vertex.

mod faces;
mod johnson;
mod signed_volumes;
mod voronoi;

use faces::Combination;
use glam::DVec3;

pub use johnson::Johnson;
pub use signed_volumes::SignedVolumes;
pub use voronoi::Voronoi;

/// The one that our queries use. On hulls, GJK is as fast with it as with any other.
pub(crate) type Preferred = SignedVolumes;

/// The point of a simplex nearest to the origin, and the smallest face that contains it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Nearest {
    /// v(conv Y): the nearest point; exactly zero if the origin is inside a tetrahedron.
    pub point: DVec3,
    /// Bit i is set if vertex i belongs to the smallest face that contains the point.
    pub face: u8,
    /// Barycentric coordinates with the sum 1; zero outside `face`.
    pub lambda: [f64; 4],
}

impl From<Combination<4>> for Nearest {
    #[inline]
    fn from(Combination { point, lambda }: Combination<4>) -> Self {
        let face = (0..4).fold(0, |face, i| face | (u8::from(lambda[i] > 0.0) << i));
        let point = if face == 0b1111 { DVec3::ZERO } else { point };
        Self {
            point,
            face,
            lambda,
        }
    }
}

/// Finds the point of a simplex nearest to the origin. Implementations have no size: the choice is made at
/// compile time.
pub trait DistanceSubalgorithm {
    /// `points` are 1 to 4 vertices, in any order and position, degenerate or not. (Without vertices, the
    /// answer is the origin with an empty face.)
    fn nearest(points: &[DVec3]) -> Nearest;
}
