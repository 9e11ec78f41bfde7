//! Contacts with a half-space: corners of the face that lies on it.

use glam::{DVec3, Vec2};
use wide::f32x4;

use super::clip::Polygons;
use super::contacts::{ContactPoint, Contacts, MAX_POINTS};
use super::patch;
use super::plane::{EDGE_ON, Frame};
use super::polygon::LANES;
use super::{ClipScratch, SAME_POINT};
use crate::pose::RelativePose;
use crate::query::{Feature, Proximity};
use crate::support::Polytope;

/// The contacts of a polytope with the half-space in front of its deepest vertex, the witness of
/// `proximity`: corners of the face around it, those nearer than `max_distance` first. `pose` is that of
/// the half-space.
pub fn half_space_contacts(
    shape: &impl Polytope,
    pose: &RelativePose,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let mut contacts = [ContactPoint::witness(proximity, pose); MAX_POINTS];
    let (normal, origin) = (proximity.normal, proximity.on_1);
    let face = patch::facing(shape, proximity.features[0], normal);
    if shape.face_normal(face).dot(normal) <= EDGE_ON {
        return Contacts::new(&contacts[..1]);
    }
    let polygon = shape.cap(face).map_or(face, |(outline, _)| outline);
    let count = shape.face_len(polygon);
    let corner = |i: usize| shape.face_vertex(polygon, i.min(count - 1));
    let distance = |on_1: DVec3| proximity.signed_distance - (on_1 - origin).dot(normal);
    let mut len = 1;
    let mut push = |vertex| {
        let on_1 = shape.vertex(vertex);
        let distance = distance(on_1);
        contacts[len] = ContactPoint {
            on_1: on_1.as_vec3(),
            on_2: pose.point_to_2(on_1 + normal * distance).as_vec3(),
            distance: distance as f32,
            features: [Feature::Vertex(vertex), proximity.features[1]],
        };
        len += 1;
        len == MAX_POINTS
    };
    if count <= MAX_POINTS {
        let others = (0..count).map(corner);
        let mut others = others.filter(|&v| proximity.features[0] != Feature::Vertex(v));
        others.any(push);
        return Contacts::new(&contacts[..len]);
    }
    let ClipScratch {
        polygons: Polygons {
            window, corners, ..
        },
        candidates,
        ..
    } = scratch;
    let plane = Frame::new(origin, normal).chart();
    window.set(count, |numbers| {
        plane.flatten(shape.four_corners(polygon, numbers))
    });
    corners.set(window);
    let distances = |row: usize, _, _| {
        let of_lane = |lane| distance(shape.vertex(corner(LANES * row + lane)));
        f32x4::new([0, 1, 2, 3].map(|lane| of_lane(lane) as f32))
    };
    let range = f32::NEG_INFINITY..=max_distance as f32;
    let same = SAME_POINT * shape.radius() as f32;
    candidates.set(corners, distances, range, same);
    let spread = candidates.spread(corners, Vec2::ZERO, same);
    let mut chosen = spread.into_iter().flatten();
    while let Some(i) = chosen.next().or_else(|| candidates.take_beyond()) {
        if push(corner(i)) {
            break;
        }
    }
    Contacts::new(&contacts[..len])
}
