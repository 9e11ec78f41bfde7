//! Small hulls that bend clearly at every edge between two faces, such as debris. One walk around each vertex
//! finds what a [`Surface`](super::surface::Surface) finds in many passes. The hulls are the same.

mod areas;
mod around;
mod builder;
#[cfg(test)]
mod tests;
mod walk;

use std::cell::RefCell;

use glam::Vec3;

use crate::hull::Hull;
use crate::hull::lists::Rows;
use builder::SteepBuilder;

thread_local! {
    /// Memory to work in.
    static BUILDER: RefCell<SteepBuilder> = RefCell::default();
}

/// The hull with this surface, in any order of the triangles. Some of them are strips of flat polygons, which are
/// strictly convex and begin at their lowest corner. `None` if the hull is large, or hardly bends somewhere, or does
/// not pass the checks.
pub(super) fn steep_hull(
    points: &[Vec3],
    triangles: &[[u32; 3]],
    polygons: &Rows<u32>,
) -> Option<Hull> {
    let build = |builder: &mut SteepBuilder| builder.hull(points, triangles, polygons);
    // A thread that ends may have dropped it.
    let built = BUILDER.try_with(|builder| build(&mut builder.borrow_mut()));
    built.unwrap_or_else(|_| build(&mut SteepBuilder::default()))
}
