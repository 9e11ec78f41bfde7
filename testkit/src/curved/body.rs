//! Convex bodies: a core with a border around it.

use glam::DVec3;
use parry3d::math::{Real, Vector};
use parry3d::shape::SharedShape;

use crate::own_shape::{Ellipsoid, OwnShape};

/// What is left of a body without its border. The axis of a cylinder or cone is y, its centre the origin.
#[derive(Clone, Debug)]
pub enum Core {
    /// The convex hull of these: a point, a segment, a triangle or a polyhedron.
    Points(Vec<DVec3>),
    Cylinder {
        half_height: f64,
        radius: f64,
    },
    /// Its apex is up.
    Cone {
        half_height: f64,
        radius: f64,
    },
    /// With these half axes.
    Ellipsoid(DVec3),
    /// Beneath the plane through the origin with this unit normal.
    HalfSpace(DVec3),
}

/// A body beside parry's shape for it; all its lengths are what f32 holds.
#[derive(Clone)]
pub struct Body {
    pub name: String,
    pub core: Core,
    pub border: f64,
    pub shape: SharedShape,
}

impl Body {
    pub fn ball(radius: Real) -> Self {
        let core = Core::Points(vec![DVec3::ZERO]);
        Self::new("ball", core, radius, SharedShape::ball(radius))
    }

    pub fn capsule([a, b]: [Vector; 2], radius: Real) -> Self {
        let core = Core::Points(vec![a.as_dvec3(), b.as_dvec3()]);
        Self::new("capsule", core, radius, SharedShape::capsule(a, b, radius))
    }

    pub fn cylinder(half_height: Real, radius: Real, border: Real) -> Self {
        let core = Core::Cylinder {
            half_height: half_height.into(),
            radius: radius.into(),
        };
        let shape = if border > 0.0 {
            SharedShape::round_cylinder(half_height, radius, border)
        } else {
            SharedShape::cylinder(half_height, radius)
        };
        Self::new("cylinder", core, border, shape)
    }

    pub fn cone(half_height: Real, radius: Real, border: Real) -> Self {
        let core = Core::Cone {
            half_height: half_height.into(),
            radius: radius.into(),
        };
        let shape = if border > 0.0 {
            SharedShape::round_cone(half_height, radius, border)
        } else {
            SharedShape::cone(half_height, radius)
        };
        Self::new("cone", core, border, shape)
    }

    pub fn half_space(normal: Vector) -> Self {
        let core = Core::HalfSpace(normal.as_dvec3().normalize());
        Self::new("half-space", core, 0.0, SharedShape::halfspace(normal))
    }

    pub fn cuboid(half: Vector, border: Real) -> Self {
        let signs = [-1.0, 1.0];
        let corner = |i: usize| DVec3::new(signs[i & 1], signs[i >> 1 & 1], signs[i >> 2]);
        let core = Core::Points((0..8).map(|i| corner(i) * half.as_dvec3()).collect());
        let [x, y, z] = half.to_array();
        let shape = if border > 0.0 {
            SharedShape::round_cuboid(x, y, z, border)
        } else {
            SharedShape::cuboid(x, y, z)
        };
        Self::new("cuboid", core, border, shape)
    }

    pub fn triangle([a, b, c]: [Vector; 3], border: Real) -> Self {
        let core = Core::Points([a, b, c].map(|p| p.as_dvec3()).into());
        let shape = if border > 0.0 {
            SharedShape::round_triangle(a, b, c, border)
        } else {
            SharedShape::triangle(a, b, c)
        };
        Self::new("triangle", core, border, shape)
    }

    /// The convex hull of `points`, if parry finds one.
    pub fn hull(points: &[Vector], border: Real) -> Option<Self> {
        let shape = if border > 0.0 {
            SharedShape::round_convex_hull(points, border)?
        } else {
            SharedShape::convex_hull(points)?
        };
        let polyhedron = match shape.as_round_convex_polyhedron() {
            Some(round) => &round.inner_shape,
            None => shape.as_convex_polyhedron()?,
        };
        let corners = polyhedron.points().iter().map(|p| p.as_dvec3()).collect();
        Some(Self::new("hull", Core::Points(corners), border, shape))
    }

    pub fn ellipsoid(half: Vector) -> Self {
        let shape = SharedShape::new(Ellipsoid(half));
        Self::new("ellipsoid", Core::Ellipsoid(half.as_dvec3()), 0.0, shape)
    }

    /// The same as a shape of a user's own, which may tell its faces and edges.
    pub fn as_own(self, tells_features: bool) -> Self {
        let shape = SharedShape::new(OwnShape {
            inner: self.shape,
            tells_features,
            shown: None,
        });
        let kind = if tells_features { "own" } else { "smooth" };
        Self {
            name: format!("{kind} {}", self.name),
            shape,
            ..self
        }
    }

    fn new(name: &str, core: Core, border: Real, shape: SharedShape) -> Self {
        let is_rounded = border > 0.0 && !matches!(name, "ball" | "capsule");
        let rounded = if is_rounded { "round " } else { "" };
        Self {
            name: format!("{rounded}{name}"),
            core,
            border: border.into(),
            shape,
        }
    }

    /// A point of the core that is farthest along `direction`; of a half-space, along its normal.
    pub fn extreme(&self, direction: DVec3) -> DVec3 {
        let across = DVec3::new(direction.x, 0.0, direction.z);
        let rim = |radius: f64, y: f64| across.normalize_or_zero() * radius + DVec3::Y * y;
        match &self.core {
            Core::Points(points) => {
                let reach = |p: &DVec3| p.dot(direction);
                let farthest = points.iter().max_by(|p, q| reach(p).total_cmp(&reach(q)));
                *farthest.expect("a body has points")
            }
            Core::Cylinder {
                half_height,
                radius,
            } => rim(*radius, half_height.copysign(direction.y)),
            Core::Cone {
                half_height,
                radius,
            } => {
                let is_apex = radius * across.length() <= 2.0 * half_height * direction.y;
                if is_apex {
                    DVec3::Y * *half_height
                } else {
                    rim(*radius, -half_height)
                }
            }
            Core::Ellipsoid(half) => *half * (*half * direction).normalize_or_zero(),
            Core::HalfSpace(_) => DVec3::ZERO,
        }
    }

    /// Of a ball around it; of a half-space, infinite.
    pub fn diameter(&self) -> f64 {
        let core = match &self.core {
            Core::Points(points) => {
                let pairs = points
                    .iter()
                    .flat_map(|p| points.iter().map(|q| p.distance(*q)));
                pairs.fold(0.0, f64::max)
            }
            Core::Cylinder {
                half_height,
                radius,
            } => 2.0 * half_height.hypot(*radius),
            Core::Cone {
                half_height,
                radius,
            } => (2.0 * radius).max((2.0 * half_height).hypot(*radius)),
            Core::Ellipsoid(half) => 2.0 * half.max_element(),
            Core::HalfSpace(_) => f64::INFINITY,
        };
        core + 2.0 * self.border
    }
}
