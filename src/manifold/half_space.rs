//! Contacts with a half-space: corners of the face that lies on it.

use glam::Vec2;

use super::clip::Clipper;
use super::contact_frame::ContactFrame;
use super::contacts::{Contacts, MAX_POINTS};
use super::outline::PatchCorner;
use super::reduce::Selection;
use super::scratch::ClipScratch;
use crate::pose::{RelativePose, is_unit};
use crate::query::{Feature, Proximity};
use crate::simd::{DVec3x4, LANES, f64x4, to_f32x4};
use crate::support::{FaceCorners, FaceId, Polytope, VertexId};
use crate::tuning::{EDGE_ON, SAME_POINT};

/// The contacts of a polytope with the half-space in front of its deepest vertex, which is the witness of
/// `proximity`: this vertex, and other corners of a face around it. If there are too many corners, it chooses
/// those that span the largest area, first among those nearer than `max_distance`. `pose` is the pose of the
/// half-space.
pub fn half_space_contacts(
    shape: &impl Polytope,
    pose: &RelativePose,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let witness = proximity.features[0].vertex(shape);
    let normal = proximity.normal;
    debug_assert!(is_unit(normal), "no unit vector: {normal}");
    let face = shape.face_at_vertex(witness, normal);
    let polygon = shape.cluster(face).map_or(face, |(outline, _)| outline);
    let corners = shape.face_corners(polygon);
    let count = corners.count();
    let corner = |i: usize| corners.vertex(i.min(count - 1));
    let mut selection = Selection::default();
    selection.push(None);
    let is_edge_on = shape.face_normal(face).dot(normal) <= EDGE_ON;
    if !is_edge_on && count > MAX_POINTS {
        push_spread(
            shape,
            polygon,
            proximity,
            max_distance,
            scratch,
            &mut selection,
        );
    } else if !is_edge_on {
        let others = (0..count).filter(|&i| corner(i) != witness);
        let most = others.take(MAX_POINTS - 1);
        most.for_each(|i| selection.push(Some(i)));
    }
    let vertex = |i: Option<usize>| i.map_or(witness, corner);
    let [a, b, c, d] = selection.corners;
    let vertices = [vertex(a), vertex(b), vertex(c), vertex(d)];
    Contacts {
        len: selection.len,
        ..contacts_at(shape, pose, proximity, vertices)
    }
}

/// The contacts of four vertices.
#[inline]
fn contacts_at(
    shape: &impl Polytope,
    pose: &RelativePose,
    proximity: &Proximity,
    vertices: [VertexId; MAX_POINTS],
) -> Contacts {
    let [a, b, c, d] = vertices;
    let on_1 = DVec3x4::gather(vertices, |vertex| shape.vertex(vertex));
    let distance = distances(proximity, on_1);
    let on_2 = pose.points_to_2(on_1 + DVec3x4::scaled(proximity.normal, distance));
    let features = |vertex| [Feature::Vertex(vertex), proximity.features[1]];
    Contacts {
        on_1: on_1.to_f32x4(),
        on_2: on_2.to_f32x4(),
        distance: to_f32x4(distance),
        features: [features(a), features(b), features(c), features(d)],
        len: MAX_POINTS,
    }
}

/// The distances of points of the polytope from the half-space.
#[inline]
fn distances(proximity: &Proximity, on_1: DVec3x4) -> f64x4 {
    let beyond = (on_1 - proximity.on_1).dot(proximity.normal);
    f64x4::splat(proximity.signed_distance) - beyond
}

/// The corners of the face that lies on a half-space, cut off at `max_distance` from it, counter-clockwise
/// seen from the half-space. There are none if the face is edge-on.
pub fn half_space_polygon(
    shape: &impl Polytope,
    near: &Proximity,
    max_distance: f64,
) -> Vec<PatchCorner> {
    let normal = near.normal;
    let face = shape.face_at_vertex(near.features[0].vertex(shape), normal);
    if shape.face_normal(face).dot(normal) <= EDGE_ON {
        return Vec::new();
    }
    let corners = shape.face_corners(shape.cluster(face).map_or(face, |(outline, _)| outline));
    let count = corners.count();
    let corner = |i: usize| {
        let vertex = corners.vertex(i % count);
        let on_1 = shape.vertex(vertex);
        PatchCorner {
            on_1,
            distance: near.signed_distance - (on_1 - near.on_1).dot(normal),
            features: [Feature::Vertex(vertex), near.features[1]],
        }
    };
    let is_near = |corner: &PatchCorner| corner.distance <= max_distance;
    let mut kept = Vec::new();
    for i in 0..count {
        let (from, to) = (corner(i), corner(i + 1));
        if is_near(&from) {
            kept.push(from);
        }
        if is_near(&from) != is_near(&to) {
            let edge = corners.edge(i).map(Feature::Edge);
            let share = (max_distance - from.distance) / (to.distance - from.distance);
            kept.push(PatchCorner {
                on_1: from.on_1.lerp(to.on_1, share),
                distance: max_distance,
                features: [edge.unwrap_or(Feature::Face(face)), near.features[1]],
            });
        }
    }
    kept
}

/// Adds corners of a face that span much of the plane, first among those nearer than `max_distance`.
fn push_spread(
    shape: &impl Polytope,
    polygon: FaceId,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
    selection: &mut Selection,
) {
    let ClipScratch {
        clipper: Clipper {
            window, corners, ..
        },
        candidates,
        ..
    } = scratch;
    let polygon = shape.face_corners(polygon);
    let count = polygon.count();
    let plane = ContactFrame::new(proximity.on_1, proximity.normal).projection();
    window.set(count, |numbers| {
        plane.flatten(numbers.map(|i| polygon.point(i)))
    });
    corners.set(window);
    let of_row = |row: usize, _, _| {
        let corner = |lane: usize| (LANES * row + lane).min(count - 1);
        let of_lane = |lane| shape.vertex(polygon.vertex(corner(lane)));
        to_f32x4(distances(proximity, DVec3x4::gather([0, 1, 2, 3], of_lane)))
    };
    let range = f32::NEG_INFINITY..=max_distance as f32;
    let same = SAME_POINT * shape.radius() as f32;
    candidates.set(corners, of_row, range, same);
    let from = (Vec2::ZERO, proximity.signed_distance as f32);
    selection.push_all(candidates.spread_out(corners, from, same));
    selection.fill_up(candidates);
}
