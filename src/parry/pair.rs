//! From parry's shapes to polytopes that the kernels can work on.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

use parry3d::math::{Pose, Real};
use parry3d::shape::{
    ConvexPolyhedron, PolygonalFeatureMap, RoundConvexPolyhedron, Shape, ShapeType, TypedShape,
};

use crate::epa::{EpaScratch, PolytopeCache};
use crate::hull::Hull;
use crate::manifold::ClipScratch;
use crate::parry::convert::{self, CurvedShape, HalfSpace};
use crate::parry::hull_cache::epoch::Epoch;
use crate::parry::hull_cache::registry::PreparedHull;
use crate::parry::hull_cache::{EachProved, Find, HullCache, HullRef};
use crate::parry::hull_shape::HullShape;
use crate::pose::RelativePose;
use crate::primitive::Ball;
use crate::stats::Left;
use crate::support::{Cso, Polytope, Support};
use crate::tolerance::MIN_DIRECTED_DISTANCE;

/// What a thread keeps from query to query: prepared hulls, and memory to work in.
#[derive(Default)]
struct ThreadWorkspace {
    hulls: HullCache,
    workspace: Workspace,
    /// How often all had been asked to trim when it was made.
    trims: u64,
}

/// How often all threads were asked to trim.
static TRIMS: AtomicU64 = AtomicU64::new(0);

thread_local! {
    static WORKSPACE: Cell<Option<Box<ThreadWorkspace>>> = const { Cell::new(None) };
}

/// Drops what threads keep: this one now, others before their next query.
pub(crate) fn trim() {
    TRIMS.fetch_add(1, Ordering::Relaxed);
    ThreadWorkspace::with(|_| ());
    PreparedHull::forget_unused();
}

impl ThreadWorkspace {
    /// Works on that of this thread, which is out of its place meanwhile: whoever asks within a query (a
    /// user's `NormalConstraints`), or while the thread ends, works on a new one.
    // perf: in a call the work would go through memory, which pairs that are apart notice.
    #[inline(always)]
    fn with<T>(work: impl FnOnce(&mut Self) -> T) -> T {
        let trims = TRIMS.load(Ordering::Relaxed);
        let kept = WORKSPACE.try_with(Cell::take).ok().flatten();
        let mut thread = match kept {
            Some(thread) if thread.trims == trims => thread,
            _ => Self::new(trims),
        };
        let answer = work(&mut thread);
        let _ = WORKSPACE.try_with(|location| location.set(Some(thread)));
        answer
    }

    #[cold]
    #[inline(never)]
    fn new(trims: u64) -> Box<Self> {
        Box::new(Self {
            trims,
            ..Self::default()
        })
    }
}

/// Memory to work in.
#[derive(Default)]
pub(crate) struct Workspace {
    pub epa: EpaScratch,
    pub clip: ClipScratch,
    pub polytope_cache: PolytopeCache,
}

/// A hull with a rounded border of this radius around it.
#[derive(Clone, Copy)]
struct HullHandle<'a> {
    location: HullLocation<'a>,
    border_radius: f64,
}

#[derive(Clone, Copy)]
enum HullLocation<'a> {
    /// The shape brings it along.
    Own(&'a Hull),
    /// It was prepared for the shape.
    Found(HullRef),
}

impl<'a> HullHandle<'a> {
    #[inline]
    fn hull(&self, cache: &'a HullCache) -> Option<&'a Hull> {
        match self.location {
            HullLocation::Own(hull) => Some(hull),
            HullLocation::Found(location) => cache.get(location),
        }
    }
}

/// A hull and another shape, as the kernels see a pair: in the frame of the hull.
pub(crate) struct Pair<'a, B> {
    pub hull: &'a Hull,
    pub other: &'a B,
    /// The radii of the rounded borders around them.
    pub border_radii: [f64; 2],
    /// The hull is the second of the shapes that were asked about.
    pub swapped: bool,
}

impl<'a, B> Pair<'a, B> {
    /// Of the other shape. That of the shapes asked about is valid.
    #[inline(always)]
    pub fn pose(&self, pos12: &Pose) -> RelativePose {
        RelativePose::of_first(pos12, self.swapped)
    }

    /// Without borders.
    #[inline(always)]
    pub fn cso<'c>(&self, pose: &'c RelativePose) -> Cso<'c, Hull, B>
    where
        'a: 'c,
    {
        Cso {
            shape_1: self.hull,
            shape_2: self.other,
            pose,
        }
    }

    /// Up to this distance they touch. `size` is that of both without borders.
    #[inline(always)]
    pub fn touching(&self, size: f64) -> f64 {
        MIN_DIRECTED_DISTANCE * (size + self.border_radii[0] + self.border_radii[1])
    }

    /// How far apart they are without borders, if with them they are as far apart as this, or touch at
    /// that distance. `size` is that of both without borders.
    #[inline(always)]
    pub fn core_distance(&self, distance: Real, size: f64) -> f64 {
        f64::from(distance) + self.border_radii[0] + self.border_radii[1] + self.touching(size)
    }
}

/// Something to do with a pair.
pub(crate) trait PairVisitor: Sized {
    /// What comes of it; with `None` the pair is left to parry.
    type Answer;

    /// Whether it is to be asked about half-spaces.
    const HALF_SPACES: bool = false;

    /// Whether it is to be asked about cylinders and cones.
    const CURVED: bool = false;

    /// The other shape is a polytope.
    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Option<Self::Answer>;

    /// The other shape is a half-space.
    fn visit_half_space(
        &mut self,
        pair: &Pair<'_, HalfSpace>,
        workspace: &mut Workspace,
    ) -> Option<Self::Answer> {
        let _ = (pair, workspace);
        None
    }

    /// The other shape is a cylinder or a cone, which has no faces for our kernels; for parry's routines
    /// it has `features`.
    fn visit_curved<B: Support>(
        &mut self,
        pair: &Pair<'_, B>,
        features: &dyn PolygonalFeatureMap,
        workspace: &mut Workspace,
    ) -> Option<Self::Answer> {
        let _ = (pair, features, workspace);
        None
    }
}

/// A hull among parry's shapes.
#[derive(Clone, Copy)]
enum HullSource<'a> {
    /// With a rounded border of this radius.
    Plain(&'a ConvexPolyhedron, Real),
    Prepared(&'a HullShape),
}

impl<'a> HullSource<'a> {
    /// By the type that it is: what a user's shape shows as its typed shape may be a likeness only.
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

/// Whether a shape is a hull to us, so that pairs with it are ours to answer.
pub(crate) fn is_hull(shape: &dyn Shape) -> bool {
    HullSource::of(shape).is_some()
}

/// A shape of a pair, and how to find its hull.
pub(crate) struct Operand<'a, F> {
    pub shape: &'a dyn Shape,
    hull: Option<HullSource<'a>>,
    pub find: F,
}

impl<'a> Operand<'a, EachProved> {
    /// A shape of which nothing is known.
    #[inline]
    pub fn alone(shape: &'a dyn Shape) -> Self {
        Self::new(shape, EachProved)
    }
}

impl<F> Operand<'_, F> {
    /// Whether both are one hull. A rounded one may have the address of the one within it.
    #[inline(always)]
    fn is_same<G>(&self, other: &Operand<'_, G>) -> bool {
        std::ptr::addr_eq(self.shape, other.shape) && self.border_radius() == other.border_radius()
    }

    #[inline]
    fn border_radius(&self) -> Real {
        match self.hull {
            Some(HullSource::Plain(_, border_radius)) => border_radius,
            _ => 0.0,
        }
    }
}

impl<'a, F: Find<'a>> Operand<'a, F> {
    #[inline]
    pub fn new(shape: &'a dyn Shape, find: F) -> Self {
        let hull = HullSource::of(shape);
        Self { shape, hull, find }
    }

    #[inline]
    pub fn is_hull(&self) -> bool {
        self.hull.is_some()
    }

    /// Whether it may consist of parts. Of most shapes it is known at once that they do not.
    #[inline]
    pub fn may_be_composite(&self) -> bool {
        use ShapeType::{Compound, Custom, HeightField, Polyline, TriMesh, Voxels};
        !self.is_hull()
            && matches!(
                self.shape.shape_type(),
                Compound | Custom | HeightField | Polyline | TriMesh | Voxels
            )
    }

    /// The same once more.
    #[inline]
    pub fn again(&mut self) -> Operand<'a, &mut F> {
        Operand {
            shape: self.shape,
            hull: self.hull,
            find: &mut self.find,
        }
    }

    /// The hull, if the shape is one.
    #[inline(always)]
    fn prepare(&mut self, cache: &mut HullCache) -> Option<HullHandle<'a>> {
        Some(match self.hull? {
            HullSource::Plain(polyhedron, border_radius) => HullHandle {
                location: HullLocation::Found(self.find.find(cache, polyhedron)?),
                border_radius: border_radius.into(),
            },
            HullSource::Prepared(shape) => HullHandle {
                location: HullLocation::Own(shape.hull()),
                border_radius: 0.0,
            },
        })
    }
}

/// Visits the pair if one of its shapes is a hull and the other one known; else `None`.
#[inline]
pub(crate) fn visit<V: PairVisitor>(
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    visitor: V,
) -> Option<V::Answer> {
    visit_operands(
        Operand::alone(shape_1),
        Operand::alone(shape_2),
        None,
        visitor,
    )
}

/// As [`visit`], for shapes that are unchanged during `epoch`.
// perf: in a call the operands would go through memory, which pairs that are apart notice.
#[inline(always)]
pub(crate) fn visit_operands<'a, 'b, V: PairVisitor>(
    mut operand_1: Operand<'a, impl Find<'a>>,
    mut operand_2: Operand<'b, impl Find<'b>>,
    epoch: Option<Epoch>,
    mut visitor: V,
) -> Option<V::Answer> {
    match [operand_1.is_hull(), operand_2.is_hull()] {
        [true, true] => {
            ThreadWorkspace::with(
                |ThreadWorkspace {
                     hulls, workspace, ..
                 }| {
                    hulls.begin(epoch);
                    let first = operand_1.prepare(hulls)?;
                    // Two colliders with one shape, which many worlds are full of, need one proof.
                    let second = if operand_1.is_same(&operand_2) {
                        first
                    } else {
                        operand_2.prepare(hulls)?
                    };
                    let pair = Pair {
                        hull: first.hull(hulls)?,
                        other: second.hull(hulls)?,
                        border_radii: [first.border_radius, second.border_radius],
                        swapped: false,
                    };
                    visitor.visit(&pair, workspace)
                },
            )
        }
        [true, false] => {
            HullOperand::new(&mut operand_1, epoch, false).visit(operand_2.shape, &mut visitor)
        }
        [false, true] => {
            HullOperand::new(&mut operand_2, epoch, true).visit(operand_1.shape, &mut visitor)
        }
        [false, false] => None,
    }
}

/// Why a pair with a hull is not ours.
#[cold]
pub(crate) fn why_left(pos12: &Pose, shapes: [&dyn Shape; 2]) -> Left {
    if !RelativePose::is_valid(pos12) {
        return Left::NotFinite;
    }
    let is_prepared = |shape| {
        let mut operand = Operand::alone(shape);
        !operand.is_hull()
            || ThreadWorkspace::with(|thread| operand.prepare(&mut thread.hulls).is_some())
    };
    if shapes.into_iter().all(is_prepared) {
        Left::OtherShape
    } else {
        Left::HullNotPrepared
    }
}

/// A hull, and where in its pair it is. It is not looked up before the other shape is known.
struct HullOperand<'s, 'a, F> {
    operand: &'s mut Operand<'a, F>,
    epoch: Option<Epoch>,
    swapped: bool,
}

impl<'s, 'a, F: Find<'a>> HullOperand<'s, 'a, F> {
    #[inline]
    fn new(operand: &'s mut Operand<'a, F>, epoch: Option<Epoch>, swapped: bool) -> Self {
        Self {
            operand,
            epoch,
            swapped,
        }
    }

    /// Visits the hull and another shape; `None` if that is not known, or too flat or too small.
    #[inline(never)]
    fn visit<V: PairVisitor>(&mut self, other: &dyn Shape, visitor: &mut V) -> Option<V::Answer> {
        // What such a shape shows as its typed shape may be a likeness only.
        if other.shape_type() == ShapeType::Custom {
            return None;
        }
        match other.as_typed_shape() {
            TypedShape::Cuboid(cuboid) => {
                let cuboid = convert::cuboid(cuboid);
                self.polytope(cuboid.as_ref()?, 0.0, visitor)
            }
            TypedShape::RoundCuboid(round) => {
                let cuboid = convert::cuboid(&round.inner_shape)?;
                self.polytope(&cuboid, round.border_radius, visitor)
            }
            TypedShape::Triangle(triangle) => {
                let triangle = convert::triangle(triangle);
                self.polytope(triangle.as_ref()?, 0.0, visitor)
            }
            TypedShape::RoundTriangle(round) => {
                let triangle = convert::triangle(&round.inner_shape)?;
                self.polytope(&triangle, round.border_radius, visitor)
            }
            TypedShape::Ball(ball) => {
                let radius = ball.radius;
                self.polytope(&Ball::new(convert::positive(radius)?), radius, visitor)
            }
            TypedShape::Capsule(capsule) => {
                let core = convert::segment(&capsule.segment, capsule.radius)?;
                self.polytope(&core, capsule.radius, visitor)
            }
            TypedShape::Segment(segment) => {
                let segment = convert::segment(segment, 0.0)?;
                self.polytope(&segment, 0.0, visitor)
            }
            TypedShape::HalfSpace(half_space) if V::HALF_SPACES => {
                let half_space = convert::half_space(half_space)?;
                self.with(&half_space, 0.0, |pair, workspace| {
                    visitor.visit_half_space(pair, workspace)
                })
            }
            TypedShape::Cylinder(cylinder) if V::CURVED => self.curved(cylinder, 0.0, visitor),
            TypedShape::RoundCylinder(round) if V::CURVED => {
                self.curved(&round.inner_shape, round.border_radius, visitor)
            }
            TypedShape::Cone(cone) if V::CURVED => self.curved(cone, 0.0, visitor),
            TypedShape::RoundCone(round) if V::CURVED => {
                self.curved(&round.inner_shape, round.border_radius, visitor)
            }
            _ => None,
        }
    }

    #[inline]
    fn polytope<V: PairVisitor>(
        &mut self,
        other: &impl Polytope,
        border_radius: Real,
        visitor: &mut V,
    ) -> Option<V::Answer> {
        self.with(other, border_radius, |pair, workspace| {
            visitor.visit(pair, workspace)
        })
    }

    #[inline]
    fn curved<V: PairVisitor>(
        &mut self,
        other: &(impl CurvedShape + PolygonalFeatureMap),
        border_radius: Real,
        visitor: &mut V,
    ) -> Option<V::Answer> {
        self.with(&other.kernel()?, border_radius, |pair, workspace| {
            visitor.visit_curved(pair, other, workspace)
        })
    }

    /// Hands over the hull together with the other shape.
    #[inline]
    fn with<B, T>(
        &mut self,
        other: &B,
        border_radius: Real,
        visit: impl FnOnce(&Pair<'_, B>, &mut Workspace) -> Option<T>,
    ) -> Option<T> {
        ThreadWorkspace::with(
            |ThreadWorkspace {
                 hulls, workspace, ..
             }| {
                hulls.begin(self.epoch);
                let prepared = self.operand.prepare(hulls)?;
                let pair = Pair {
                    hull: prepared.hull(hulls)?,
                    other,
                    border_radii: [prepared.border_radius, border_radius.into()],
                    swapped: self.swapped,
                };
                visit(&pair, workspace)
            },
        )
    }
}
