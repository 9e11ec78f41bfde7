//! Contacts with a half-space: corners of the face that lies on it.

use glam::Vec2;
use wide::f64x4;

use super::clip::Polygons;
use super::contacts::{Contacts, MAX_POINTS};
use super::plane::Frame;
use super::polygon::LANES;
use super::{Chosen, ClipScratch};
use crate::fours::{Vectors, as_f32};
use crate::pose::RelativePose;
use crate::query::{Feature, Proximity, vertex_of};
use crate::support::Polytope;
use crate::tuning::{EDGE_ON, SAME_POINT};

/// The contacts of a polytope with the half-space in front of its deepest vertex, the witness of
/// `proximity`: with it corners of the face around it. Of more corners than there is room for those that
/// span most, first among those nearer than `max_distance`. `pose` is that of the half-space.
pub fn half_space_contacts(
    shape: &impl Polytope,
    pose: &RelativePose,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let witness = vertex_of(shape, proximity.features[0]);
    let (normal, origin) = (proximity.normal, proximity.on_1);
    let distance = |on_1: Vectors| {
        let beyond = (on_1 - origin).dot(normal);
        f64x4::splat(proximity.signed_distance) - beyond
    };
    let face = shape.face_at(witness, normal);
    let polygon = shape.cap(face).map_or(face, |(outline, _)| outline);
    let count = shape.face_len(polygon);
    let corner = |i: usize| shape.face_vertex(polygon, i.min(count - 1));
    let contacts = |chosen: &Chosen| {
        let [a, b, c, d] = chosen.corners;
        let vertex = |i: Option<usize>| i.map_or(witness, corner);
        let vertices @ [a, b, c, d] = [vertex(a), vertex(b), vertex(c), vertex(d)];
        let on_1 = Vectors::of(vertices, |vertex| shape.vertex(vertex));
        let distance = distance(on_1);
        let on_2 = pose.points_to_2(on_1 + Vectors::along(normal, distance));
        let features = |vertex| [Feature::Vertex(vertex), proximity.features[1]];
        Contacts {
            on_1: on_1.as_f32(),
            on_2: on_2.as_f32(),
            distance: as_f32(distance),
            features: [features(a), features(b), features(c), features(d)],
            len: chosen.len,
        }
    };
    let mut chosen = Chosen::default();
    chosen.push(None);
    if shape.face_normal(face).dot(normal) <= EDGE_ON {
        return contacts(&chosen);
    }
    if count <= MAX_POINTS {
        let others = (0..count).filter(|&i| corner(i) != witness);
        others
            .take(MAX_POINTS - 1)
            .for_each(|i| chosen.push(Some(i)));
        return contacts(&chosen);
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
        let of_lane = |lane| shape.vertex(corner(LANES * row + lane));
        as_f32(distance(Vectors::of([0, 1, 2, 3], of_lane)))
    };
    let range = f32::NEG_INFINITY..=max_distance as f32;
    let same = SAME_POINT * shape.radius() as f32;
    candidates.set(corners, distances, range, same);
    chosen.push_all(candidates.spread(corners, Vec2::ZERO, same));
    chosen.fill_up(candidates);
    contacts(&chosen)
}
