//! The shapes of a pair, and the places of their prepared hulls.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::shape::{ConvexPolyhedron, RoundConvexPolyhedron, Shape, ShapeType};

use crate::hull::Hull;
use crate::parry::hull_cache::epoch::Epoch;
use crate::parry::hull_cache::{HullCache, HullRef};
use crate::parry::hull_shape::{HullShape, aabb_of_points};

/// A hull with a rounded border of this radius around it.
#[derive(Clone, Copy)]
pub(crate) struct PreparedOperand<'a> {
    pub hull: &'a Hull,
    pub border_radius: f64,
}

/// Where a prepared hull is.
#[derive(Clone, Copy)]
pub(crate) struct HullHandle<'a> {
    location: HullLocation<'a>,
    border_radius: f64,
}

#[derive(Clone, Copy)]
enum HullLocation<'a> {
    /// The shape contains it.
    Own(&'a Hull),
    /// The hull cache has it.
    Found(HullRef),
}

impl<'a> HullHandle<'a> {
    #[inline]
    pub fn hull(&self, cache: &'a HullCache) -> Option<PreparedOperand<'a>> {
        let hull = match self.location {
            HullLocation::Own(hull) => hull,
            HullLocation::Found(location) => cache.get(location)?,
        };
        Some(PreparedOperand {
            hull,
            border_radius: self.border_radius,
        })
    }
}

/// A shape of parry that is a hull.
#[derive(Clone, Copy)]
enum HullSource<'a> {
    /// With a rounded border of this radius.
    Plain(&'a ConvexPolyhedron, Real),
    Prepared(&'a HullShape),
}

impl<'a> HullSource<'a> {
    /// This checks the concrete type: a user's own shape may return a typed shape that is only similar.
    #[inline]
    fn of(shape: &'a dyn Shape) -> Option<Self> {
        if let Some(hull) = shape.as_shape() {
            return Some(Self::Plain(hull, 0.0));
        }
        match shape.shape_type() {
            ShapeType::Custom => shape.as_shape().map(Self::Prepared),
            ShapeType::RoundConvexPolyhedron => {
                let round: &RoundConvexPolyhedron = shape.as_shape()?;
                Some(Self::Plain(&round.inner_shape, round.border_radius))
            }
            _ => None,
        }
    }
}

/// Whether a shape is a hull, so that we answer its pairs.
pub(crate) fn is_hull(shape: &dyn Shape) -> bool {
    HullSource::of(shape).is_some()
}

/// A shape of a pair.
#[derive(Clone, Copy)]
pub(crate) struct Operand<'a> {
    pub shape: &'a dyn Shape,
    hull: Option<HullSource<'a>>,
}

impl<'a> Operand<'a> {
    #[inline]
    pub fn new(shape: &'a dyn Shape) -> Self {
        let hull = HullSource::of(shape);
        Self { shape, hull }
    }

    #[inline]
    pub fn is_hull(&self) -> bool {
        self.hull.is_some()
    }

    /// The box around it at a pose.
    pub fn aabb(&self, pose: &Pose) -> Aabb {
        match self.hull {
            // parry looks at one coordinate at a time.
            Some(HullSource::Plain(polyhedron, border_radius)) => {
                aabb_of_points(polyhedron.points(), pose).loosened(border_radius)
            }
            _ => self.shape.compute_aabb(pose),
        }
    }

    /// Whether the shape may have parts. Most shapes are ruled out quickly.
    #[inline]
    pub fn may_be_composite(&self) -> bool {
        use ShapeType::{Compound, Custom, HeightField, Polyline, TriMesh, Voxels};
        !self.is_hull()
            && matches!(
                self.shape.shape_type(),
                Compound | Custom | HeightField | Polyline | TriMesh | Voxels
            )
    }

    /// The hull, if the shape is one and the cache finds it at once.
    #[inline(always)]
    pub fn known<'h>(&self, cache: &'h HullCache, epoch: Epoch) -> Option<PreparedOperand<'h>>
    where
        'a: 'h,
    {
        let (hull, border_radius) = match self.hull? {
            HullSource::Plain(polyhedron, border_radius) => {
                (cache.known(polyhedron, epoch)?, border_radius)
            }
            HullSource::Prepared(shape) => (shape.hull(), 0.0),
        };
        Some(PreparedOperand {
            hull,
            border_radius: border_radius.into(),
        })
    }

    /// The hull, if the shape is one. A new hull is prepared.
    #[inline(always)]
    pub fn prepare(&self, cache: &mut HullCache, epoch: Epoch) -> Option<HullHandle<'a>> {
        Some(match self.hull? {
            HullSource::Plain(polyhedron, border_radius) => HullHandle {
                location: HullLocation::Found(cache.find(polyhedron, epoch)?),
                border_radius: border_radius.into(),
            },
            HullSource::Prepared(shape) => HullHandle {
                location: HullLocation::Own(shape.hull()),
                border_radius: 0.0,
            },
        })
    }
}
