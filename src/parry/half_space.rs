//! Hulls over half-spaces: one support against the plane is the whole query.

use glam::{DVec3, Quat};

use crate::hull::Hull;
use crate::parry::convert::HalfSpace;
use crate::parry::pair::Pair;
use crate::parry::still_cache::StillPair;
use crate::pose::RelativePose;
use crate::query::{Feature, Proximity};
use crate::stats::Cost;
use crate::support::{FaceId, Support, VertexId};

/// The boundary of a half-space, in the frame of a hull.
pub(crate) struct Plane {
    /// The unit normal into the half-space.
    pub normal: DVec3,
    /// A point of the plane.
    origin: DVec3,
}

impl Plane {
    #[inline]
    pub fn new(half_space: &HalfSpace, pose: &RelativePose) -> Self {
        Self {
            normal: -pose.direction_to_1(half_space.normal),
            origin: pose.translation(),
        }
    }

    #[inline]
    fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(self.origin - p)
    }

    /// Whether the bounding sphere of a hull is above it by more than `beyond`.
    #[inline]
    pub fn is_sphere_apart(&self, hull: &Hull, beyond: f64) -> bool {
        self.height(hull.center()) - hull.radius() > beyond
    }

    /// The vertex of a hull that is deepest in the half-space. The search begins at `start`.
    #[inline]
    pub fn deepest(&self, hull: &Hull, start: VertexId, cost: &mut Cost) -> Proximity {
        let normal = self.normal;
        let (on_1, vertex) = hull.support(normal, start, cost);
        let signed_distance = self.height(on_1);
        Proximity {
            signed_distance,
            normal,
            on_1,
            on_2: on_1 + normal * signed_distance,
            features: [Feature::Vertex(vertex), Feature::Face(FaceId::default())],
        }
    }
}

/// The vertex of a hull that is deepest in a half-space, or `None` if it is farther away than `max_distance`.
#[inline]
pub(crate) fn deepest(
    pair: &Pair<'_, HalfSpace>,
    pose: &RelativePose,
    max_distance: f64,
) -> Option<Proximity> {
    let (hull, plane) = (pair.hull, Plane::new(pair.other, pose));
    if plane.is_sphere_apart(hull, max_distance) {
        return None;
    }
    let start = hull.start_vertex(plane.normal);
    let near = plane.deepest(hull, start, &mut Cost::default());
    (near.signed_distance <= max_distance).then_some(near)
}

/// The pair of a hull and a half-space, whose frame is that of the larger shape.
pub(crate) fn still_pair(
    pair: &Pair<'_, HalfSpace>,
    pose: &RelativePose,
    rotation: Quat,
    key: u64,
) -> Option<StillPair> {
    Some(StillPair {
        key,
        shapes: [pair.hull.id()?, pair.other.id()],
        rotation,
        place: pose.point_to_2(pair.hull.center()),
        radius: pair.hull.radius(),
    })
}
