//! The triangulated surface behind parry's convex polyhedron.
//!
//! parry merges triangles up to 1.5 degrees apart, but it still lists all edges of the triangulation, so the
//! faces usually yield it (`face_loops`). If they miss vertices, only the edges yield it: seen from a point
//! inside, the edges around a vertex have a cyclic order, and successive edges in that order span the
//! triangles.

use std::cmp::Ordering;

use glam::{DVec2, DVec3};
use parry3d::shape::ConvexPolyhedron;

use super::canonical::{around_middle, canonical_hull, hull_of_flat_faces};
use super::face_loops::{FaceTriangles, has_flat_sides, sorted};
use super::flat_sides::FlatFaces;
use super::identity::Diagonals;
use super::validate::MAX_VERTICES;
use crate::at::At;
use crate::hull::lists::Rows;
use crate::hull::{Hull, HullError};
use crate::tolerance::FLAT_EDGE;

/// The hull of a polyhedron. If its surface is not a convex triangulation of all points, this is the hull of
/// the points.
///
/// Vertex ids are indices into [`Hull::points`], whose order differs from the polyhedron's.
impl TryFrom<&ConvexPolyhedron> for Hull {
    type Error = HullError;

    fn try_from(polyhedron: &ConvexPolyhedron) -> Result<Self, HullError> {
        hull_and_diagonals(polyhedron).0
    }
}

/// The hull of a polyhedron, and the edges that it depends on.
pub(crate) fn hull_and_diagonals(
    polyhedron: &ConvexPolyhedron,
) -> (Result<Hull, HullError>, Diagonals) {
    let points = polyhedron.points();
    // All points are vertices, except those inside flat sides: a hull builder would keep too many of these,
    // and take seconds.
    if points.len() > MAX_VERTICES {
        return (Err(HullError::TooManyPoints), Diagonals::default());
    }
    match hull_of_surface(polyhedron) {
        Some((hull, diagonals)) => (Ok(hull), diagonals),
        None => (Hull::from_points(points), Diagonals::all(polyhedron)),
    }
}

/// The same from the surface alone: `None` if that is not a convex triangulation of the points.
pub(crate) fn hull_of_surface(polyhedron: &ConvexPolyhedron) -> Option<(Hull, Diagonals)> {
    let points = polyhedron.points();
    if has_flat_sides(polyhedron)
        && let Some(hull) = of_flat_sides(polyhedron)
    {
        return Some((hull, Diagonals::default()));
    }
    let faces = FaceTriangles::of(polyhedron);
    if let Some(faces) = &faces
        && let Some(hull) = canonical_hull(points, &faces.triangles, faces.seem_flat)
    {
        return Some((hull, Diagonals::default()));
    }
    let surface = Triangulation::of(polyhedron)?;
    if faces.is_none()
        && !surface.flat_edges.is_empty()
        && let Some(hull) = canonical_hull(points, &surface.triangles, true)
    {
        return Some((hull, Diagonals::default()));
    }
    let hull = Hull::from_reordered_triangles(points.to_vec(), &surface.triangles).ok()?;
    Some((
        hull,
        Diagonals::of(polyhedron, surface.flat_edges.into_iter()),
    ))
}

/// The hull, if the faces are its flat sides.
fn of_flat_sides(polyhedron: &ConvexPolyhedron) -> Option<Hull> {
    let points = polyhedron.points();
    if !points.iter().all(|p| p.is_finite()) {
        return None;
    }
    let exact: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let faces = FlatFaces::of(polyhedron, &exact, around_middle(points).1)?;
    hull_of_flat_faces(points, &faces)
}

/// The triangles of a polyhedron, counter-clockwise from outside; `None` if they are ambiguous.
pub(crate) fn triangles(polyhedron: &ConvexPolyhedron) -> Option<Vec<[u32; 3]>> {
    let faces = FaceTriangles::of(polyhedron);
    let sorted = faces.and_then(|faces| sorted(&faces.triangles, polyhedron.points().len()));
    sorted.or_else(|| triangles_of_edges(polyhedron))
}

/// The same by the edges alone.
pub(super) fn triangles_of_edges(polyhedron: &ConvexPolyhedron) -> Option<Vec<[u32; 3]>> {
    Some(Triangulation::of(polyhedron)?.triangles)
}

/// A triangulated surface.
struct Triangulation {
    triangles: Vec<[u32; 3]>,
    /// The edges across which the surface hardly bends.
    flat_edges: Vec<u32>,
}

impl Triangulation {
    fn of(polyhedron: &ConvexPolyhedron) -> Option<Self> {
        let points = polyhedron.points();
        if points.iter().any(|p| !p.is_finite()) {
            return None;
        }
        let (inside, radius) = around_middle(points);
        let flatness = FLAT_EDGE * radius;
        let edges = edges_at_vertices(points.len(), polyhedron)?;
        let mut triangles = Vec::with_capacity(2 * points.len());
        let mut flat_edges = Vec::new();
        let mut incident = Vec::new();
        for (v, edges) in (0..).zip(edges.rows()) {
            incident.clear();
            incident.extend(incident_edges(polyhedron, edges, v, inside)?);
            incident.sort_unstable_by(|a, b| by_angle(a.seen, b.seen));
            for (i, side) in incident.iter().enumerate() {
                let next = &incident[(i + 1) % incident.len()];
                // Each triangle is found at all three corners. Keep it at the lowest.
                if v < side.end && v < next.end {
                    triangles.push([v, side.end, next.end]);
                }
                let last = &incident[(i + incident.len() - 1) % incident.len()];
                if v < side.end && is_flat([last.edge, side.edge, next.edge], flatness) {
                    flat_edges.push(side.id);
                }
            }
        }
        triangles.sort_unstable();
        Some(Self {
            triangles,
            flat_edges,
        })
    }
}

/// An edge as seen from one of its ends.
struct IncidentEdge {
    id: u32,
    /// The other end.
    end: u32,
    edge: DVec3,
    /// From outside.
    seen: DVec2,
}

/// The edges of a vertex, whose ids are `row`, seen from outside. `None` if the vertex is `inside`.
fn incident_edges(
    polyhedron: &ConvexPolyhedron,
    row: &[u32],
    vertex: u32,
    inside: DVec3,
) -> Option<impl Iterator<Item = IncidentEdge>> {
    let at = |vertex: u32| polyhedron.points().at(vertex).as_dvec3();
    let here = at(vertex);
    let outward = (here - inside).try_normalize()?;
    let (x, y) = outward.any_orthonormal_pair();
    // These turn counter-clockwise about `outward`.
    let y = if x.cross(y).dot(outward) > 0.0 { y } else { -y };
    Some(row.iter().map(move |&id| {
        let [a, b] = polyhedron.edges().at(id).vertices;
        let end = a ^ b ^ vertex;
        let edge = at(end) - here;
        IncidentEdge {
            id,
            end,
            edge,
            seen: DVec2::new(edge.dot(x), edge.dot(y)),
        }
    }))
}

/// Whether the surface bends at the second of three successive edges at a vertex by less than a height.
fn is_flat([last, edge, next]: [DVec3; 3], height: f64) -> bool {
    let (before, after) = (last.cross(edge), edge.cross(next));
    let area = before.length_squared().max(after.length_squared()).sqrt();
    before.dot(next).abs() <= height * area
}

/// The edges at each vertex.
fn edges_at_vertices(count: usize, polyhedron: &ConvexPolyhedron) -> Option<Rows<u32>> {
    let edges = (0..).zip(polyhedron.edges());
    Rows::by_key(
        count,
        edges.flat_map(|(id, edge)| edge.vertices.map(|vertex| (vertex, id))),
    )
}

/// Counter-clockwise from the positive x axis.
fn by_angle(a: DVec2, b: DVec2) -> Ordering {
    let lower = |p: DVec2| p.y < 0.0 || (p.y == 0.0 && p.x < 0.0);
    lower(a)
        .cmp(&lower(b))
        .then_with(|| 0.0_f64.total_cmp(&a.perp_dot(b)))
}
