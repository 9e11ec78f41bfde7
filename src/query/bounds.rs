//! A signed distance between two proved bounds.

use glam::DVec3;

/// Lower and upper bounds of the distance between two shapes, or of their depth if they overlap, with proofs
/// of both.
///
/// The *signed distance* is the distance of shapes that are apart, and minus the least translation that
/// separates shapes that overlap. It is between `lower` and `upper`. Everything is in frame 1, that of the
/// first shape. Make one with [`SeparationBounds::between`].
///
/// For shapes that overlap, `normal` is the direction of the shortest way out: moved by `-lower` along it,
/// shape 2 is outside shape 1. This proves an upper bound of the depth, and `certificate` proves a lower one.
#[derive(Clone, Debug)]
pub struct SeparationBounds {
    /// The lower bound of the signed distance. All of shape 1 is below the first of `planes`, all of shape 2
    /// is above the second, and this is how far the second plane is above the first.
    pub lower: f64,
    /// The upper bound of the signed distance, proved by `certificate`.
    pub upper: f64,
    /// The unit normal of the planes, from shape 1 to shape 2.
    pub normal: DVec3,
    /// The value of `normal · p` on each plane.
    pub planes: [f64; 2],
    /// The proof of the upper bound.
    pub certificate: Certificate,
    /// The sum of the widths of the shapes' rounded borders. A ball is a point with a border, and a capsule
    /// is a segment with one. The certificate refers to the shapes without their borders.
    pub border: f64,
}

/// The proof of an upper bound of a signed distance.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Certificate {
    /// A point of each shape without its border. The signed distance is at most their distance, less the
    /// borders.
    Points([DVec3; 2]),
    /// Triangles whose corners are points of the Minkowski difference: each is the difference `p - q` of a
    /// point of shape 1 and a point of shape 2, without their borders, written as `[p, q]`. The triangles
    /// form a closed surface around the origin, counter-clockwise seen from outside, and none of them is
    /// nearer to it than `-(upper + border)`. So the ball of this radius is in the difference, and shape 2
    /// must move at least that far, in any direction, to leave shape 1.
    Surface(Vec<[[DVec3; 2]; 3]>),
    /// One of the shapes is a half-space, and this is the other one's point, without its border, that is
    /// deepest in it or nearest above it. Its height over the plane is at most `upper + border`. Whichever way
    /// the point leaves, or comes, the way is no shorter than along the normal.
    Height(DVec3),
}
