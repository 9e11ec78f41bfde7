//! Contacts with a half-space: corners of the face that lies on it.

use glam::Vec2;
use wide::f64x4;

use super::clip::Polygons;
use super::contacts::{Contacts, MAX_POINTS};
use super::plane::{EDGE_ON, Frame};
use super::polygon::LANES;
use super::{ClipScratch, SAME_POINT};
use crate::fours::{Vectors, as_f32};
use crate::pose::RelativePose;
use crate::query::{Feature, Proximity, vertex_of};
use crate::support::{Polytope, VertexId};

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
    let witness = vertex_of(shape, proximity.features[0]);
    let (normal, origin) = (proximity.normal, proximity.on_1);
    let distance = |on_1: Vectors| {
        let beyond = (on_1 - origin).dot(normal);
        f64x4::splat(proximity.signed_distance) - beyond
    };
    let contacts_at = |chosen: &Chosen| {
        let [a, b, c, d] = chosen.vertices;
        let on_1 = Vectors::new([
            shape.vertex(a),
            shape.vertex(b),
            shape.vertex(c),
            shape.vertex(d),
        ]);
        let distance = distance(on_1);
        let on_2 = pose.points_to_2(on_1 + Vectors::along(normal, distance));
        let plane = proximity.features[1];
        Contacts {
            on_1: on_1.as_f32(),
            on_2: on_2.as_f32(),
            distance: as_f32(distance),
            features: [
                [Feature::Vertex(a), plane],
                [Feature::Vertex(b), plane],
                [Feature::Vertex(c), plane],
                [Feature::Vertex(d), plane],
            ],
            len: chosen.len,
        }
    };
    let mut chosen = Chosen::new(witness);
    let face = shape.face_at(witness, normal);
    if shape.face_normal(face).dot(normal) <= EDGE_ON {
        return contacts_at(&chosen);
    }
    let polygon = shape.cap(face).map_or(face, |(outline, _)| outline);
    let count = shape.face_len(polygon);
    let corner = |i: usize| shape.face_vertex(polygon, i.min(count - 1));
    if count <= MAX_POINTS {
        (0..count).map(corner).for_each(|vertex| chosen.add(vertex));
        return contacts_at(&chosen);
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
        as_f32(distance(Vectors::new([
            of_lane(0),
            of_lane(1),
            of_lane(2),
            of_lane(3),
        ])))
    };
    let range = f32::NEG_INFINITY..=max_distance as f32;
    let same = SAME_POINT * shape.radius() as f32;
    candidates.set(corners, distances, range, same);
    let spread = candidates.spread(corners, Vec2::ZERO, same);
    for i in spread.into_iter().flatten() {
        chosen.add(corner(i));
    }
    while chosen.len < MAX_POINTS
        && let Some(i) = candidates.take_beyond()
    {
        chosen.add(corner(i));
    }
    contacts_at(&chosen)
}

/// The vertices that become contacts, the witness first.
struct Chosen {
    /// After the last one, the witness again.
    vertices: [VertexId; MAX_POINTS],
    len: usize,
}

impl Chosen {
    #[inline]
    fn new(witness: VertexId) -> Self {
        Self {
            vertices: [witness; MAX_POINTS],
            len: 1,
        }
    }

    /// One more, if it is not the witness and there is room.
    #[inline]
    fn add(&mut self, vertex: VertexId) {
        if self.len < MAX_POINTS && vertex != self.vertices[0] {
            self.vertices[self.len] = vertex;
            self.len += 1;
        }
    }
}
