//! A surface that has passed all checks but those that need its faces: what a hull is made from.

use glam::{DVec3, Vec3};

use super::area_vectors::AreaVectors;
use super::bends::Bends;
use super::half_edge::HalfEdgeMesh;
use super::validate::{
    MAX_VERTICES, center_and_radius, validate_distinct, validate_finite, validate_no_bowl,
    validate_single_layer, validate_triangles,
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
    measures: Measures,
}

/// What is measured of a surface while it is checked.
struct Measures {
    areas: AreaVectors,
    bends: Bends,
    center: DVec3,
    radius: f64,
    /// Whether it goes around its centre once without any fold. Then it is connected, and has no vertex twice.
    wraps_once: bool,
}

impl Measures {
    fn new(points: &[DVec3], mesh: &HalfEdgeMesh<'_>) -> Result<Self, HullError> {
        let areas = AreaVectors::new(points, mesh.triangles);
        let (center, radius) = center_and_radius(points, &areas.inside)?;
        let bends = Bends::new(points, mesh, &areas, radius)?;
        let wraps_once = validate_single_layer(points, mesh.triangles, &areas, center, radius)?;
        Ok(Self {
            areas,
            bends,
            center,
            radius,
            wraps_once,
        })
    }
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
        let exact: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        let mesh = HalfEdgeMesh::new(points.len(), triangles);
        let measures = match &mesh {
            Ok(mesh) => Measures::new(&exact, mesh),
            Err(error) => Err(*error),
        };
        // What is wrong is named by its cause, which is looked for last.
        if !measures.as_ref().is_ok_and(|measures| measures.wraps_once) {
            validate_distinct(&points)?;
        }
        let mesh = mesh?;
        if !measures.as_ref().is_ok_and(|measures| measures.wraps_once) && !mesh.is_connected() {
            return Err(HullError::NotManifold);
        }
        Ok(Self {
            points,
            exact,
            mesh,
            measures: measures?,
        })
    }

    /// Whether the surface bends at every edge, so that its points have no other triangulation.
    pub fn bends_everywhere(&self) -> bool {
        self.measures.bends.everywhere()
    }

    pub fn into_hull(self) -> Result<Hull, HullError> {
        let (points, exact, mesh) = (self.points, self.exact, self.mesh);
        let Measures {
            areas,
            bends,
            center,
            radius,
            ..
        } = self.measures;
        let (faces, merged) = Faces::new(&exact, &mesh, &areas, &bends, radius);
        let mut graph = EdgeGraph::new(&mesh, &merged.face_of);
        let climb = HillClimb {
            points: &points,
            graph: &graph,
            center,
            radius,
        };
        validate_no_bowl(climb, &faces, &merged.overtopped)?;
        if points.len() > scan::LARGEST {
            graph.mark_plateau_search(|graph, v| {
                bends.is_at_flat_edge(v.index()) || climb::has_short_edge(&exact, graph, radius, v)
            });
        }
        let hull = Hull {
            oriented_box: faces.oriented_box(&points, radius),
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
