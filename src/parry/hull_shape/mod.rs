//! [`HullShape`]: a convex hull for colliders that carries everything prepared with it.
//!
//! With plain `SharedShape::convex_hull` colliders the dispatcher looks its prepared hull up in
//! a table, and proves by a look at all points that it found the right one; and rapier scans all
//! points for the bounding box in every frame. A `HullShape` brings its prepared hull along and
//! finds its bounding box by six climbs, so that no part of a frame costs time in proportion to
//! the number of vertices (but continuous collision detection, see below).
//!
//! # What works
//! Everything that works with a plain convex hull, with our dispatcher and with rapier's own:
//! contacts with every other shape, sensors, ray casts, point projections, shape casts, the
//! character controller, mass properties, scaling, and being a part of a compound.
//!
//! - **Mass, ray casts and point projections** are those of the exact solid, in f64. A plain
//!   hull differs where parry joins faces that are up to 1.5 degrees apart (its mass can be off
//!   by some per cent, more if it is flat), for hulls of millimetres, and for rays that start
//!   inside with a direction that is not of length one.
//! - **A half-space** carries a face by corners far from each other, not by any four.
//! - **Saving and loading.** The shape shows itself to parry as the convex polyhedron that it
//!   holds (`as_typed_shape`): that is what is serialized. A loaded world has plain hulls in
//!   the place of `HullShape`s and works without this crate. With our dispatcher it goes on as
//!   before, but for the rounding of bounding boxes and for pairs whose contacts parry
//!   makes (with custom shapes), which may differ as said above.
//!   To get `HullShape`s back, see [`PreparedShapes`].
//! - **Debug rendering** draws the polyhedron's edges, for the same reason.
//! - **Continuous collision detection** sweeps the polyhedron's points, as it does those of a
//!   plain hull, with a scan of all points per support query: that is rapier's code.
//!
//! # What does not
//! - `shape_type` is `Custom`, since downcasts such as `as_convex_polyhedron` find no
//!   polyhedron but a `HullShape`. Match on `as_typed_shape` instead.
//! - `CompoundFlags::FIX_INTERNAL_EDGES` smooths inner edges between `HullShape` parts with our
//!   dispatcher, which welds corners with parry's default tolerance. With rapier's own they keep
//!   their own normals: parry cannot downcast them. [`PreparedShapes`] puts plain hulls in their place.
//! - Rounded borders are for plain hulls: use `SharedShape::round_convex_hull`.
//!
//! # Memory
//! The polyhedron costs about 250 bytes per vertex and the prepared hull about 130
//! ([`Hull::heap_bytes`]). A plain collider costs the same where our dispatcher answers, and 12 bytes
//! per vertex more to compare it with: up to 149 vertices, or whatever their number where the processor
//! takes no digest of them.

mod bounds;
mod features;
mod points;
mod prepared;
mod rays;
mod shape;

pub use prepared::PreparedShapes;

use std::sync::Arc;

use glam::Vec3;
use parry3d::bounding_volume::Aabb;
use parry3d::mass_properties::MassProperties;
use parry3d::shape::ConvexPolyhedron;

use crate::hull::build::polyhedron;
use crate::hull::{self, Hull, HullError};
use crate::support::{FaceId, Polytope};

/// A convex hull to be used as `SharedShape::new(hull)`, with all that our queries need.
///
/// Lengths are in the units of the points it was built from (metres in rapier), positions in
/// their frame, the collider's. Clones share their memory. Feature ids are those of
/// [`hull`](Self::hull).
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
#[derive(Clone, Debug)]
pub struct HullShape {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    hull: Hull,
    /// What rapier saves, draws and sweeps.
    polyhedron: ConvexPolyhedron,
    local_aabb: Aabb,
    /// For a density of one.
    mass: MassProperties,
}

impl HullShape {
    /// The convex hull of a point cloud, see [`Hull::from_points`].
    ///
    /// # Errors
    /// Names what is wrong with the points, see [`HullError`].
    pub fn from_points(points: &[Vec3]) -> Result<Self, HullError> {
        let (vertices, triangles) = hull::surface_of_points(points)?;
        Self::from_triangles(vertices, &triangles)
    }

    /// From the triangulated surface of a convex polytope, counter-clockwise from outside.
    ///
    /// # Errors
    /// Names what is wrong with the surface, see [`HullError`].
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
        // Built for its checks: parry's polyhedron trusts its input.
        Hull::from_triangles(points.clone(), triangles)?;
        ConvexPolyhedron::from_convex_mesh(points, triangles)
            .ok_or(HullError::BuilderFailed)?
            .try_into()
    }

    /// The hull with each coordinate multiplied by that of `scale`; `None` if it is flat then.
    fn scaled(&self, scale: Vec3) -> Option<Self> {
        let polyhedron = &self.inner.polyhedron;
        let points: Vec<Vec3> = polyhedron.points().iter().map(|p| *p * scale).collect();
        let mut triangles = polyhedron::triangles(polyhedron)?;
        if scale.element_product() < 0.0 {
            // A mirror image turns the other way.
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        // Rounding may have dented the surface: then a new one is spanned.
        let scaled = Self::from_triangles(points.clone(), &triangles);
        scaled.or_else(|_| Self::from_points(&points)).ok()
    }

    /// The prepared hull.
    pub fn hull(&self) -> &Hull {
        &self.inner.hull
    }

    /// What parry takes it for.
    pub(crate) fn polyhedron(&self) -> &ConvexPolyhedron {
        &self.inner.polyhedron
    }
}

/// The same hull with all that our queries need: for plain hulls, such as those of a world that
/// was loaded.
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
        // From the polyhedron even where the triangles are known: that is what the dispatcher
        // does with the plain hull of a loaded world, whose features keep their ids by it.
        let hull = Hull::try_from(&polyhedron)?;
        let inner = Inner {
            local_aabb: polyhedron.local_aabb(),
            mass: MassProperties::from_convex_polyhedron(1.0, hull.points(), &triangles(&hull)),
            hull,
            polyhedron,
        };
        Ok(Self {
            inner: Arc::new(inner),
        })
    }
}

/// The faces of a hull as triangle fans.
fn triangles(hull: &Hull) -> Vec<[u32; 3]> {
    let fan = |face: FaceId| {
        let corner = move |i| hull.face_vertex(face, i).into();
        (2..hull.face_len(face)).map(move |i| [corner(0), corner(i - 1), corner(i)])
    };
    hull.face_ids().flat_map(fan).collect()
}
