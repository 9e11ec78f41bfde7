//! Solids of revolution as outlines in a half plane, and where a point is nearest to their surface, in closed form.

use glam::{DVec2, DVec3};

use super::cone::Cone;
use super::cylinder::Cylinder;

/// A solid about the y axis.
pub(crate) trait Revolved {
    /// The corners of half of its section through the axis: the distance from the axis and the height. They go from
    /// the top of the axis to its bottom, and each edge is straight.
    fn outline(&self) -> impl IntoIterator<Item = DVec2>;

    /// The point of the surface that is nearest to `p`, which may be inside.
    fn nearest_on_surface(&self, p: DVec3) -> SurfacePoint {
        let across = p.with_y(0.0);
        let around = across.normalize_or(DVec3::X);
        let place = DVec2::new(across.length(), p.y);
        let [at, normal] = nearest_on_outline(self.outline(), place);
        let normal_in_space = around * normal.x + DVec3::Y * normal.y;
        SurfacePoint {
            at: around * at.x + DVec3::Y * at.y,
            normal: normal_in_space,
            distance: normal.dot(place - at),
        }
    }
}

impl Revolved for Cylinder {
    fn outline(&self) -> impl IntoIterator<Item = DVec2> {
        let (height, radius) = (self.half_height(), self.rim_radius());
        [
            (0.0, height),
            (radius, height),
            (radius, -height),
            (0.0, -height),
        ]
        .map(DVec2::from)
    }
}

impl Revolved for Cone {
    fn outline(&self) -> impl IntoIterator<Item = DVec2> {
        let (height, radius) = (self.half_height(), self.rim_radius());
        [(0.0, height), (radius, -height), (0.0, -height)].map(DVec2::from)
    }
}

/// A point of a surface that is nearest to some other point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    pub at: DVec3,
    /// The outward unit normal on which the other point lies.
    pub normal: DVec3,
    /// How far along the normal the other point is: negative inside.
    pub distance: f64,
}

/// The nearest point, and the outward unit normal there.
fn nearest_on_outline(corners: impl IntoIterator<Item = DVec2>, p: DVec2) -> [DVec2; 2] {
    let mut corners = corners.into_iter();
    let mut from = corners.next().unwrap_or_default();
    let mut inside = (f64::NEG_INFINITY, [from, DVec2::Y]);
    let mut outside = (f64::INFINITY, [from, DVec2::Y]);
    for to in corners {
        let along = to - from;
        let normal = DVec2::new(-along.y, along.x).normalize();
        let height = normal.dot(p - from);
        if height > inside.0 {
            inside = (height, [p - normal * height, normal]);
        }
        let share = along.dot(p - from) / along.length_squared();
        let nearest = if (0.0..=1.0).contains(&share) {
            (height.abs(), [p - normal * height, normal])
        } else {
            let corner = from + along * share.clamp(0.0, 1.0);
            let way = p - corner;
            (way.length(), [corner, way.normalize_or(normal)])
        };
        if height > 0.0 && nearest.0 < outside.0 {
            outside = nearest;
        }
        from = to;
    }
    if inside.0 > 0.0 { outside.1 } else { inside.1 }
}
