//! Flat sides seen along the contact normal: whether points are over them, and where lines cross their outlines.

use glam::DVec3;

use super::piece::{FlatSide, Outline};
use crate::manifold::FaceBorder;
use crate::support::VertexId;
use crate::tolerance::ON_OUTLINE;

/// A flat side, and the corners of its outline if that is a polygon.
#[derive(Clone, Copy)]
pub(super) struct Flat<'a> {
    pub side: &'a FlatSide,
    pub corners: &'a [(DVec3, VertexId)],
    /// The contact normal.
    pub along: DVec3,
}

impl Flat<'_> {
    /// The distance along the contact normal from a point to the plane.
    pub fn height(&self, p: DVec3) -> f64 {
        (self.side.offset - self.side.normal.dot(p)) / self.side.normal.dot(self.along)
    }

    /// The projection of a point into the plane along the contact normal.
    pub fn project(&self, p: DVec3) -> DVec3 {
        p + self.along * self.height(p)
    }

    /// The distance along the contact normal from a point to the plane, if the point is over or under the side, up to
    /// rounding.
    pub fn height_if_over(&self, p: DVec3) -> Option<f64> {
        let height = self.height(p);
        let p = p + self.along * height;
        let is_over = match self.side.outline {
            Outline::Disc { center, radius } => {
                let most = radius * (1.0 + ON_OUTLINE);
                p.distance_squared(center) <= most * most
            }
            Outline::Polygon(_) => self.edges().all(|[from, to]| {
                let inward = self.side.normal.cross(to - from);
                let inside = inward.dot(p - from);
                // perf: only beside the outline are lengths needed.
                inside >= 0.0 || {
                    let length = inward.length();
                    inside + ON_OUTLINE * length * (length + p.distance(from)) >= 0.0
                }
            }),
        };
        is_over.then_some(height)
    }

    /// The distance from the outline of a point that is projected into the plane. It is enlarged by what
    /// rounding may have taken. `None` outside.
    pub fn inset(&self, p: DVec3) -> Option<f64> {
        let p = self.project(p);
        let inset = match self.side.outline {
            Outline::Disc { center, radius } => radius * (1.0 + ON_OUTLINE) - p.distance(center),
            Outline::Polygon(_) => {
                let mut least = f64::INFINITY;
                for ([from, inward], length) in self.sides() {
                    let slack = ON_OUTLINE * (length + (p - from).length());
                    least = least.min(inward.dot(p - from) + slack);
                }
                least
            }
        };
        (inset >= 0.0).then_some(inset)
    }

    /// A direction of the outline at a point on it.
    pub fn direction_at(&self, p: DVec3) -> DVec3 {
        if let Some((center, _)) = self.side.outline.circle() {
            return self.side.normal.cross(p - center);
        }
        let mut nearest = (f64::INFINITY, DVec3::ZERO);
        for ([from, inward], _) in self.sides() {
            let inset = inward.dot(p - from);
            if inset < nearest.0 {
                nearest = (inset, inward);
            }
        }
        nearest.1.cross(self.side.normal)
    }

    /// The border around a polygon of a core.
    pub fn border(&self, width: f64) -> FaceBorder<impl Iterator<Item = [DVec3; 2]> + Clone> {
        FaceBorder {
            sides: self.edges(),
            outward: self.side.normal,
            offset: self.side.offset,
            width,
        }
    }

    /// Both corners of each edge.
    fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> + Clone {
        let last = self.corners.last().map_or(DVec3::ZERO, |corner| corner.0);
        self.corners.iter().scan(last, |from, &(to, _)| {
            let edge = [*from, to];
            *from = to;
            Some(edge)
        })
    }

    /// The first corner, the inward unit vector and the length of each edge.
    fn sides(&self) -> impl Iterator<Item = ([DVec3; 2], f64)> {
        self.edges().filter_map(|[from, to]| {
            let inward = self.side.normal.cross(to - from);
            let length = inward.length();
            (length > 0.0).then(|| ([from, inward / length], length))
        })
    }

    /// The part of the segment from `a` to `b` that is inside, projected into the plane: from one fraction of
    /// it to another.
    pub fn clip(&self, [a, b]: [DVec3; 2]) -> Option<[f64; 2]> {
        let [a, b] = [a, b].map(|p| self.project(p));
        let along = b - a;
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        match self.side.outline {
            Outline::Disc { center, radius } => {
                let [enter, leave] = circle_crossings(a - center, along, radius)?;
                (low, high) = (low.max(enter), high.min(leave));
            }
            Outline::Polygon(_) => {
                for ([from, inward], length) in self.sides() {
                    let slack = ON_OUTLINE * (length + (a - from).length());
                    let (height, rise) = (inward.dot(a - from) + slack, inward.dot(along));
                    let share = -height / rise;
                    if rise > 0.0 {
                        low = low.max(share);
                    } else if rise < 0.0 {
                        high = high.min(share);
                    } else if height < 0.0 {
                        return None;
                    }
                }
            }
        }
        (low <= high).then_some([low, high])
    }
}

/// Where the chord of two circles is: how far from the first centre towards the second, and the square of half of its
/// length, which is negative if they do not cross.
pub(super) fn chord([r1, r2]: [f64; 2], distance: f64) -> [f64; 2] {
    let along = 0.5 * (distance + (r1 * r1 - r2 * r2) / distance);
    [along, r1 * r1 - along * along]
}

/// The fractions of `along` at which a line crosses a circle. `from` is where it starts, relative to the centre.
pub(super) fn circle_crossings(from: DVec3, along: DVec3, radius: f64) -> Option<[f64; 2]> {
    let (a, b) = (along.length_squared(), from.dot(along));
    let c = from.length_squared() - radius * radius;
    let discriminant = b * b - a * c;
    (a > 0.0 && discriminant >= 0.0).then(|| {
        let root = discriminant.sqrt();
        [(-b - root) / a, (-b + root) / a]
    })
}
