//! The whole region of contact, as a polygon: where both faces lie over each other and are near enough.

use glam::{DVec3, Vec2};

use super::clip::{Clipper, VertexOrigin};
use super::patch::SurfacePair;
use super::scratch::ClipScratch;
use crate::query::{Feature, Proximity};
use crate::simd::f32x4;
use crate::support::{Cso, FaceCorners, Polytope};

/// A corner of the region of contact.
#[derive(Clone, Copy, Debug)]
pub struct PatchCorner {
    /// On the first shape, in frame 1.
    pub on_1: DVec3,
    /// The distance to the second shape along the normal.
    pub distance: f64,
    /// The features that meet there.
    pub features: [Feature; 2],
}

/// A corner in the contact plane.
#[derive(Clone, Copy)]
struct Corner {
    at: Vec2,
    distance: f32,
    origin: Origin,
}

#[derive(Clone, Copy)]
enum Origin {
    /// A corner of the intersection of the two faces.
    Clip(usize),
    /// Where the surfaces become too far apart, between these two corners.
    Cut([usize; 2]),
}

/// The corners of the region in which the surfaces around the witness are at most `max_distance` apart,
/// counter-clockwise seen from shape 2. There are none if only the witness is that near, or if its faces are
/// edge-on.
pub fn contact_polygon<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    near: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Vec<PatchCorner> {
    let ClipScratch {
        planes, clipper, ..
    } = scratch;
    let Some(patch) = SurfacePair::new(cso, near, near.normal, planes) else {
        return Vec::new();
    };
    let polygons = patch.polygons(cso);
    patch.clip(polygons, clipper);
    let corners = outline(corners(&patch, clipper));
    let corners = cut(&patch, &corners, max_distance as f32);
    let features = |corner: &Corner| match corner.origin {
        Origin::Clip(i) => patch.features(polygons, clipper, i),
        Origin::Cut(ends) => {
            let side = common_side(ends.map(|i| clipper.origin(i)), clipper);
            patch.features_on_side(polygons, side, corner.at)
        }
    };
    let corners = corners.iter().map(|corner| PatchCorner {
        on_1: patch.on_1(corner.at),
        // Along the query's normal nothing is deeper than the query's answer.
        distance: f64::from(corner.distance).max(near.signed_distance),
        features: features(corner),
    });
    corners.collect()
}

impl SurfacePair<'_> {
    /// The point of the first surface over a place in the contact plane.
    fn on_1(&self, at: Vec2) -> DVec3 {
        let [x, y] = [at.x, at.y].map(f32x4::splat);
        let points = self.projections[0].points(x, y, self.surfaces[0].heights(x, y));
        DVec3::from(points.map(|row| f64::from(row.to_array()[0])))
    }

    /// The features that meet at a position on a side of one shape's polygon, or inside both.
    fn features_on_side(
        &self,
        (window, subject): (impl FaceCorners, impl FaceCorners),
        side: Option<(usize, usize)>,
        at: Vec2,
    ) -> [Feature; 2] {
        let mut features = [0, 1].map(|shape| Feature::Face(self.surfaces[shape].face_at(at)));
        match side {
            Some((0, i)) => features[0] = Feature::of_side(window, i),
            Some((_, i)) => features[1] = Feature::of_side(subject, i),
            None => {}
        }
        features
    }
}

fn corners(patch: &SurfacePair<'_>, clipper: &Clipper) -> Vec<Corner> {
    let corner = |i| {
        let at = clipper.corners.at(i);
        Corner {
            at,
            distance: distance(patch, at),
            origin: Origin::Clip(i),
        }
    };
    (0..clipper.corners.count).map(corner).collect()
}

fn distance(patch: &SurfacePair<'_>, at: Vec2) -> f32 {
    let distances = patch.distances(f32x4::splat(at.x), f32x4::splat(at.y));
    distances.to_array()[0]
}

/// The convex hull of the corners, counter-clockwise (Andrew, *Another efficient algorithm for convex hulls
/// in two dimensions*, Information Processing Letters 9(5), 1979). Repeated corners are dropped.
fn outline(mut corners: Vec<Corner>) -> Vec<Corner> {
    corners.sort_by(|a, b| (a.at.x.total_cmp(&b.at.x)).then(a.at.y.total_cmp(&b.at.y)));
    corners.dedup_by(|a, b| a.at == b.at);
    if corners.len() < 3 {
        return corners;
    }
    let mut around: Vec<Corner> = Vec::new();
    let backwards = corners.iter().rev().skip(1);
    let mut first = 0;
    for (i, corner) in corners.iter().chain(backwards).enumerate() {
        if i == corners.len() {
            first = around.len() - 1;
        }
        while let [.., a, b] = around[first..]
            && (b.at - a.at).perp_dot(corner.at - b.at) <= 0.0
        {
            around.pop();
        }
        around.push(*corner);
    }
    // This is the first one again.
    around.pop();
    around
}

/// The part of a convex polygon where the surfaces are at most `max_distance` apart (Sutherland, Hodgman,
/// *Reentrant polygon clipping*, Communications of the ACM 17(1), 1974).
fn cut(patch: &SurfacePair<'_>, corners: &[Corner], max_distance: f32) -> Vec<Corner> {
    let is_near = |corner: &Corner| corner.distance <= max_distance;
    let ends = corners.iter().cycle().skip(1);
    let mut kept = Vec::new();
    for (from, to) in corners.iter().zip(ends) {
        if is_near(from) {
            kept.push(*from);
        }
        // A line of two corners has no side back.
        let is_side = corners.len() > 2 || kept.len() < 2;
        if is_side
            && is_near(from) != is_near(to)
            && let (Origin::Clip(i), Origin::Clip(j)) = (from.origin, to.origin)
        {
            let share = (max_distance - from.distance) / (to.distance - from.distance);
            let at = from.at.lerp(to.at, share);
            kept.push(Corner {
                at,
                distance: distance(patch, at),
                origin: Origin::Cut([i, j]),
            });
        }
    }
    kept
}

/// The side of a polygon that contains both corners: the shape, and the number of the side.
fn common_side(ends: [VertexOrigin; 2], clipper: &Clipper) -> Option<(usize, usize)> {
    let counts = [clipper.window.count, clipper.subject.count];
    let [a, b] = ends.map(|end| sides(end, counts));
    a.into_iter()
        .flatten()
        .find(|side| b.contains(&Some(*side)))
}

/// The sides on which a corner lies.
fn sides(origin: VertexOrigin, counts: [usize; 2]) -> [Option<(usize, usize)>; 2] {
    let around = |shape: usize, i: u16| {
        let (i, count) = (usize::from(i), counts[shape]);
        [Some((shape, i)), Some((shape, (i + count - 1) % count))]
    };
    match origin {
        VertexOrigin::Window(i) => around(0, i),
        VertexOrigin::Subject(i) => around(1, i),
        VertexOrigin::Crossing(i, j) => [Some((0, i.into())), Some((1, j.into()))],
        VertexOrigin::Beside(..) => [None; 2],
    }
}
