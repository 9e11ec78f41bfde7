//! The cost of an update grows with the number of near parts, not of all parts.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use isa_gjk::IsaGjkDispatcher;
use parry3d::bounding_volume::{Aabb, BoundingSphere};
use parry3d::mass_properties::MassProperties;
use parry3d::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d::shape::{Ball, FeatureId, Shape, ShapeType, TypedShape};
use rapier3d::prelude::*;
use testkit::generate::Rng;
use testkit::memory::Memory;

/// Balls in a row, or on a square grid, that touch their neighbours.
fn balls(count: usize, columns: usize) -> SharedShape {
    let ball = SharedShape::ball(0.5);
    let place = |i: usize| Pose::translation((i % columns) as Real, 0.0, (i / columns) as Real);
    SharedShape::compound((0..count).map(|i| (place(i), ball.clone())).collect())
}

/// A ball of a user's own type that counts how often its type is queried.
#[derive(Clone)]
struct Counted {
    ball: Ball,
    looks: Arc<AtomicUsize>,
}

impl Counted {
    fn look(&self) -> &Ball {
        self.looks.fetch_add(1, Relaxed);
        &self.ball
    }
}

impl Shape for Counted {
    fn compute_local_aabb(&self) -> Aabb {
        self.look().compute_local_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.look().compute_local_bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, _: Vector, _: u32) -> Option<Box<dyn Shape>> {
        None
    }

    fn mass_properties(&self, density: Real) -> MassProperties {
        self.look().mass_properties(density)
    }

    fn shape_type(&self) -> ShapeType {
        self.look();
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        self.look();
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> Real {
        self.look().radius
    }

    fn ccd_angular_thickness(&self) -> Real {
        0.0
    }
}

impl PointQuery for Counted {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        self.look().project_local_point(point, solid)
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        self.look().project_local_point_and_get_feature(point)
    }
}

impl RayCast for Counted {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        most: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        self.look().cast_local_ray_and_get_normal(ray, most, solid)
    }
}

/// A row of 1,000 parts, of which a cuboid meets two, or none.
#[test]
fn parts_far_away_are_not_looked_at() {
    let dispatcher = IsaGjkDispatcher::default();
    let cuboid = SharedShape::cuboid(0.5, 0.5, 0.5);
    let looks = Arc::new(AtomicUsize::new(0));
    let ball = Ball::new(0.5);
    let counted = looks.clone();
    let part = SharedShape::new(Counted {
        ball,
        looks: counted,
    });
    let place = |i: usize| Pose::translation(i as Real, 0.0, 0.0);
    let row = SharedShape::compound((0..1000).map(|i| (place(i), part.clone())).collect());
    for (x, most) in [(-2.0, 0), (500.0, 40)] {
        let pose = Pose::translation(x, 0.9, 0.0);
        let mut memory = Memory::default();
        for order in [[&row, &cuboid], [&cuboid, &row]] {
            let pose = if std::ptr::eq(order[0], &row) {
                pose
            } else {
                pose.inverse()
            };
            looks.store(0, Relaxed);
            memory.update(&dispatcher, &pose, order, 0.02);
            let looks = looks.load(Relaxed);
            assert!(looks <= most, "{looks} looks at {x}");
        }
    }
}

/// However the pairs of parts come and go, each is answered as if it were new.
#[test]
fn the_manifold_of_each_pair_is_its_own() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(117);
    let parts = balls(400, 20);
    let hull = rng.hull(40, 3.0).shape;
    let mut memory = Memory::default();
    let mut met = 0;
    for _ in 0..60 {
        let [x, z] = [(); 2].map(|()| rng.range(0.0, 19.0) as Real);
        let pose = Pose::translation(x, 1.0, z);
        let mut cold = Memory::default();
        for memory in [&mut memory, &mut cold] {
            memory.update(&dispatcher, &pose, [&parts, &hull], 0.02);
        }
        let pairs = [&memory, &cold].map(|memory| {
            let ids = memory.manifolds.iter().map(|m| (m.subshape1, m.subshape2));
            ids.collect::<Vec<_>>()
        });
        assert_eq!(pairs[0], pairs[1]);
        for (warm, cold) in memory.manifolds.iter().zip(&cold.manifolds) {
            assert_eq!(warm.subshape_pos1(), cold.subshape_pos1());
            let [warm, cold] = [warm, cold].map(|m| m.find_deepest_contact().map(|p| p.dist));
            match (warm, cold) {
                (Some(warm), Some(cold)) => assert!((warm - cold).abs() < 1e-5),
                _ => assert_eq!(warm, cold),
            }
            met += usize::from(cold.is_some());
        }
    }
    assert!(met > 300, "only {met} contacts");
}
