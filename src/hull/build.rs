//! Building and validating hulls.

use glam::{DVec3, Vec3};

use super::climb::{self, Slope};
use super::faces::{Faces, triangle_neighbors};
use super::graph::EdgeGraph;
use super::start::StartTable;
use super::{Hull, HullError};
use crate::stats::Cost;
use crate::support::{FaceId, Polytope};
use crate::tolerance::{CONVEXITY, THINNEST};

/// The most vertices a hull may have: its at most `2 n - 4` faces must have 16-bit names.
const MAX_VERTICES: usize = 32_768;

impl Hull {
    /// The convex hull of a point cloud, by parry's hull builder.
    ///
    /// Points inside the hull are dropped, so that vertex ids are not indices into `points`.
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
        let (vertices, triangles) = surface(points)?;
        Self::from_triangles(vertices, &triangles)
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
        require_finite(&points)?;
        require_triangles(&points, triangles)?;
        let mut graph = EdgeGraph::new(points.len(), triangles)?;
        let (center, radius) = center_and_radius(&points, triangles)?;
        require_convex(&points, triangles, radius)?;

        let (mut faces, face_of) = Faces::new(&points, triangles, &graph, radius);
        graph.set_faces(triangles, &face_of);
        faces.add_caps(&points, &graph);
        let face_len = |f: u16| faces.polygon(f.into()).len();
        let fragile = climb::fragile(&points, &graph, radius, face_len);
        let slope = Slope {
            points: &points,
            graph: &graph,
            fragile: &fragile,
            radius,
        };
        let start = StartTable::new(points.len(), |dir, start| {
            climb::support(slope, dir, start, &mut Cost::default()).1
        });
        let hull = Self {
            points: points.into(),
            graph,
            faces,
            start,
            fragile,
            center,
            radius,
        };
        hull.require_interior()?;
        Ok(hull)
    }

    /// The centre must be clearly inside of every face.
    fn require_interior(&self) -> Result<(), HullError> {
        let deep_inside = (0..self.faces.len() as FaceId).all(|f| {
            self.face_offset(f) - self.face_normal(f).dot(self.center) > THINNEST * self.radius
        });
        deep_inside.then_some(()).ok_or(HullError::Flat)
    }
}

/// The vertices and triangles of a point cloud's hull, by parry's hull builder.
pub(crate) fn surface(points: &[Vec3]) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), HullError> {
    if points.len() < 4 {
        return Err(HullError::TooFewPoints);
    }
    require_finite(points)?;
    let (vertices, triangles) =
        parry3d::transformation::try_convex_hull(points).map_err(|_| HullError::BuilderFailed)?;
    // Of points on a line the builder keeps the ends.
    if vertices.len() < 4 {
        return Err(HullError::Flat);
    }
    Ok((vertices, triangles))
}

fn require_finite(points: &[Vec3]) -> Result<(), HullError> {
    match points.iter().position(|p| !p.is_finite()) {
        Some(i) => Err(HullError::NotFinite(i)),
        None => Ok(()),
    }
}

fn require_triangles(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), HullError> {
    let bad = |&[a, b, c]: &[u32; 3]| {
        a == b || b == c || c == a || [a, b, c].iter().any(|&v| v as usize >= points.len())
    };
    match triangles.iter().position(bad) {
        Some(i) => Err(HullError::BadTriangle(i)),
        None => Ok(()),
    }
}

/// The centre of volume, and the largest distance of a vertex from it.
fn center_and_radius(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<(DVec3, f64), HullError> {
    let origin = points[0].as_dvec3();
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize].as_dvec3() - origin);
        let v = a.dot(b.cross(c));
        volume += v;
        moment += (a + b + c) * v;
    }
    let farthest = |from: DVec3| {
        let distances = points
            .iter()
            .map(|p| (p.as_dvec3() - from).length_squared());
        distances.fold(0.0, f64::max).sqrt()
    };
    // Of a flat surface rounding chooses the sign.
    if volume < -THINNEST * farthest(origin).powi(3) {
        return Err(HullError::InsideOut);
    }
    if volume <= 0.0 {
        return Err(HullError::Flat);
    }
    let center = origin + moment / (4.0 * volume);
    Ok((center, farthest(center)))
}

/// No edge is a dent, beyond rounding. For a closed surface, convexity at every edge is convexity.
///
/// A dent is as deep as the edge passes beneath the other diagonal of its two triangles. (Heights
/// over the triangles' planes say nothing where these are slivers.)
fn require_convex(points: &[Vec3], triangles: &[[u32; 3]], radius: f64) -> Result<(), HullError> {
    let at = |v: u32| points[v as usize].as_dvec3();
    for (t, around) in triangle_neighbors(triangles).into_iter().enumerate() {
        for (k, other) in around.into_iter().enumerate() {
            let [a, b, c] = [0, 1, 2].map(|i| triangles[t][(k + i) % 3]);
            let opposite = triangles[other].into_iter().find(|&v| v != a && v != b);
            let Some(d) = opposite else { continue };
            let across = (at(b) - at(a)).cross(at(d) - at(c));
            let rise = (at(b) - at(a)).cross(at(c) - at(a)).dot(at(d) - at(a));
            if rise > CONVEXITY * radius * across.length() {
                return Err(HullError::NotConvex(d as usize));
            }
        }
    }
    Ok(())
}
