//! The contact manifold: the two faces in contact, clipped against each other and reduced to
//! four points.
//!
//! Both faces are projected along the contact normal onto one plane, where their polygons are
//! intersected as wholes. Every corner of the intersection is a contact: its points lie on the
//! two faces, on one line along the normal. The witness of the query always stays, first in the
//! list; so the manifold's deepest point is the query's answer.

mod clip;
mod reduce;

use glam::{DVec2, DVec3};

use crate::query::{Feature, Proximity};
use crate::support::{Cso, FaceId, Polytope};
pub use clip::ClipScratch;
use clip::{ClipVertex, Tag};

/// More points than this add no stiffness to a rigid contact.
pub const MAX_POINTS: usize = 4;

/// A face seen edge-on (cosine to the contact normal) has no usable projection.
const EDGE_ON: f64 = 0.05;

/// Contacts nearer to each other than this share of the smaller shape's radius are one.
const SAME_POINT: f64 = 1e-3;

/// A corner of the contact patch is as deep as the witness up to this share of the smaller
/// shape's radius: the rounding of f32 face planes.
const SAME_DEPTH: f64 = 2e-6;

/// One contact: a point on each shape, on a line along the manifold's normal. In frame 1.
#[derive(Clone, Copy, Debug)]
pub struct ContactPoint {
    /// On the first shape.
    pub on_1: DVec3,
    /// On the second shape.
    pub on_2: DVec3,
    /// `(on_2 - on_1) · normal`: negative where the shapes overlap.
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
    pub fn as_slice(&self) -> &[ContactPoint] {
        &self.points[..self.len]
    }

    /// The witness alone.
    pub fn witness(proximity: &Proximity) -> Self {
        let point = ContactPoint {
            on_1: proximity.on_1,
            on_2: proximity.on_2,
            distance: proximity.signed_distance,
            features: proximity.features,
        };
        Self {
            points: [point; MAX_POINTS],
            len: 1,
        }
    }

    fn push(&mut self, point: ContactPoint) {
        self.points[self.len] = point;
        self.len += 1;
    }
}

/// The contacts around the witness of a query along its normal: those nearer than `max_distance`
/// first, then the nearest of the others, which a solver needs for what moves fast.
pub fn contacts<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let mut contacts = Contacts::witness(proximity);
    let Some(patch) = Patch::new(cso, proximity, proximity.normal) else {
        return contacts;
    };
    patch.clip(cso, scratch);
    let corners = patch.corners_within(scratch, [f64::NEG_INFINITY, f64::INFINITY]);
    let (corners, beyond) = reduce::split(corners, max_distance);
    let scale = cso.smaller_radius();
    let same = SAME_POINT * scale;
    let mut first = DVec2::ZERO;
    // Over the patch the distance is linear, so a corner is deepest. A witness that is no corner
    // and no deeper (somewhere inside of two parallel faces) must not take a corner's place.
    if !corners.iter().any(|c| c.at.length_squared() <= same * same)
        && let Some(deepest) = reduce::deepest(corners)
        && deepest.distance <= contacts.points[0].distance + SAME_DEPTH * scale
    {
        first = deepest.at;
        contacts.points[0] = patch.contact(cso, deepest);
    }
    for corner in reduce::spread(corners, first, same) {
        contacts.push(patch.contact(cso, corner));
    }
    for corner in beyond.iter().take(MAX_POINTS - contacts.len) {
        contacts.push(patch.contact(cso, corner));
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
    let mut contacts = Contacts::witness(proximity);
    contacts.len = 0;
    if let Some(patch) = Patch::new(cso, proximity, normal) {
        patch.clip(cso, scratch);
        let corners = patch.corners_within(scratch, range);
        if let Some(deepest) = reduce::deepest(corners) {
            contacts.push(patch.contact(cso, deepest));
            let same = SAME_POINT * cso.smaller_radius();
            for corner in reduce::spread(corners, deepest.at, same) {
                contacts.push(patch.contact(cso, corner));
            }
        }
    }
    contacts
}

/// The contacts of a polytope with the half-space in front of its deepest vertex, the witness of
/// `proximity`: corners of the face around it, those nearer than `max_distance` first.
pub fn half_space_contacts(
    shape: &impl Polytope,
    proximity: &Proximity,
    max_distance: f64,
    scratch: &mut ClipScratch,
) -> Contacts {
    let mut contacts = Contacts::witness(proximity);
    let (normal, origin) = (proximity.normal, proximity.on_1);
    let face = facing(shape, proximity.features[0], normal);
    if shape.face_normal(face).dot(normal) <= EDGE_ON {
        return contacts;
    }
    let distance = |corner: DVec3| proximity.signed_distance - (corner - origin).dot(normal);
    let contact = |vertex| {
        let on_1 = shape.vertex(vertex);
        let distance = distance(on_1);
        ContactPoint {
            on_1,
            on_2: on_1 + normal * distance,
            distance,
            features: [Feature::Vertex(vertex), proximity.features[1]],
        }
    };
    let count = shape.face_len(face);
    let corner = |i: usize| shape.face_vertex(face, i);
    if count <= MAX_POINTS {
        let others = (0..count).map(corner);
        let others = others.filter(|&v| proximity.features[0] != Feature::Vertex(v));
        for vertex in others.take(MAX_POINTS - 1) {
            contacts.push(contact(vertex));
        }
        return contacts;
    }
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    scratch.polygon.clear();
    scratch.polygon.extend((0..count).map(|i| {
        let place = shape.vertex(corner(i)) - origin;
        let mut vertex = ClipVertex::corner(DVec2::new(place.dot(u), place.dot(v)), i);
        vertex.distance = distance(shape.vertex(corner(i)));
        vertex
    }));
    let (corners, beyond) = reduce::split(&mut scratch.polygon, max_distance);
    let spread = reduce::spread(corners, DVec2::ZERO, SAME_POINT * shape.radius());
    for vertex in spread.chain(beyond).take(MAX_POINTS - 1) {
        if let Tag::Corner(i) = vertex.tag {
            contacts.push(contact(corner(i.into())));
        }
    }
    contacts
}

/// The plane of a face over the contact plane: `height(x) = base + slope · x` along the normal.
#[derive(Clone, Copy)]
struct FacePlane {
    face: FaceId,
    base: f64,
    slope: DVec2,
}

/// The two faces in the contact plane, whose origin is the witness point of shape 1.
struct Patch {
    origin: DVec3,
    normal: DVec3,
    axes: [DVec3; 2],
    planes: [FacePlane; 2],
}

impl Patch {
    fn new<A: Polytope, B: Polytope>(
        cso: &Cso<'_, A, B>,
        proximity: &Proximity,
        normal: DVec3,
    ) -> Option<Self> {
        let outward_2 = -cso.pose.direction_to_2(normal);
        let [f1, f2] = [
            facing(cso.shape_1, proximity.features[0], normal),
            facing(cso.shape_2, proximity.features[1], outward_2),
        ];
        let n1 = cso.shape_1.face_normal(f1);
        let origin = proximity.on_1;
        let (n2, offset_2) = plane_2(cso, f2, normal, origin)?;
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        // `sign` is that of the face's outward normal along the contact normal.
        let plane = |face, sign: f64, outward: DVec3, offset: f64| {
            let along = outward.dot(normal);
            (along * sign > EDGE_ON).then(|| FacePlane {
                face,
                base: offset / along,
                slope: -DVec2::new(outward.dot(u), outward.dot(v)) / along,
            })
        };
        Some(Self {
            origin,
            normal,
            axes: [u, v],
            planes: [
                plane(f1, 1.0, n1, cso.shape_1.face_offset(f1) - n1.dot(origin))?,
                plane(f2, -1.0, n2, offset_2)?,
            ],
        })
    }

    fn flatten(&self, p: DVec3) -> DVec2 {
        let p = p - self.origin;
        DVec2::new(p.dot(self.axes[0]), p.dot(self.axes[1]))
    }

    /// Leaves the intersection of both polygons in `scratch`.
    fn clip<A: Polytope, B: Polytope>(&self, cso: &Cso<'_, A, B>, scratch: &mut ClipScratch) {
        let [f1, f2] = [self.planes[0].face, self.planes[1].face];
        let count_1 = cso.shape_1.face_len(f1);
        let count_2 = cso.shape_2.face_len(f2);
        scratch.window.clear();
        scratch.window.extend(
            (0..count_1).map(|i| self.flatten(cso.shape_1.vertex(cso.shape_1.face_vertex(f1, i)))),
        );
        scratch.polygon.clear();
        scratch.polygon.extend((0..count_2).map(|i| {
            let vertex = cso.shape_2.vertex(cso.shape_2.face_vertex(f2, i));
            ClipVertex::corner(self.flatten(cso.pose.point_to_1(vertex)), i)
        }));
        if count_2 == 2 {
            clip::intersect_line(scratch);
        } else {
            clip::intersect(scratch);
        }
    }

    /// The corners of the intersection whose distances are within `range`.
    fn corners_within<'s>(
        &self,
        scratch: &'s mut ClipScratch,
        range: [f64; 2],
    ) -> &'s mut [ClipVertex] {
        scratch.polygon.retain_mut(|corner| {
            let [h1, h2] = self.heights(corner.at);
            corner.distance = h2 - h1;
            (range[0]..=range[1]).contains(&corner.distance)
        });
        &mut scratch.polygon
    }

    /// The heights of both faces at a place in the contact plane.
    fn heights(&self, at: DVec2) -> [f64; 2] {
        self.planes.map(|p| p.base + p.slope.dot(at))
    }

    fn contact<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        vertex: &ClipVertex,
    ) -> ContactPoint {
        let [f1, f2] = [self.planes[0].face, self.planes[1].face];
        let corner_1 = |i: u16| cso.shape_1.face_vertex(f1, i.into());
        let corner_2 = |i: u16| cso.shape_2.face_vertex(f2, i.into());
        let features = match vertex.tag {
            Tag::Corner(i) => [Feature::Face(f1), Feature::Vertex(corner_2(i))],
            Tag::Window(i) => [Feature::Vertex(corner_1(i)), Feature::Face(f2)],
            Tag::Crossing(i, j) => [
                edge_of(cso.shape_1, f1, i.into()),
                edge_of(cso.shape_2, f2, j.into()),
            ],
        };
        let foot = self.origin + self.axes[0] * vertex.at.x + self.axes[1] * vertex.at.y;
        let [h1, h2] = self.heights(vertex.at);
        ContactPoint {
            on_1: foot + self.normal * h1,
            on_2: foot + self.normal * h2,
            distance: vertex.distance,
            features,
        }
    }
}

/// The plane of a face of shape 2, in frame 1: its outward normal, and its height over `origin`. A
/// segment has that of its planes which leans least against the contact normal; a point has none.
fn plane_2<A: Polytope, B: Polytope>(
    cso: &Cso<'_, A, B>,
    face: FaceId,
    normal: DVec3,
    origin: DVec3,
) -> Option<(DVec3, f64)> {
    let shape = cso.shape_2;
    match shape.face_len(face) {
        1 => None,
        2 => {
            let corner = |i| {
                cso.pose
                    .point_to_1(shape.vertex(shape.face_vertex(face, i)))
            };
            let along = (corner(1) - corner(0)).try_normalize()?;
            let outward = (along * along.dot(normal) - normal).try_normalize()?;
            Some((outward, outward.dot(corner(0) - origin)))
        }
        _ => {
            let outward = shape.face_normal(face);
            let height = shape.face_offset(face) - outward.dot(cso.pose.point_to_2(origin));
            Some((cso.pose.direction_to_1(outward), height))
        }
    }
}

/// The face that is in contact: the feature itself, or that next to it which faces the other
/// shape most.
fn facing(shape: &impl Polytope, feature: Feature, outward: DVec3) -> FaceId {
    match feature {
        Feature::Face(face) => face,
        Feature::Vertex(vertex) => shape.face_at(vertex, outward),
        Feature::Edge(edge) => match shape.edge(edge) {
            Some(ends) => shape.face_beside(ends, outward),
            None => shape.face_at(0, outward),
        },
    }
}

/// The `i`-th edge of a face.
fn edge_of(shape: &impl Polytope, face: FaceId, i: usize) -> Feature {
    match shape.face_edge(face, i) {
        Some(edge) => Feature::Edge(edge),
        None => Feature::Vertex(shape.face_vertex(face, i)),
    }
}
