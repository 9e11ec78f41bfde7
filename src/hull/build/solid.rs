//! Building hulls from points and triangles.

use glam::{DVec3, Vec3};

use super::half_edge::HalfEdgeMesh;
use super::validate::{
    MAX_VERTICES, center_and_radius, validate_convex, validate_distinct, validate_finite,
    validate_no_bowl, validate_single_layer, validate_triangles,
};
use super::{morton, quickhull};
use crate::hull::climb::{self, HillClimb};
use crate::hull::faces::Faces;
use crate::hull::graph::EdgeGraph;
use crate::hull::scan::{self, Scan};
use crate::hull::start_table::StartTable;
use crate::hull::{Hull, HullError, SupportSearch};
use crate::stats::Cost;
use crate::support::Polytope;
use crate::tolerance::MIN_EXTENT;

/// The vertices and triangles of the hull of a point cloud.
pub(crate) fn surface_of_points(points: &[Vec3]) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), HullError> {
    if points.len() < 4 {
        return Err(HullError::TooFewPoints);
    }
    validate_finite(points)?;
    quickhull::convex_hull(points)
}

impl Hull {
    /// The convex hull of a point cloud. It is exact: no point is left out.
    ///
    /// Vertex ids are indices into [`points`](Self::points), not into the argument: points inside the hull or
    /// inside its sides are dropped, equal points become one vertex, and the order changes.
    ///
    /// # Errors
    /// [`HullError`] says what is wrong with the points.
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
        let (vertices, triangles) = surface_of_points(points)?;
        Self::from_reordered_triangles(vertices, &triangles)
    }

    /// Like [`from_triangles`](Self::from_triangles), but reorders the vertices for faster climbs.
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
    /// [`HullError`] says what is wrong with the surface.
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
        // Points are converted to f64 once.
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
        validate_no_bowl(climb, &faces, &merged.overtopped)?;
        faces.add_clusters(&exact, &graph, &merged);
        if points.len() > scan::LARGEST {
            graph.mark_plateau_search(|graph, v| {
                at_flat_edge[v.index()] || climb::has_short_edge(&exact, graph, radius, v)
            });
        }
        let hull = Self {
            search: SupportSearch::new(&points, &graph, center, radius),
            points: points.into(),
            graph,
            faces,
            center,
            radius,
        };
        hull.validate_interior()?;
        Ok(hull)
    }

    /// The centre must be clearly inside every face.
    fn validate_interior(&self) -> Result<(), HullError> {
        let deep_inside = self.face_ids().all(|f| {
            self.face_offset(f) - self.face_normal(f).dot(self.center) > MIN_EXTENT * self.radius
        });
        deep_inside.then_some(()).ok_or(HullError::Flat)
    }
}

impl SupportSearch {
    /// The faster search: a scan for a small hull, and climbs for a large one.
    fn new(points: &[Vec3], graph: &EdgeGraph, center: DVec3, radius: f64) -> Self {
        if let Some(scan) = Scan::new(points, center, radius) {
            return Self::Scan(scan);
        }
        let climb = HillClimb {
            points,
            graph,
            center,
            radius,
        };
        Self::Climb(StartTable::new(points.len(), |dir, start| {
            climb::extreme_vertex(climb, dir, start, &mut Cost::default())
        }))
    }
}
