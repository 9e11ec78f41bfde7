//! From parry's shapes to polytopes that the kernels can work on.

use std::cell::RefCell;

use glam::DVec3;
use parry3d::math::Real;
use parry3d::shape::{Segment as ParrySegment, Shape, ShapeType, Triangle};

use super::hulls::{EachProved, Find, HullRef, HullTable};
use crate::epa::EpaScratch;
use crate::hull::Hull;
use crate::hull_shape::HullShape;
use crate::manifold::ClipScratch;
use crate::primitive::{Ball, CuboidPolytope, Segment, TrianglePolytope};
use crate::support::Polytope;
use crate::tolerance::THINNEST;

/// What a thread keeps from query to query: prepared hulls, and memory to work in.
#[derive(Default)]
pub(super) struct Workbench {
    hulls: HullTable,
    pub epa: EpaScratch,
    pub clip: ClipScratch,
}

thread_local! {
    static WORKBENCH: RefCell<Workbench> = RefCell::default();
}

/// A hull with a rounded border of this radius around it.
struct Prepared<'a> {
    place: Place<'a>,
    border: f64,
}

enum Place<'a> {
    /// The shape brings it along.
    Own(&'a Hull),
    /// It was prepared for the shape.
    Found(HullRef),
}

impl<'a> Prepared<'a> {
    #[inline]
    fn hull(&self, table: &'a HullTable) -> Option<&'a Hull> {
        match self.place {
            Place::Own(hull) => Some(hull),
            Place::Found(place) => table.get(place),
        }
    }
}

/// Something to do with a hull and another shape, which is `swapped` in front of it in the pair.
/// `borders` are the radii of the rounded borders around the hull and the other shape.
pub(super) trait PairVisitor {
    /// What comes of it.
    type Output;

    /// The other shape is a polytope.
    fn visit<B: Polytope>(
        self,
        hull: &Hull,
        other: &B,
        borders: [f64; 2],
        swapped: bool,
        bench: &mut Scratch<'_>,
    ) -> Self::Output;

    /// The other shape is the half-space beneath the plane through its origin with this normal.
    fn visit_half_space(
        self,
        hull: &Hull,
        normal: DVec3,
        border: f64,
        swapped: bool,
        bench: &mut Scratch<'_>,
    ) -> Self::Output;
}

/// The memory to work in, of the [`Workbench`].
pub(super) struct Scratch<'a> {
    pub epa: &'a mut EpaScratch,
    pub clip: &'a mut ClipScratch,
}

/// Whether a shape is a hull to us, so that pairs with it are ours to answer.
pub(super) fn is_hull(shape: &dyn Shape, shape_type: ShapeType) -> bool {
    match shape_type {
        ShapeType::ConvexPolyhedron | ShapeType::RoundConvexPolyhedron => true,
        ShapeType::Custom => shape.as_shape::<HullShape>().is_some(),
        _ => false,
    }
}

/// Whether both shapes are hulls.
pub(super) fn are_hulls(shape_1: &dyn Shape, shape_2: &dyn Shape) -> bool {
    [shape_1, shape_2]
        .into_iter()
        .all(|shape| is_hull(shape, shape.shape_type()))
}

/// A shape of a pair, and how to find its hull.
pub(super) struct Side<'a, F> {
    pub shape: &'a dyn Shape,
    pub find: F,
}

impl<'a> Side<'a, EachProved> {
    /// A shape of which nothing is known.
    #[inline]
    pub fn alone(shape: &'a dyn Shape) -> Self {
        let find = EachProved;
        Self { shape, find }
    }
}

impl<'a, F: Find<'a>> Side<'a, F> {
    /// The hull, if the shape is one.
    #[inline(always)]
    fn prepare(&mut self, shape_type: ShapeType, table: &mut HullTable) -> Option<Prepared<'a>> {
        let (place, border) = match shape_type {
            ShapeType::ConvexPolyhedron => {
                let polyhedron = self.shape.as_convex_polyhedron()?;
                (Place::Found(self.find.find(table, polyhedron)?), 0.0)
            }
            ShapeType::RoundConvexPolyhedron => {
                let round = self.shape.as_round_convex_polyhedron()?;
                let place = self.find.find(table, &round.inner_shape)?;
                (Place::Found(place), round.border_radius.into())
            }
            ShapeType::Custom => (Place::Own(self.shape.as_shape::<HullShape>()?.hull()), 0.0),
            _ => return None,
        };
        Some(Prepared { place, border })
    }
}

/// Visits the pair if one of its shapes is a hull and the other one known; else `None`.
#[inline]
pub(super) fn visit<V: PairVisitor>(
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    visitor: V,
) -> Option<V::Output> {
    visit_sides(Side::alone(shape_1), Side::alone(shape_2), visitor)
}

/// As [`visit`], for pairs of parts.
#[inline]
pub(super) fn visit_sides<'a, 'b, V: PairVisitor>(
    mut side_1: Side<'a, impl Find<'a>>,
    mut side_2: Side<'b, impl Find<'b>>,
    visitor: V,
) -> Option<V::Output> {
    let types = [side_1.shape.shape_type(), side_2.shape.shape_type()];
    if !is_hull(side_1.shape, types[0]) && !is_hull(side_2.shape, types[1]) {
        return None;
    }
    WORKBENCH.with_borrow_mut(|Workbench { hulls, epa, clip }| {
        hulls.make_room();
        let hull_1 = side_1.prepare(types[0], hulls);
        let hull_2 = side_2.prepare(types[1], hulls);
        let scratch = &mut Scratch { epa, clip };
        match (hull_1, hull_2) {
            (Some(first), Some(second)) => {
                let borders = [first.border, second.border];
                let (first, second) = (first.hull(hulls)?, second.hull(hulls)?);
                Some(visitor.visit(first, second, borders, false, scratch))
            }
            (Some(hull), None) => {
                let (border, hull) = (hull.border, hull.hull(hulls)?);
                let other = Other::of(side_2.shape, types[1])?;
                Some(other.accept(visitor, hull, border, false, scratch))
            }
            (None, Some(hull)) => {
                let (border, hull) = (hull.border, hull.hull(hulls)?);
                let other = Other::of(side_1.shape, types[0])?;
                Some(other.accept(visitor, hull, border, true, scratch))
            }
            (None, None) => None,
        }
    })
}

/// A shape that is no hull, with a rounded border of this radius around it.
struct Other {
    core: Core,
    border: f64,
}

enum Core {
    Cuboid(CuboidPolytope),
    Triangle(TrianglePolytope),
    Ball(Ball),
    Segment(Segment),
    /// A half-space, by its outward unit normal.
    HalfSpace(DVec3),
}

impl Other {
    fn of(shape: &dyn Shape, shape_type: ShapeType) -> Option<Self> {
        let (core, border) = match shape_type {
            ShapeType::Cuboid => {
                let extents = shape.as_cuboid()?.half_extents;
                (cuboid(extents.as_dvec3())?, 0.0)
            }
            ShapeType::RoundCuboid => {
                let round = shape.as_round_cuboid()?;
                let extents = round.inner_shape.half_extents.as_dvec3();
                (cuboid(extents)?, round.border_radius)
            }
            ShapeType::Triangle => (triangle(shape.as_triangle()?)?, 0.0),
            ShapeType::RoundTriangle => {
                let round = shape.as_round_triangle()?;
                (triangle(&round.inner_shape)?, round.border_radius)
            }
            ShapeType::Ball => {
                let radius = shape.as_ball()?.radius;
                (Core::Ball(Ball::new(positive(radius)?)), radius)
            }
            ShapeType::Capsule => {
                let capsule = shape.as_capsule()?;
                (segment(&capsule.segment, capsule.radius)?, capsule.radius)
            }
            ShapeType::Segment => (segment(shape.as_segment()?, 0.0)?, 0.0),
            ShapeType::HalfSpace => {
                let normal = shape.as_halfspace()?.normal.as_dvec3();
                (Core::HalfSpace(normal.try_normalize()?), 0.0)
            }
            _ => return None,
        };
        Some(Self {
            core,
            border: border.into(),
        })
    }

    fn accept<V: PairVisitor>(
        &self,
        visitor: V,
        hull: &Hull,
        border: f64,
        swapped: bool,
        scratch: &mut Scratch<'_>,
    ) -> V::Output {
        let borders = [border, self.border];
        match &self.core {
            Core::Cuboid(cuboid) => visitor.visit(hull, cuboid, borders, swapped, scratch),
            Core::Triangle(triangle) => visitor.visit(hull, triangle, borders, swapped, scratch),
            Core::Ball(ball) => visitor.visit(hull, ball, borders, swapped, scratch),
            Core::Segment(segment) => visitor.visit(hull, segment, borders, swapped, scratch),
            Core::HalfSpace(normal) => {
                visitor.visit_half_space(hull, *normal, border, swapped, scratch)
            }
        }
    }
}

/// `None` for a box that is a segment or a point: it has no faces with a plane.
fn cuboid(half_extents: DVec3) -> Option<Core> {
    let thin = half_extents.cmple(DVec3::splat(THINNEST * half_extents.max_element()));
    (thin.bitmask().count_ones() < 2).then(|| Core::Cuboid(CuboidPolytope::new(half_extents)))
}

/// A length that tolerances can be relative to.
fn positive(length: Real) -> Option<f64> {
    (length > 0.0 && length.is_finite()).then(|| length.into())
}

fn segment(segment: &ParrySegment, border: Real) -> Option<Core> {
    positive(segment.length() + border)?;
    let ends = [segment.a, segment.b].map(|p| p.as_dvec3());
    Some(Core::Segment(Segment::new(ends, border.into())))
}

fn triangle(triangle: &Triangle) -> Option<Core> {
    let corners = [triangle.a, triangle.b, triangle.c].map(|p| p.as_dvec3());
    TrianglePolytope::new(corners).map(Core::Triangle)
}
