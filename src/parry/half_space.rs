//! Hulls over half-spaces: one support against the plane is the whole query.

use glam::Quat;

use crate::gjk::SeparatingAxis;
use crate::parry::convert::HalfSpace;
use crate::parry::pair::Pair;
use crate::parry::still_cache::StillPair;
use crate::pose::RelativePose;
use crate::query::{Feature, PairMemory, Proximity, Sink};
use crate::stats::{Cost, Stage};
use crate::support::{FaceId, ShapeId, ShapeKind, Support, VertexId};

/// Hands the answer to `sink`, and returns the stage that found it.
#[inline(always)]
pub(crate) fn run_into(
    pair: &Pair<'_, HalfSpace>,
    pose: &RelativePose,
    max_distance: f64,
    sink: &mut impl Sink,
    cost: &mut Cost,
) -> Stage {
    // Every hull of a world is in a pair with its ground, and most of these pairs end here.
    if is_sphere_apart(pair, pose, max_distance) {
        sink.spheres_apart();
        return Stage::BoundingSpheres;
    }
    let near = deepest(pair, pose, &sink.memory(), cost);
    if near.signed_distance <= max_distance {
        sink.near(&near);
        return Stage::Feature;
    }
    sink.separated(&SeparatingAxis {
        axis: near.normal,
        separation: near.signed_distance,
        ids: [near.features[0].vertex(pair.hull), VertexId::default()],
    });
    Stage::Axis
}

/// The pair of a hull and a half-space, whose frame is that of the larger shape.
pub(crate) fn still_pair(
    pair: &Pair<'_, HalfSpace>,
    pose: &RelativePose,
    rotation: Quat,
    key: u64,
) -> Option<StillPair> {
    let normal = pair.other.normal.to_array();
    Some(StillPair {
        key,
        shapes: [
            pair.hull.id()?,
            ShapeId::described_by(ShapeKind::HalfSpace, normal),
        ],
        rotation,
        place: pose.point_to_2(pair.hull.center()),
        radius: pair.hull.radius(),
    })
}

/// Whether the bounding sphere of a hull is above a half-space by more than `beyond`.
#[inline(always)]
fn is_sphere_apart(pair: &Pair<'_, HalfSpace>, pose: &RelativePose, beyond: f64) -> bool {
    let center = pose.point_to_2(pair.hull.center());
    pair.other.normal.dot(center) - pair.hull.radius() > beyond
}

/// The vertex of a hull that is deepest in a half-space.
#[inline(always)]
pub(crate) fn deepest(
    pair: &Pair<'_, HalfSpace>,
    pose: &RelativePose,
    memory: &PairMemory,
    cost: &mut Cost,
) -> Proximity {
    let (hull, normal_2) = (pair.hull, pair.other.normal);
    let normal = -pose.direction_to_1(normal_2);
    let start = match *memory {
        PairMemory::None => hull.start_vertex(normal),
        PairMemory::Axis(_, [vertex, _]) => hull.clamp_vertex(vertex),
        PairMemory::Contact(_, [feature, _]) => feature.vertex(hull),
    };
    let (on_1, vertex) = hull.support(normal, start, cost);
    let signed_distance = normal_2.dot(pose.point_to_2(on_1));
    Proximity {
        signed_distance,
        normal,
        on_1,
        on_2: on_1 + normal * signed_distance,
        features: [Feature::Vertex(vertex), Feature::Face(FaceId::default())],
    }
}
