//! The components that describe an entity's body.

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::Component;
use bevy_ecs::world::DeferredWorld;
use rapier3d::prelude::{
    self as rapier, ColliderBuilder, Pose, Real, RigidBodyBuilder, Rotation, SharedShape, Vector,
};

use super::context::PhysicsContext;

/// A rigid body as rapier's builder describes it; dynamic by default.
///
/// The pose and the velocity of the builder are ignored: [`PhysicsTransform`] and [`Velocity`] have them. A
/// change is applied at the next step, with forces reset and the body awake. Removing this component removes
/// body and collider from the rapier world.
///
/// ```
/// use isa_gjk::bevy::RigidBody;
/// use rapier3d::prelude::RigidBodyBuilder;
///
/// let floating = RigidBody(RigidBodyBuilder::dynamic().gravity_scale(0.0));
/// assert_ne!(floating, RigidBody::default());
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq)]
#[component(on_remove = remove_body)]
#[require(PhysicsTransform, Velocity)]
pub struct RigidBody(pub RigidBodyBuilder);

impl RigidBody {
    /// A body that nothing moves, such as the ground.
    pub fn fixed() -> Self {
        Self(RigidBodyBuilder::fixed())
    }
}

impl From<RigidBodyBuilder> for RigidBody {
    fn from(builder: RigidBodyBuilder) -> Self {
        Self(builder)
    }
}

/// The shape and the surface of a body, as rapier's builder describes them.
///
/// The builder's position is in the frame of the body. A change, also of the shape, is applied at
/// the next step. Removing this component leaves a body without collider, and without the mass
/// that gravity acts on, unless the builder of the [`RigidBody`] gives it some.
///
/// ```
/// use isa_gjk::HullShape;
/// use isa_gjk::bevy::Collider;
/// use rapier3d::prelude::{ColliderBuilder, SharedShape, Vector};
///
/// # fn main() -> Result<(), isa_gjk::HullError> {
/// let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
/// let hull = SharedShape::new(HullShape::from_points(&corners)?);
/// let plain = Collider::from(hull.clone());
/// let slippery = Collider(ColliderBuilder::new(hull).friction(0.0));
/// # assert!(slippery.0.friction < plain.0.friction);
/// # Ok(())
/// # }
/// ```
#[derive(Component, Clone, Debug)]
#[component(on_remove = remove_collider)]
#[require(RigidBody)]
pub struct Collider(pub ColliderBuilder);

impl From<ColliderBuilder> for Collider {
    fn from(builder: ColliderBuilder) -> Self {
        Self(builder)
    }
}

impl From<SharedShape> for Collider {
    fn from(shape: SharedShape) -> Self {
        Self(ColliderBuilder::new(shape))
    }
}

/// The pose of a body in the world: written after each step; your changes are applied before the next one.
///
/// A changed pose is a teleport, except for bodies of the type `KinematicPositionBased`, which move there
/// within the next step. Its vector and quaternion are those of Bevy's `Transform`.
///
/// ```
/// use isa_gjk::bevy::PhysicsTransform;
/// use rapier3d::prelude::{Pose, Vector};
///
/// let transform = PhysicsTransform::from_xyz(0.0, 2.0, 0.0);
/// assert_eq!(transform.translation, Vector::Y * 2.0);
/// assert_eq!(transform, Pose::translation(0.0, 2.0, 0.0).into());
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct PhysicsTransform {
    /// The position of the body's origin, in metres.
    pub translation: Vector,
    /// The rotation of the body.
    pub rotation: Rotation,
}

impl PhysicsTransform {
    /// An unturned pose, in metres.
    pub fn from_xyz(x: Real, y: Real, z: Real) -> Self {
        Pose::translation(x, y, z).into()
    }
}

impl From<Pose> for PhysicsTransform {
    fn from(pose: Pose) -> Self {
        Self {
            translation: pose.translation,
            rotation: pose.rotation,
        }
    }
}

impl From<PhysicsTransform> for Pose {
    fn from(transform: PhysicsTransform) -> Self {
        Self::from_parts(transform.translation, transform.rotation)
    }
}

/// The velocity of a body: written after each step; your changes are applied before the next one.
///
/// ```
/// use isa_gjk::bevy::Velocity;
/// use rapier3d::prelude::Vector;
///
/// let thrown = Velocity { linear: Vector::X * 3.0, ..Velocity::default() };
/// assert_eq!(thrown.angular, Vector::ZERO);
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Of the centre of mass, in metres per second.
    pub linear: Vector,
    /// About the axes of the world, in radians per second.
    pub angular: Vector,
}

impl From<&rapier::RigidBody> for Velocity {
    fn from(body: &rapier::RigidBody) -> Self {
        Self {
            linear: body.linvel(),
            angular: body.angvel(),
        }
    }
}

fn remove_body(mut world: DeferredWorld<'_>, removed: HookContext) {
    if let Some(mut context) = world.get_resource_mut::<PhysicsContext>() {
        context.remove_body(removed.entity);
    }
}

fn remove_collider(mut world: DeferredWorld<'_>, removed: HookContext) {
    if let Some(mut context) = world.get_resource_mut::<PhysicsContext>() {
        context.remove_collider(removed.entity);
    }
}
