//! Building and validating hulls.

use glam::{DVec3, Vec3};

use super::half_edge::{HalfEdgeMesh, next};
use super::morton;
use super::point_cloud;
use crate::hull::climb::{self, HillClimb};
use crate::hull::faces::{Faces, area_vector, longest_side};
use crate::hull::graph::EdgeGraph;
use crate::hull::scan::{self, Scan};
use crate::hull::start_table::StartTable;
use crate::hull::{Hull, HullError, SupportSearch};
use crate::stats::Cost;
use crate::support::{FaceId, Polytope};
use crate::tolerance::{BOWL, MAX_DENT, MAX_INWARD_HEIGHT, MIN_EXTENT};

/// The most vertices a hull may have: its at most `2 n - 4` faces must have 16-bit ids.
pub(in crate::hull) const MAX_VERTICES: usize = 32_768;

impl Hull {
    /// The convex hull of a point cloud, by parry's hull builder.
    ///
    /// Vertex ids are indices into [`points`](Self::points), not into the argument: points inside
    /// the hull are dropped, equal points are one vertex, and the order is another.
    ///
    /// # Errors
    /// Names what is wrong with the points, see [`HullError`].
    ///
    /// ```
    /// use glam::Vec3;
    /// use isa_gjk::Hull;
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::splat(0.1)];
    /// let hull = Hull::from_points(&corners)?;
    /// assert_eq!(hull.points().len(), 4); // the last point is inside
    /// # Ok::<(), isa_gjk::HullError>(())
    /// ```
    pub fn from_points(points: &[Vec3]) -> Result<Self, HullError> {
        point_cloud::hull_of_points(points, Self::from_reordered_triangles)
    }

    /// As [`from_triangles`](Self::from_triangles), with the vertices in the order in which they are
    /// quickest to climb over.
    pub(in crate::hull) fn from_reordered_triangles(
        points: Vec<Vec3>,
        triangles: &[[u32; 3]],
    ) -> Result<Self, HullError> {
        if points.len() <= scan::LARGEST {
            return Self::from_triangles(points, triangles);
        }
        let (points, triangles) = morton::morton_order(&points, triangles);
        Self::from_triangles(points, &triangles)
    }

    /// From the triangulated surface of a convex polytope, counter-clockwise from outside.
    ///
    /// Vertex ids are indices into `points`.
    ///
    /// # Errors
    /// Names what is wrong with the surface, see [`HullError`].
    pub fn from_triangles(points: Vec<Vec3>, triangles: &[[u32; 3]]) -> Result<Self, HullError> {
        if points.len() < 4 {
            return Err(HullError::TooFewPoints);
        }
        if points.len() > MAX_VERTICES {
            return Err(HullError::TooManyPoints);
        }
        validate_finite(&points)?;
        validate_triangles(&points, triangles)?;
        validate_distinct(&points)?;
        let mesh = HalfEdgeMesh::new(points.len(), triangles)?;
        // All arithmetic is f64: converted once.
        let exact: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        let (center, radius) = center_and_radius(&exact, triangles)?;
        let at_flat_edge = validate_convex(&exact, &mesh, radius)?;
        validate_single_layer(&exact, triangles, center, radius)?;

        let (mut faces, merged) = Faces::new(&exact, &mesh, radius);
        let mut graph = EdgeGraph::new(&mesh, &merged.face_of);
        let climb = HillClimb {
            points: &points,
            graph: &graph,
            center,
            radius,
        };
        validate_no_bowl(climb, &faces)?;
        faces.add_clusters(&exact, &graph, &merged);
        let search = match Scan::new(&points, center, radius) {
            Some(scan) => SupportSearch::Scan(scan),
            None => {
                graph.mark_plateau_search(|graph, v| {
                    at_flat_edge[v as usize] || climb::has_short_edge(&exact, graph, radius, v)
                });
                let climb = HillClimb {
                    points: &points,
                    graph: &graph,
                    center,
                    radius,
                };
                SupportSearch::Climb(StartTable::new(points.len(), |dir, start| {
                    climb::extreme_vertex(climb, dir, start, &mut Cost::default())
                }))
            }
        };
        let hull = Self {
            points: points.into(),
            search,
            graph,
            faces,
            center,
            radius,
        };
        hull.validate_interior()?;
        Ok(hull)
    }

    /// The centre must be clearly inside of every face.
    fn validate_interior(&self) -> Result<(), HullError> {
        let deep_inside = (0..self.faces.len() as FaceId).all(|f| {
            self.face_offset(f) - self.face_normal(f).dot(self.center) > MIN_EXTENT * self.radius
        });
        deep_inside.then_some(()).ok_or(HullError::Flat)
    }
}

impl AsRef<Self> for Hull {
    fn as_ref(&self) -> &Self {
        self
    }
}

pub(in crate::hull) fn validate_finite(points: &[Vec3]) -> Result<(), HullError> {
    match points.iter().position(|p| !p.is_finite()) {
        Some(i) => Err(HullError::NotFinite(i)),
        None => Ok(()),
    }
}

fn validate_triangles(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), HullError> {
    let bad = |&[a, b, c]: &[u32; 3]| {
        a == b || b == c || c == a || [a, b, c].iter().any(|&v| v as usize >= points.len())
    };
    match triangles.iter().position(bad) {
        Some(i) => Err(HullError::BadTriangle(i)),
        None => Ok(()),
    }
}

/// No two points are in the same place: corners of a mesh that were not welded.
fn validate_distinct(points: &[Vec3]) -> Result<(), HullError> {
    // Adding zero turns -0 into 0.
    let bits = |(i, p): (usize, &Vec3)| ((*p + Vec3::ZERO).to_array().map(f32::to_bits), i);
    let mut places: Vec<([u32; 3], usize)> = points.iter().enumerate().map(bits).collect();
    places.sort_unstable();
    let same = places.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    match same.map(|pair| pair[1].1).min() {
        Some(i) => Err(HullError::DuplicateVertex(i)),
        None => Ok(()),
    }
}

/// The centre of volume, and the largest distance of a vertex from it.
fn center_and_radius(points: &[DVec3], triangles: &[[u32; 3]]) -> Result<(DVec3, f64), HullError> {
    let origin = points[0];
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize] - origin);
        let v = a.dot(b.cross(c));
        volume += v;
        moment += (a + b + c) * v;
    }
    let farthest = |from: DVec3| {
        let distances = points.iter().map(|p| (*p - from).length_squared());
        distances.fold(0.0, f64::max).sqrt()
    };
    // Of a flat surface rounding chooses the sign.
    if volume < -MIN_EXTENT * farthest(origin).powi(3) {
        return Err(HullError::InsideOut);
    }
    if volume <= 0.0 {
        return Err(HullError::Flat);
    }
    let center = origin + moment / (4.0 * volume);
    Ok((center, farthest(center)))
}

/// No edge is a dent, beyond rounding. For a closed surface in a single layer, convexity at every
/// edge is convexity. The answer tells which vertices belong to
/// two triangles that are flat up to rounding.
///
/// A dent is as deep as the edge passes beneath the other diagonal of its two triangles. (Heights
/// over the triangles' planes say nothing where these are slivers.)
fn validate_convex(
    points: &[DVec3],
    mesh: &HalfEdgeMesh<'_>,
    radius: f64,
) -> Result<Vec<bool>, HullError> {
    let mut at_flat_edge = vec![false; points.len()];
    let at = |v: u32| points[v as usize];
    for h in 0..3 * mesh.triangles.len() as u32 {
        let twin = mesh.twin(h);
        if h < twin {
            let ends = [mesh.start(h), mesh.end(h)];
            let [third, opposite] = [h, twin].map(|h| mesh.end(next(h)));
            let ([a, b], c, d) = (ends.map(at), at(third), at(opposite));
            let across = (b - a).cross(d - c);
            let rise = (b - a).cross(c - a).dot(d - a);
            let rounding = MAX_DENT * radius * across.length();
            if rise > rounding {
                return Err(HullError::NotConvex(opposite as usize));
            }
            if rise >= -rounding {
                for v in ends.into_iter().chain([third, opposite]) {
                    at_flat_edge[v as usize] = true;
                }
            }
        }
    }
    Ok(at_flat_edge)
}

/// No face has much of the hull before its plane. Each edge of a bowl is a dent within rounding, but
/// many of them add up: the way up from the face leads to the rim.
fn validate_no_bowl(climb: HillClimb<'_>, faces: &Faces) -> Result<(), HullError> {
    for face in 0..faces.len() as FaceId {
        let normal = faces.normal(face);
        let corner = faces.polygon(face)[0].vertex.into();
        let (summit, height) = climb::nearest_summit(climb, normal, corner);
        if height - faces.offset(face) > BOWL * climb.radius {
            return Err(HullError::NotConvex(summit as usize));
        }
    }
    Ok(())
}

/// The surface goes around the centre once: no triangle faces it, except where rounding turns a
/// sliver, and a ray from it leaves but once.
///
/// All edges of a fold may be convex, and all edges of two layers that end in each other. Hull
/// builders working in f32 leave such on needles, whose cross-section they take for rounding; a
/// climb would be trapped there far below the top.
fn validate_single_layer(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    center: DVec3,
    radius: f64,
) -> Result<(), HullError> {
    let mut crossings = 0;
    for &triangle in triangles {
        let normal = area_vector(points, triangle);
        let [a, b, c] = triangle.map(|v| points[v as usize] - center);
        let is_sliver =
            || normal.length() <= MAX_INWARD_HEIGHT * radius * longest_side(points, triangle);
        let is_fold = normal.dot(a) < 0.0 && !is_sliver();
        // The ray passes the sides on the left.
        let passes = |from: DVec3, to: DVec3| from.cross(to).dot(TEST_RAY) > 0.0;
        crossings += u32::from(passes(a, b) && passes(b, c) && passes(c, a));
        if is_fold || crossings > 1 {
            return Err(HullError::NotConvex(triangle[0] as usize));
        }
    }
    Ok(())
}

/// None in which a hull is likely to have an edge.
const TEST_RAY: DVec3 = DVec3::new(0.267_3, -0.534_7, 0.801_7);
