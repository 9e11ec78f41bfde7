//! The interface that every shape has.

use std::f32::consts::FRAC_PI_4;

use parry3d::bounding_volume::details::point_cloud_bounding_sphere;
use parry3d::bounding_volume::{Aabb, BoundingSphere};
use parry3d::mass_properties::MassProperties;
use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::{
    FeatureId, PolygonalFeatureMap, Shape, ShapeType, SubShapeId, SupportMap, TypedShape,
};

use super::HullShape;

impl Shape for HullShape {
    fn compute_local_aabb(&self) -> Aabb {
        self.inner.local_aabb
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        point_cloud_bounding_sphere(self.hull().points())
    }

    fn compute_aabb(&self, position: &Pose) -> Aabb {
        self.aabb(position)
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    /// The scaled hull; `None` if it is flat.
    fn scale_dyn(&self, scale: Vector, _num_subdivisions: u32) -> Option<Box<dyn Shape>> {
        Some(Box::new(self.scaled(scale)?))
    }

    fn mass_properties(&self, density: Real) -> MassProperties {
        let mut scaled = self.inner.mass;
        scaled.set_mass(scaled.mass() * density, true);
        scaled
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        match self.polyhedron() {
            Some(polyhedron) => TypedShape::ConvexPolyhedron(polyhedron),
            None => TypedShape::Custom(self),
        }
    }

    fn ccd_thickness(&self) -> Real {
        self.inner.local_aabb.half_extents().min_element()
    }

    fn ccd_angular_thickness(&self) -> Real {
        // The same as for parry's convex polyhedra.
        FRAC_PI_4
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }

    fn as_polygonal_feature_map(&self) -> Option<(&dyn PolygonalFeatureMap, Real)> {
        Some((self, 0.0))
    }

    fn feature_normal_at_point(
        &self,
        _subshape: SubShapeId,
        feature: FeatureId,
        _point: Vector,
    ) -> Option<Vector> {
        self.hull().feature_normal(feature)
    }
}
