//! Scales pairs of any size to about one, as parry's searches need.
//!
//! These searches stop at absolute lengths, and so lose contacts between millimetre-sized shapes. Scaling by
//! a power of two is exact.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::Contact;
use parry3d::query::details::contact_support_map_support_map;
use parry3d::shape::{PolygonalFeature, PolygonalFeatureMap, SupportMap};

use crate::parry::pair::Pair;
use crate::support::Support;
use crate::tolerance::LARGEST_SCALED;

/// The factor by which the lengths of a pair are multiplied.
#[derive(Clone, Copy)]
pub(crate) struct Scale(Real);

impl Scale {
    /// The power of two that scales the smaller of two radii to between one and two.
    pub fn of<B: Support>(pair: &Pair<'_, B>) -> Self {
        let [radius_1, radius_2] = pair.radii();
        let wanted = radius_1.min(radius_2).log2().floor();
        let possible = (radius_1.max(radius_2) / LARGEST_SCALED).log2().ceil();
        // Both the factor and its inverse are normal f32 numbers.
        Self((-wanted.max(possible)).clamp(-126.0, 126.0).exp2() as Real)
    }

    pub fn pose(self, pose: &Pose) -> Pose {
        Pose::from_parts(pose.translation * self.0, pose.rotation)
    }

    pub fn shape(self, shape: &dyn PolygonalFeatureMap) -> Scaled<'_> {
        Scaled { shape, scale: self }
    }
}

/// The contact of a hull and a shape that touch or overlap, by parry's search, even if it finds them apart.
/// `None` if it fails.
pub(crate) fn contact<B: Support>(
    pair: &Pair<'_, B>,
    other: &dyn PolygonalFeatureMap,
    pos12: &Pose,
) -> Option<Contact> {
    let scale = Scale::of(pair);
    let shapes = [scale.shape(pair.hull), scale.shape(other)];
    let [shape_1, shape_2] = pair.order.to_caller(shapes);
    let mut contact =
        contact_support_map_support_map(&scale.pose(pos12), &shape_1, &shape_2, Real::MAX)?;
    let border_radii = pair.border_radii.map(|border_radius| border_radius as Real);
    let [border_radius_1, border_radius_2] = pair.order.to_caller(border_radii);
    contact.point1 = contact.point1 / scale.0 + contact.normal1 * border_radius_1;
    contact.point2 = contact.point2 / scale.0 + contact.normal2 * border_radius_2;
    contact.dist = contact.dist / scale.0 - (border_radius_1 + border_radius_2);
    Some(contact)
}

/// A shape whose lengths are scaled.
pub(crate) struct Scaled<'a> {
    shape: &'a dyn PolygonalFeatureMap,
    scale: Scale,
}

impl SupportMap for Scaled<'_> {
    fn local_support_point(&self, direction: Vector) -> Vector {
        self.shape.local_support_point(direction) * self.scale.0
    }

    fn local_support_point_toward(&self, direction: Vector) -> Vector {
        self.shape.local_support_point_toward(direction) * self.scale.0
    }
}

impl Scaled<'_> {
    fn scale_feature(&self, feature: &mut PolygonalFeature) {
        for vertex in &mut feature.vertices {
            *vertex *= self.scale.0;
        }
    }
}

impl PolygonalFeatureMap for Scaled<'_> {
    fn local_support_feature(&self, direction: Vector, feature: &mut PolygonalFeature) {
        self.shape.local_support_feature(direction, feature);
        self.scale_feature(feature);
    }

    fn local_support_feature_toward(
        &self,
        direction: Vector,
        hint: Vector,
        feature: &mut PolygonalFeature,
    ) {
        let hint = hint / self.scale.0;
        self.shape
            .local_support_feature_toward(direction, hint, feature);
        self.scale_feature(feature);
    }

    fn is_convex_polyhedron(&self) -> bool {
        self.shape.is_convex_polyhedron()
    }
}
