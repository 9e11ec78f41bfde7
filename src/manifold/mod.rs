//! The contact manifold: the two faces in contact, clipped against each other and reduced to
//! four points.
//!
//! A face with neighbours that lie nearly in its plane is taken together with them. Both are
//! projected along the contact normal onto one plane, where their polygons are intersected as
//! wholes. Every corner of the intersection is a contact: its points lie on the two surfaces, on
//! one line along the normal. The witness of the query always stays, first in the list; so the
//! manifold's deepest point is the query's answer.

mod clip;
mod patch;
mod polygon;
mod reduce;

use glam::{DVec3, Vec2, Vec3};
use wide::f32x4;

use crate::pose::RelativePose;
use crate::query::{Feature, Proximity};
use crate::support::{Cso, Polytope};
use clip::Polygons;
use patch::{FacePlane, Frame, Patch};
use polygon::LANES;
use reduce::Candidates;

/// More points than this add no stiffness to a rigid contact.
pub const MAX_POINTS: usize = 4;

/// Contacts nearer to each other than this share of the smaller shape's radius are one.
const SAME_POINT: f32 = 1e-3;

/// A corner of the contact patch is as deep as the witness up to this share of the smaller
/// shape's radius: the rounding of f32 face planes.
const SAME_DEPTH: f64 = 2e-6;

/// Memory for manifolds, kept from one to the next so that none of them allocates.
#[derive(Clone, Debug, Default)]
pub struct ClipScratch {
    planes: [Vec<FacePlane>; 2],
    polygons: Polygons,
    candidates: Candidates,
}

/// One contact: a point on each shape, on a line along the manifold's normal.
#[derive(Clone, Copy, Debug)]
pub struct ContactPoint {
    /// On the first shape, in frame 1.
    pub on_1: Vec3,
    /// On the second shape, in frame 2.
    pub on_2: Vec3,
    /// From the first to the second along the normal: negative where the shapes overlap.
    pub distance: f64,
    /// What meets there.
    pub features: [Feature; 2],
}

/// Up to four contacts with one normal.
#[derive(Clone, Copy, Debug)]
pub struct Contacts {
    points: [ContactPoint; MAX_POINTS],
    len: usize,
}

impl Contacts {
    /// The contacts; the witness of the query comes first.
    #[inline]
    pub fn as_slice(&self) -> &[ContactPoint] {
        &self.points[..self.len]
    }

    /// As many contacts as there can be: those, and others that mean nothing.
    #[inline]
    pub(crate) fn padded(&self) -> &[ContactPoint; MAX_POINTS] {
        &self.points
    }

    /// The witness alone.
    #[inline]
    pub fn witness(proximity: &Proximity, pose: &RelativePose) -> Self {
        let point = ContactPoint {
            on_1: proximity.on_1.as_vec3(),
            on_2: pose.point_to_2(proximity.on_2).as_vec3(),
            distance: proximity.signed_distance,
            features: proximity.features,
        };
        Self {
            points: [point; MAX_POINTS],
            len: 1,
        }
    }

    #[inline]
    fn push(&mut self, point: ContactPoint) {
        self.points[self.len] = point;
        self.len += 1;
    }
}

/// The contacts around the witness of a query along its normal: those nearer than `max_distance`
/// first, then the nearest of the others, which a solver needs for what moves fast.
///
/// Where there is room the first contact is there twice, as it is in parry's manifolds. To a solver
/// a contact is a spring, and a body that lies on one or two of them sinks in too far.
pub fn contacts<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let mut contacts = Contacts::witness(proximity, cso.pose);
    let ClipScratch {
        planes,
        polygons,
        candidates,
    } = scratch;
    let Some(patch) = Patch::new(cso, proximity, proximity.normal, planes) else {
        return contacts;
    };
    // Along the query's normal nothing is deeper than the query's answer.
    let least = proximity.signed_distance;
    let scale = cso.smaller_radius();
    patch.clip(cso, polygons);
    let corners = &polygons.corners;
    let distances = |_, x, y| patch.distances(x, y);
    let range = f32::NEG_INFINITY..=(max_distance / scale) as f32;
    let survey = candidates.set(corners, distances, range, SAME_POINT);
    let contact = |corner, distance| {
        let at = (corners.at(corner), polygons.tag(corner));
        patch.contact(cso, at, distance, least)
    };
    let mut first = Vec2::ZERO;
    // Over two faces the distance is linear, so a corner is deepest. A witness that is no corner
    // and no deeper (somewhere inside of two parallel faces) must not take a corner's place.
    if !survey.at_origin
        && let Some(deepest) = survey.deepest
        && f64::from(candidates.distance(deepest)) <= least / scale + SAME_DEPTH
    {
        first = corners.at(deepest);
        contacts.points[0] = contact(deepest, candidates.distance(deepest));
    }
    let spread = candidates.spread(corners, first, SAME_POINT);
    for corner in spread.into_iter().flatten() {
        contacts.push(contact(corner, candidates.distance(corner)));
    }
    if contacts.len < MAX_POINTS {
        contacts.push(contacts.points[0]);
    }
    while contacts.len < MAX_POINTS
        && let Some(corner) = candidates.take_beyond()
    {
        contacts.push(contact(corner, candidates.distance(corner)));
    }
    contacts
}

/// The contacts along another `normal` than the query's: one that was corrected for the internal
/// edges of a mesh. The witness, which belongs to the query's normal, is none of them. Distances
/// are within `range`.
pub fn contacts_along<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    proximity: &Proximity,
    normal: DVec3,
    range: [f64; 2],
    scratch: &mut ClipScratch,
) -> Contacts {
    let mut contacts = Contacts::witness(proximity, cso.pose);
    contacts.len = 0;
    let ClipScratch {
        planes,
        polygons,
        candidates,
    } = scratch;
    let Some(patch) = Patch::new(cso, proximity, normal, planes) else {
        return contacts;
    };
    patch.clip(cso, polygons);
    let corners = &polygons.corners;
    let [least, most] = range.map(|distance| (distance / cso.smaller_radius()) as f32);
    let distances = |_, x, y| patch.distances(x, y);
    let survey = candidates.set(corners, distances, least..=most, SAME_POINT);
    if let Some(deepest) = survey.deepest {
        let spread = candidates.spread(corners, corners.at(deepest), SAME_POINT);
        for corner in [Some(deepest)].into_iter().chain(spread).flatten() {
            let at = (corners.at(corner), polygons.tag(corner));
            contacts.push(patch.contact(cso, at, candidates.distance(corner), range[0]));
        }
    }
    contacts
}

/// The contacts of a polytope with the half-space in front of its deepest vertex, the witness of
/// `proximity`: corners of the face around it, those nearer than `max_distance` first.
pub fn half_space_contacts(
    shape: &impl Polytope,
    pose: &RelativePose,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let mut contacts = Contacts::witness(proximity, pose);
    let (normal, origin) = (proximity.normal, proximity.on_1);
    let face = patch::facing(shape, proximity.features[0], normal);
    if shape.face_normal(face).dot(normal) <= patch::EDGE_ON {
        return contacts;
    }
    let distance = |corner: DVec3| proximity.signed_distance - (corner - origin).dot(normal);
    let contact = |vertex| {
        let on_1 = shape.vertex(vertex);
        let distance = distance(on_1);
        ContactPoint {
            on_1: on_1.as_vec3(),
            on_2: pose.point_to_2(on_1 + normal * distance).as_vec3(),
            distance,
            features: [Feature::Vertex(vertex), proximity.features[1]],
        }
    };
    let polygon = shape.cap(face).map_or(face, |(outline, _)| outline);
    let count = shape.face_len(polygon);
    let corner = |i: usize| shape.face_vertex(polygon, i);
    if count <= MAX_POINTS {
        let others = (0..count).map(corner);
        let others = others.filter(|&v| proximity.features[0] != Feature::Vertex(v));
        for vertex in others.take(MAX_POINTS - 1) {
            contacts.push(contact(vertex));
        }
        return contacts;
    }
    let scale = shape.radius();
    let plane = Frame::new(origin, normal, scale).chart();
    let ClipScratch {
        polygons: Polygons {
            window, corners, ..
        },
        candidates,
        ..
    } = scratch;
    window.set(count, |numbers| {
        plane.flatten(shape.four_corners(polygon, numbers))
    });
    corners.set(window);
    let distances = |row: usize, _, _| {
        let of = |lane: usize| shape.vertex(corner((row * LANES + lane).min(count - 1)));
        f32x4::new([0, 1, 2, 3].map(|lane| (distance(of(lane)) / scale) as f32))
    };
    let range = f32::NEG_INFINITY..=(max_distance / scale) as f32;
    candidates.set(corners, distances, range, SAME_POINT);
    let spread = candidates.spread(corners, Vec2::ZERO, SAME_POINT);
    let mut chosen = spread.into_iter().flatten();
    while contacts.len < MAX_POINTS
        && let Some(i) = chosen.next().or_else(|| candidates.take_beyond())
    {
        contacts.push(contact(corner(i)));
    }
    contacts
}

#[cfg(test)]
mod tests {
    use parry3d::math::{Pose, Rotation};

    use super::*;
    use crate::epa::EpaScratch;
    use crate::hull::Hull;
    use crate::query::{Answer, Memory, Query};
    use crate::stats::Cost;

    fn prism(sides: u32, radius: f32) -> Hull {
        let points: Vec<Vec3> = (0..sides)
            .flat_map(|side| {
                let (sin, cos) = (std::f32::consts::TAU * side as f32 / sides as f32).sin_cos();
                [-0.5, 0.5].map(|y| Vec3::new(radius * cos, y, radius * sin))
            })
            .collect();
        Hull::from_points(&points).expect("a solid")
    }

    fn distance_to(shape: &impl Polytope, feature: Feature, point: DVec3) -> f64 {
        match feature {
            Feature::Vertex(v) => shape.vertex(v).distance(point),
            Feature::Edge(e) => {
                let [a, b] = shape.edge(e).expect("an edge").map(|v| shape.vertex(v));
                let along = (point - a).dot(b - a) / (b - a).length_squared();
                a.lerp(b, along.clamp(0.0, 1.0)).distance(point)
            }
            Feature::Face(f) => (shape.face_normal(f).dot(point) - shape.face_offset(f)).abs(),
        }
    }

    /// Whichever polygon is the window: one inside of the other, and both overhanging.
    #[test]
    fn contacts_lie_on_the_features_they_name() {
        for (sides, radii) in [
            ([4, 9], [1.0, 1.0]),
            ([9, 4], [1.0, 1.0]),
            ([9, 4], [1.0, 0.3]),
        ] {
            let shapes = [prism(sides[0], radii[0]), prism(sides[1], radii[1])];
            let turn = Rotation::from_scaled_axis(Vec3::new(1e-3, 0.4, 2e-3));
            let pose = Pose::from_parts(Vec3::new(0.3, 0.99, 0.1), turn);
            let pose = RelativePose::from_valid(&pose);
            let cso = Cso {
                shape_1: &shapes[0],
                shape_2: &shapes[1],
                pose: &pose,
            };
            let answer = Query {
                cso: &cso,
                max_distance: 0.1,
                shells: None,
                scratch: &mut EpaScratch::default(),
                cost: &mut Cost::default(),
            }
            .run(&Memory::None);
            let Some((Answer::Near(near), _)) = answer else {
                panic!("no contact: {answer:?}");
            };
            let found = contacts(&cso, &near, 0.1, &mut ClipScratch::default());
            assert_eq!(found.as_slice().len(), MAX_POINTS);
            for contact in found.as_slice() {
                let [on_1, on_2] = [contact.on_1, contact.on_2].map(|p| p.as_dvec3());
                let off = distance_to(&shapes[0], contact.features[0], on_1).max(distance_to(
                    &shapes[1],
                    contact.features[1],
                    on_2,
                ));
                // A point between tilted faces leaves its vertex or edge by depth times tilt.
                assert!(off < 1e-4, "{sides:?}: {contact:?} is {off} off");
            }
        }
    }
}
