//! What a shape tells of itself, as a support mapping.

use glam::{DVec3, Vec3};
use parry3d::math::Real;
use parry3d::shape::{PolygonalFeatureMap, Shape, ShapeType, SupportMap};

use crate::parry::operand::is_hull;
use crate::primitive::turns;
use crate::stats::Cost;
use crate::support::{Support, VertexId};
use crate::tolerance::{MIN_EXTENT, SUPPORT_ROUNDING};

/// The core of a user's own shape.
pub(crate) struct CustomShape<'a> {
    pub(super) support: &'a dyn SupportMap,
    /// If it tells its faces and edges.
    pub(super) features: Option<&'a dyn PolygonalFeatureMap>,
    center: DVec3,
    radius: f64,
}

/// Whether a shape is a user's own, and not a hull.
pub(crate) fn is_custom(shape: &dyn Shape) -> bool {
    shape.shape_type() == ShapeType::Custom && !is_hull(shape)
}

/// Whether it is one with a support mapping.
#[cold]
pub(crate) fn has_support_map(shape: &dyn Shape) -> bool {
    is_custom(shape) && SupportMaps::of(shape).is_some()
}

/// What a shape tells of its core.
struct SupportMaps<'a> {
    support: &'a dyn SupportMap,
    features: Option<&'a dyn PolygonalFeatureMap>,
    border: Real,
}

impl<'a> SupportMaps<'a> {
    fn of(shape: &'a dyn Shape) -> Option<Self> {
        if let Some((features, border)) = shape.as_polygonal_feature_map() {
            return Some(Self {
                support: features,
                features: Some(features),
                border,
            });
        }
        Some(Self {
            support: shape.as_support_map()?,
            features: None,
            border: 0.0,
        })
    }
}

impl<'a> CustomShape<'a> {
    /// The core of a shape, and the radius of its border. `None` if it has no support mapping, or no volume.
    pub fn of(shape: &'a dyn Shape) -> Option<(Self, Real)> {
        let SupportMaps {
            support,
            features,
            border,
        } = SupportMaps::of(shape)?;
        let sphere = shape.compute_local_bounding_sphere();
        let center = inner_point(support, sphere.radius().into())?;
        let radius = f64::from(sphere.radius()) + sphere.center().as_dvec3().distance(center);
        let core = Self {
            support,
            features,
            center,
            radius: radius * (1.0 + SUPPORT_ROUNDING),
        };
        (radius.is_finite() && border >= 0.0).then_some((core, border))
    }
}

/// A point inside: the middle of a tetrahedron of support points. `None` if the shape is flat. `radius` tells how
/// large it is.
fn inner_point(support: &dyn SupportMap, radius: f64) -> Option<DVec3> {
    let least = MIN_EXTENT * radius;
    // Of the extreme points both ways along a direction, the one that is farther from `p`.
    let farther = |p: DVec3, dir: DVec3| {
        let ends = [dir, -dir].map(|dir| extreme(support, dir));
        let heights = ends.map(|end| (end - p).dot(dir).abs());
        let i = usize::from(heights[1] > heights[0]);
        (heights[i] > least).then_some(ends[i])
    };
    let a = extreme(support, DVec3::X);
    let b = farther(a, DVec3::X)?;
    let along = (b - a).try_normalize()?;
    let c = farther(a, along.any_orthonormal_vector())?;
    let d = farther(a, along.cross(c - a).try_normalize()?)?;
    Some((a + b + c + d) / 4.0)
}

/// The extreme point along a unit vector.
pub(super) fn extreme(support: &dyn SupportMap, dir: DVec3) -> DVec3 {
    support.local_support_point(rounded(dir)).as_dvec3()
}

/// A direction of any length as a unit vector, which parry's shapes ask for.
pub(super) fn rounded(dir: DVec3) -> Vec3 {
    dir.normalize_or(DVec3::X).as_vec3()
}

impl Support for CustomShape<'_> {
    fn support(&self, dir: DVec3, _: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        (extreme(self.support, dir), VertexId::default())
    }

    fn rounding(&self) -> f64 {
        SUPPORT_ROUNDING * (self.center.length() + self.radius)
    }

    /// Faces and edges do not turn with the contact.
    fn rolls(&self, from: DVec3, to: DVec3) -> bool {
        turns(from, to) && self.feature(to, 2).is_none()
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn radius(&self) -> f64 {
        self.radius
    }
}
