//! Convex shapes of a user's own, which parry and the crate know only by their traits.

use parry3d::bounding_volume::{Aabb, BoundingSphere};
use parry3d::mass_properties::MassProperties;
use parry3d::math::{Real, Vector};
use parry3d::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d::shape::{
    FeatureId, PolygonalFeatureMap, Shape, ShapeType, SharedShape, SupportMap, TypedShape,
};

/// Another shape, of which only this much is told.
#[derive(Clone)]
pub struct OwnShape {
    pub inner: SharedShape,
    /// Whether it tells its faces and edges, and not only its extreme points.
    pub tells_features: bool,
    /// What it shows itself as, if that is not a shape of a user's own.
    pub shown: Option<SharedShape>,
}

impl SupportMap for OwnShape {
    fn local_support_point(&self, dir: Vector) -> Vector {
        let inner = self.inner.as_support_map().expect("a convex shape");
        inner.local_support_point(dir)
    }
}

impl RayCast for OwnShape {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        self.inner.cast_local_ray_and_get_normal(ray, max, solid)
    }
}

impl PointQuery for OwnShape {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        self.inner.project_local_point(point, solid)
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        self.inner.project_local_point_and_get_feature(point)
    }
}

impl Shape for OwnShape {
    fn compute_local_aabb(&self) -> Aabb {
        self.inner.compute_local_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.inner.compute_local_bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, _: Vector, _: u32) -> Option<Box<dyn Shape>> {
        None
    }

    fn mass_properties(&self, density: Real) -> MassProperties {
        self.inner.mass_properties(density)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        match &self.shown {
            Some(shown) => shown.as_typed_shape(),
            None => TypedShape::Custom(self),
        }
    }

    fn ccd_thickness(&self) -> Real {
        self.inner.ccd_thickness()
    }

    fn ccd_angular_thickness(&self) -> Real {
        self.inner.ccd_angular_thickness()
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }

    fn as_polygonal_feature_map(&self) -> Option<(&dyn PolygonalFeatureMap, Real)> {
        if self.tells_features {
            self.inner.as_polygonal_feature_map()
        } else {
            None
        }
    }
}

/// An ellipsoid with these half axes.
#[derive(Clone)]
pub struct Ellipsoid(pub Vector);

impl SupportMap for Ellipsoid {
    fn local_support_point(&self, dir: Vector) -> Vector {
        self.0 * (self.0 * dir).normalize_or_zero()
    }
}

impl RayCast for Ellipsoid {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        let ray = Ray::new(ray.origin / self.0, ray.dir / self.0);
        let mut hit = SharedShape::ball(1.0).cast_local_ray_and_get_normal(&ray, max, solid)?;
        hit.normal = (hit.normal / self.0).normalize_or_zero();
        Some(hit)
    }
}

/// The point on the ray from the centre, which is not the nearest one.
impl PointQuery for Ellipsoid {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        let mut found = SharedShape::ball(1.0).project_local_point(point / self.0, solid);
        found.point *= self.0;
        found
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        (self.project_local_point(point, false), FeatureId::Face(0))
    }
}

impl Shape for Ellipsoid {
    fn compute_local_aabb(&self) -> Aabb {
        Aabb::new(-self.0, self.0)
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere::new(Vector::ZERO, self.0.max_element())
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, scale: Vector, _: u32) -> Option<Box<dyn Shape>> {
        Some(Box::new(Self(self.0 * scale.abs())))
    }

    fn mass_properties(&self, density: Real) -> MassProperties {
        let [x, y, z] = (self.0 * self.0).to_array();
        let mass = density * 4.0 / 3.0 * std::f32::consts::PI * self.0.element_product();
        let inertia = Vector::new(y + z, x + z, x + y) * (mass / 5.0);
        MassProperties::new(Vector::ZERO, mass, inertia)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> Real {
        self.0.min_element()
    }

    fn ccd_angular_thickness(&self) -> Real {
        0.0
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }
}
