//! A surface that passed all checks but those that need its faces, on its way to a hull.

use glam::{DVec3, Vec3};

use super::flat_edges::AreaVectors;
use super::half_edge::HalfEdgeMesh;
use super::validate::{
    Bends, MAX_VERTICES, center_and_radius, validate_convex, validate_distinct, validate_finite,
    validate_no_bowl, validate_single_layer, validate_triangles,
};
use crate::hull::climb::{self, HillClimb};
use crate::hull::faces::Faces;
use crate::hull::graph::EdgeGraph;
use crate::hull::scan::{self, Scan};
use crate::hull::start_table::StartTable;
use crate::hull::{Hull, HullError, SupportSearch};
use crate::ids::ShapeId;
use crate::stats::Cost;
use crate::support::Polytope;
use crate::tolerance::MIN_EXTENT;

/// A closed, convex surface.
pub(super) struct Surface<'a> {
    points: Vec<Vec3>,
    /// The points in f64: they are converted once.
    exact: Vec<DVec3>,
    mesh: HalfEdgeMesh<'a>,
    areas: AreaVectors,
    bends: Bends,
    center: DVec3,
    radius: f64,
}

impl<'a> Surface<'a> {
    pub fn new(points: Vec<Vec3>, triangles: &'a [[u32; 3]]) -> Result<Self, HullError> {
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
        let exact: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        let (center, radius) = center_and_radius(&exact, triangles)?;
        let areas = AreaVectors::new(&exact, triangles, radius);
        let bends = validate_convex(&exact, &mesh, &areas, radius)?;
        validate_single_layer(&exact, triangles, &areas, center, radius)?;
        Ok(Self {
            points,
            exact,
            mesh,
            areas,
            bends,
            center,
            radius,
        })
    }

    /// Whether the surface bends at every edge, so that its points have no other triangulation.
    pub fn bends_everywhere(&self) -> bool {
        self.bends.everywhere
    }

    pub fn into_hull(self) -> Result<Hull, HullError> {
        let (points, mesh, bends) = (self.points, self.mesh, self.bends);
        let (exact, center, radius) = (self.exact, self.center, self.radius);
        let (mut faces, merged) = Faces::new(&exact, &mesh, &self.areas, &bends.is_steep, radius);
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
                bends.at_flat_edge[v.index()] || climb::has_short_edge(&exact, graph, radius, v)
            });
        }
        let hull = Hull {
            search: SupportSearch::new(&points, &graph, center, radius),
            points: points.into(),
            graph,
            faces,
            center,
            radius,
            id: ShapeId::new(),
        };
        hull.validate_interior()?;
        Ok(hull)
    }
}

impl Hull {
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
