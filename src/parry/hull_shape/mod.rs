//! [`HullShape`]: a convex hull for colliders that contains its prepared hull.

mod bounds;
mod features;
mod points;
mod prepared;
mod rays;
mod shape;

pub(crate) use bounds::aabb_of_points;
pub use prepared::PreparedShapes;
pub(crate) use prepared::plain;

use std::sync::{Arc, OnceLock};

use glam::Vec3;
use parry3d::bounding_volume::Aabb;
use parry3d::bounding_volume::details::local_point_cloud_aabb_ref;
use parry3d::mass_properties::MassProperties;
use parry3d::shape::ConvexPolyhedron;

use crate::hull::build::canonical::canonical_hull;
use crate::hull::build::polyhedron;
use crate::hull::{self, Hull, HullError};

/// A convex hull for colliders, used as `SharedShape::new(hull)`, with everything that our queries need.
///
/// Lengths are in the units of the points it was built from (metres in rapier), and positions in their frame,
/// which is the collider's. Clones share their memory. Feature ids are those of [`hull`](Self::hull).
///
/// ```
/// use isa_gjk::{HullShape, IsaGjkDispatcher};
/// use rapier3d::prelude::*;
///
/// let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
/// let shape = SharedShape::new(HullShape::from_points(&corners)?);
///
/// let mut world = PhysicsWorld::default();
/// world.narrow_phase = NarrowPhase::with_query_dispatcher(IsaGjkDispatcher::default());
/// let ground = SharedShape::halfspace(Vector::Y);
/// world.insert_collider(ColliderBuilder::new(ground), None);
/// let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 1.0, 0.0));
/// let (body, _) = world.insert(body, ColliderBuilder::new(shape));
/// for _ in 0..120 {
///     world.step();
/// }
/// let height = world.bodies[body].translation().y;
/// assert!(height.abs() < 0.01, "it rests on the ground");
/// # Ok::<(), isa_gjk::HullError>(())
/// ```
///
/// # Why
/// For plain `SharedShape::convex_hull` colliders, the dispatcher looks up the prepared hull in a cache, and
/// reads all points to verify that it is the right one. Rapier also scans all points for the bounding box in
/// every frame. A `HullShape` contains its prepared hull and finds its bounding box by six climbs over its edges.
/// So no part of a frame takes time proportional to the number of vertices, except continuous collision detection.
///
/// # What works
/// Everything that works with a plain convex hull, with our dispatcher and with rapier's own:
/// contacts with every other shape, sensors, ray casts, point projections, shape casts, the
/// character controller, mass properties, scaling, and being a part of a compound.
///
/// - **Mass, ray casts and point projections** are those of the exact solid, in f64. A plain hull differs if
///   parry merges faces that are up to 1.5 degrees apart (its mass can be off by a few per cent, or more if
///   it is flat), for hulls of millimetres, and for rays that start inside with a direction that is not of
///   length one.
/// - **A half-space** supports a face at corners far from each other, not at any four.
/// - **Saving and loading.** parry sees the shape as a convex polyhedron
///   (`as_typed_shape`), and this is serialized. A loaded world has plain hulls in place of `HullShape`s and
///   works without this crate. With our dispatcher it continues as before, except for the rounding of
///   bounding boxes, and for pairs whose contacts parry computes (with custom shapes), which may differ as
///   described above. To get `HullShape`s back, see [`PreparedShapes`].
/// - **Debug rendering** draws the polyhedron's edges, for the same reason.
/// - **Continuous collision detection** sweeps the polyhedron's points, as for a plain hull, and scans all
///   points for each support query. Rapier asks no dispatcher about hulls.
///
/// # What differs
/// - `shape_type` is `Custom`, since downcasts such as `as_convex_polyhedron` find no
///   polyhedron but a `HullShape`. Match on `as_typed_shape` instead.
/// - `CompoundFlags::FIX_INTERNAL_EDGES` smooths inner edges between `HullShape` parts with our dispatcher,
///   which welds corners with parry's default tolerance. With rapier's dispatcher, these parts keep their own
///   normals, since parry cannot downcast them. [`PreparedShapes`] replaces them by plain hulls.
/// - Only plain hulls have rounded borders: use `SharedShape::round_convex_hull`.
///
/// # Memory
/// The prepared hull takes about 130 bytes per vertex ([`Hull::heap_bytes`]). parry's polyhedron takes 250 more. It is
/// made when it is first asked for: to save, draw or sweep the shape, or if the shape was made from a polyhedron. A
/// plain collider always has both if our dispatcher answers its pairs, and 12 bytes per vertex more for the
/// comparison: up to 149 vertices, or for any number if the processor has no instruction for the digest.
#[derive(Clone, Debug)]
pub struct HullShape {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    hull: Hull,
    /// The polyhedron that rapier saves, draws and sweeps, once it is asked for. `None` if parry cannot make it.
    polyhedron: OnceLock<Option<ConvexPolyhedron>>,
    local_aabb: Aabb,
    /// The mass properties for a density of one.
    mass: MassProperties,
}

impl HullShape {
    /// The convex hull of a point cloud, see [`Hull::from_points`].
    ///
    /// # Errors
    /// [`HullError`] says what is wrong with the points.
    pub fn from_points(points: &[Vec3]) -> Result<Self, HullError> {
        let surface = hull::surface_of_points(points)?;
        Self::from_surface(surface.vertices, &surface.triangles, surface.seem_flat)
    }

    /// From the triangulated surface of a convex polytope, counter-clockwise from outside.
    ///
    /// # Errors
    /// [`HullError`] says what is wrong with the surface.
    ///
    /// ```
    /// use glam::Vec3;
    /// use isa_gjk::{HullError, HullShape};
    ///
    /// let points = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    /// let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let tetrahedron = HullShape::from_triangles(points.clone(), &triangles)?;
    /// assert_eq!(tetrahedron.hull().face_count(), 4);
    ///
    /// let open = HullShape::from_triangles(points, &triangles[..3]);
    /// assert_eq!(open.unwrap_err(), HullError::NotManifold);
    /// # Ok::<(), HullError>(())
    /// ```
    pub fn from_triangles(points: Vec<Vec3>, triangles: &[[u32; 3]]) -> Result<Self, HullError> {
        let bends = hull::bends_everywhere(points.clone(), triangles)?;
        Self::from_surface(points, triangles, !bends)
    }

    /// From a closed surface.
    fn from_surface(
        points: Vec<Vec3>,
        triangles: &[[u32; 3]],
        seems_flat: bool,
    ) -> Result<Self, HullError> {
        if let Some(hull) = canonical_hull(&points, triangles, seems_flat) {
            return Ok(Self::new(hull, OnceLock::new()));
        }
        // The hull may depend on the diagonals of flat sides, so it is made from those of the polyhedron.
        let polyhedron = ConvexPolyhedron::from_convex_mesh(points.clone(), triangles)
            .ok_or(HullError::BuilderFailed)?;
        if let Some((hull, _)) = polyhedron::hull_of_surface(&polyhedron) {
            return Ok(Self::new(hull, OnceLock::from(Some(polyhedron))));
        }
        // It may still be no hull, for reasons that only its faces show.
        Hull::from_triangles(points, triangles)?;
        polyhedron.try_into()
    }

    fn new(hull: Hull, polyhedron: OnceLock<Option<ConvexPolyhedron>>) -> Self {
        let inner = Inner {
            local_aabb: local_point_cloud_aabb_ref(hull.points()),
            mass: MassProperties::from_convex_polyhedron(1.0, hull.points(), &hull.triangles()),
            hull,
            polyhedron,
        };
        Self {
            inner: Arc::new(inner),
        }
    }

    /// The hull with each coordinate multiplied by that of `scale`; `None` if the result is flat.
    fn scaled(&self, scale: Vec3) -> Option<Self> {
        let points: Vec<Vec3> = self.hull().points().iter().map(|p| *p * scale).collect();
        let mut triangles = self.hull().triangles();
        if scale.element_product() < 0.0 {
            // In a mirror image, triangles turn the other way.
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        // If rounding dented the surface, a new one is built from the points.
        let scaled = Self::from_triangles(points.clone(), &triangles);
        scaled.or_else(|_| Self::from_points(&points)).ok()
    }

    /// The prepared hull.
    pub fn hull(&self) -> &Hull {
        &self.inner.hull
    }

    /// What parry takes it for; `None` if parry cannot make that.
    pub(crate) fn polyhedron(&self) -> Option<&ConvexPolyhedron> {
        let hull = self.hull();
        let make = || ConvexPolyhedron::from_convex_mesh(hull.points().to_vec(), &hull.triangles());
        self.inner.polyhedron.get_or_init(make).as_ref()
    }
}

/// Prepares a plain hull, for instance one of a loaded world.
///
/// ```
/// use isa_gjk::HullShape;
/// use rapier3d::prelude::*;
///
/// let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
/// let mut collider = ColliderBuilder::convex_hull(&corners).unwrap().build();
/// if let Some(polyhedron) = collider.shape().as_convex_polyhedron() {
///     let hull = HullShape::try_from(polyhedron.clone())?;
///     collider.set_shape(SharedShape::new(hull));
/// }
/// assert!(collider.shape().as_shape::<HullShape>().is_some());
/// # Ok::<(), isa_gjk::HullError>(())
/// ```
impl TryFrom<ConvexPolyhedron> for HullShape {
    type Error = HullError;

    fn try_from(polyhedron: ConvexPolyhedron) -> Result<Self, HullError> {
        // Built from the polyhedron even if the triangles are known. The dispatcher does the same with the
        // plain hull of a loaded world, so feature ids stay the same.
        let hull = Hull::try_from(&polyhedron)?;
        Ok(Self::new(hull, OnceLock::from(Some(polyhedron))))
    }
}
