//! The update of a pair without a hull or a half-space, once the types of both cores are known.

use parry3d::query::Unsupported;

use crate::curved::SurfacePieces;
use crate::parry::balls::update_ball;
use crate::parry::convert::Core;
use crate::parry::manifold::UpdateManifold;
use crate::parry::order::PairOrder;
use crate::parry::pair::Pair;
use crate::parry::workspace::ThreadWorkspace;
use crate::primitive::{CuboidPolytope, Revolved};
use crate::support::Polytope;

/// What an update needs beside the cores.
pub(crate) struct CorePair<'u, 'a> {
    pub border_radii: [f64; 2],
    pub order: PairOrder,
    pub update: &'u mut UpdateManifold<'a>,
}

impl CorePair<'_, '_> {
    /// Brings the manifold up to date. A curved shape, or else a rounded one, comes second.
    pub fn update(&mut self, first: &Core, second: &Core) -> Result<(), Unsupported> {
        match second {
            Core::Cylinder(second) => self.of_solid(first, second),
            Core::Cone(second) => self.of_solid(first, second),
            Core::Custom(second) => self.of_custom(first, second),
            _ => self.of_polytopes(first, second),
        }
    }

    /// The second shape is a cylinder or a cone.
    fn of_solid(
        &mut self,
        first: &Core,
        second: &(impl SurfacePieces + Revolved),
    ) -> Result<(), Unsupported> {
        match first {
            Core::Ball(_) => update_ball(second, self.border_radii, self.order, self.update),
            Core::Segment(first) => self.by_surfaces(first, second),
            Core::Triangle(first) => self.by_surfaces(first, second),
            Core::Cuboid(first) => self.by_surfaces(first, second),
            Core::Cylinder(first) => self.by_surfaces(first, second),
            Core::Cone(first) => self.by_surfaces(first, second),
            Core::Custom(_) => self.of_custom(first, second),
        }
    }

    /// One of the shapes is a user's own.
    #[cold]
    fn of_custom(
        &mut self,
        first: &Core<'_>,
        second: &impl SurfacePieces,
    ) -> Result<(), Unsupported> {
        if self.update.leaves_custom {
            return Err(Unsupported);
        }
        self.by_surfaces(first, second)
    }

    /// Both are polytopes. The difference of a cuboid and anything has volume, which the kernel for hulls expects.
    fn of_polytopes(&mut self, first: &Core, second: &Core) -> Result<(), Unsupported> {
        match (first, second) {
            (Core::Cuboid(cuboid), other) => self.of_cuboid(cuboid, other),
            (other, Core::Cuboid(cuboid)) => {
                let mut reversed = CorePair {
                    border_radii: [self.border_radii[1], self.border_radii[0]],
                    order: self.order.reversed(),
                    update: self.update,
                };
                reversed.of_cuboid(cuboid, other)
            }
            (first, Core::Segment(second)) => self.of_flat(first, second),
            (first, Core::Triangle(second)) => self.of_flat(first, second),
            _ => Err(Unsupported),
        }
    }

    fn of_cuboid(&mut self, cuboid: &CuboidPolytope, other: &Core) -> Result<(), Unsupported> {
        match other {
            Core::Ball(other) => self.by_facets(cuboid, other),
            Core::Segment(other) => self.by_facets(cuboid, other),
            Core::Triangle(other) => self.by_facets(cuboid, other),
            Core::Cuboid(other) => self.by_facets(cuboid, other),
            _ => Err(Unsupported),
        }
    }

    /// Neither core has volume.
    fn of_flat(&mut self, first: &Core, second: &impl SurfacePieces) -> Result<(), Unsupported> {
        match first {
            Core::Ball(first) => self.by_surfaces(first, second),
            Core::Segment(first) => self.by_surfaces(first, second),
            Core::Triangle(first) => self.by_surfaces(first, second),
            _ => Err(Unsupported),
        }
    }

    /// By the kernel for polytopes.
    fn by_facets(
        &mut self,
        cuboid: &CuboidPolytope,
        other: &impl Polytope,
    ) -> Result<(), Unsupported> {
        let pair = self.pair(cuboid, other);
        ThreadWorkspace::with(|thread| self.update.update_polytopes(&pair, &mut thread.workspace))
    }

    /// By the kernel for curved shapes.
    fn by_surfaces(
        &mut self,
        first: &impl SurfacePieces,
        second: &impl SurfacePieces,
    ) -> Result<(), Unsupported> {
        let pair = self.pair(first, second);
        ThreadWorkspace::with(|thread| self.update.update_curved(&pair, &mut thread.workspace))
    }

    fn pair<'p, A, B>(&self, first: &'p A, second: &'p B) -> Pair<'p, B, A> {
        Pair {
            hull: first,
            other: second,
            border_radii: self.border_radii,
            order: self.order,
        }
    }
}
