//! The checks of a surface, and its planes.

use std::mem;

use glam::{DVec3, Vec3};

use super::areas::Areas;
use super::around::AroundVertices;

use crate::hull::build::adjacency::{AdjacencyMatrix, TRIANGLES, VERTICES, index, row};
use crate::hull::build::area_vectors::{FourAreaVectors, Volume};
use crate::hull::build::face_plane::{is_flat, polygon_normal};
use crate::hull::build::validate::{center_and_radius, met_by_ray, validate_finite};
use crate::hull::faces::{FaceRecord, Faces};
use crate::hull::lists::Rows;
use crate::hull::scan::Scan;
use crate::hull::{Hull, SupportSearch};
use crate::ids::ShapeId;
use crate::simd::{LANES, f32x4, f64x4};
use crate::tolerance::MIN_EXTENT;

/// Memory to work in. Its lists are longer than any index, so that indices need no checks.
pub(super) struct SteepBuilder {
    pub matrix: AdjacencyMatrix,
    pub points: Box<[DVec3; VERTICES]>,
    pub areas: Areas,
    /// Of the faces, which are the triangles until some of them are merged.
    pub planes: Vec<FaceRecord>,
    /// Of the triangles that were merged.
    triangle_planes: Vec<FaceRecord>,
    pub has_polygons: bool,
    pub around: AroundVertices,
}

impl Default for SteepBuilder {
    fn default() -> Self {
        Self {
            matrix: AdjacencyMatrix::default(),
            points: Box::new([DVec3::ZERO; _]),
            areas: Areas::default(),
            planes: Vec::with_capacity(TRIANGLES),
            triangle_planes: Vec::with_capacity(TRIANGLES),
            has_polygons: false,
            around: AroundVertices::default(),
        }
    }
}

impl SteepBuilder {
    pub fn hull(
        &mut self,
        points: &[Vec3],
        triangles: &[[u32; 3]],
        polygons: &Rows<u32>,
    ) -> Option<Hull> {
        self.matrix.read(points.len(), triangles)?;
        validate_finite(points).ok()?;
        for (exact, point) in self.points.iter_mut().zip(points) {
            *exact = point.as_dvec3();
        }
        let (inside, mut thickness) = self.measure();
        self.has_polygons = polygons.len() > 0;
        if self.has_polygons {
            thickness = thickness.max(self.merge(polygons)?);
        }
        let exact = &self.points[..points.len()];
        let (center, radius) = center_and_radius(exact, &inside).ok()?;
        if !is_flat(thickness, radius) || !self.is_around(exact, center, radius) {
            return None;
        }
        let graph = self.walk_around_all(points.len(), radius)?;
        let corners = self.matrix.corners(polygons);
        self.planes.push(FaceRecord::end(&corners));
        let faces = Faces::from_lists(self.planes.as_slice().into(), corners, radius);
        Some(Hull {
            oriented_box: faces.oriented_box(points, radius),
            search: SupportSearch::Scan(Scan::new(points, center, radius)?),
            points: points.into(),
            graph,
            faces,
            center,
            radius,
            id: ShapeId::new(),
        })
    }

    /// Lists the planes of the triangles, and measures the volume inside and how far corners are from the plane of
    /// their triangle.
    fn measure(&mut self) -> (Volume, f64) {
        self.planes.clear();
        let mut inside = Volume::new(self.points[0]);
        let (mut first, mut thickness) = (0, f64x4::ZERO);
        let points = &self.points;
        for (number, triangles) in self.matrix.triangles().chunks(LANES).enumerate() {
            let four = FourAreaVectors::measure(triangles, |v| points[row(v)], &mut inside);
            let heights = four.highest - four.lowest;
            thickness = heights.fast_max(thickness);
            self.areas.set_four(number, &four);
            let [x, y, z] = four.normals.map(f32x4::to_array);
            let highest = four.highest.to_array();
            // All lanes, since four at once cost less than one by one.
            self.planes.extend([0, 1, 2, 3].map(|lane| {
                let normal = Vec3::new(x[lane], y[lane], z[lane]);
                let plane = FaceRecord {
                    normal,
                    first,
                    offset: highest[lane],
                };
                first += 3;
                plane
            }));
        }
        self.planes.truncate(self.matrix.triangles().len());
        let thickness = thickness.to_array().into_iter().fold(0.0, f64::max);
        (inside, thickness)
    }

    /// Replaces the planes of triangles by those of faces, and returns how far corners are from the plane of their
    /// polygon. `None` if a triangle is turned away from its polygon.
    fn merge(&mut self, polygons: &Rows<u32>) -> Option<f64> {
        mem::swap(&mut self.planes, &mut self.triangle_planes);
        self.planes.clear();
        let (points, planes) = (&*self.points, &mut self.planes);
        let (mut first, mut thickness) = (0, 0.0_f64);
        self.matrix.merge(polygons, |triangle, polygon| {
            let Some(polygon) = polygon else {
                planes.push(FaceRecord {
                    first,
                    ..self.triangle_planes[triangle]
                });
                first += 3;
                return;
            };
            let corners = polygons.row(polygon).iter().map(|&v| points[row(v)]);
            let normal = polygon_normal(corners.clone()).as_vec3();
            let mut plane = FaceRecord {
                normal,
                first,
                offset: f64::NEG_INFINITY,
            };
            let mut lowest = f64::INFINITY;
            for corner in corners {
                let height = normal.as_dvec3().dot(corner);
                plane.offset = plane.offset.max(height);
                lowest = lowest.min(height);
                first += 1;
            }
            thickness = thickness.max(plane.offset - lowest);
            planes.push(plane);
        });
        let faces_outward = |triangle: usize| {
            let face = index(self.matrix.face_of(triangle as u8, true));
            let normal = self.planes[face].normal.as_dvec3();
            self.areas.vector(triangle).dot(normal) > 0.0
        };
        (0..self.matrix.triangles().len())
            .all(faces_outward)
            .then_some(thickness)
    }

    /// Whether the centre is clearly beneath all faces, and a ray from it meets only one triangle. Then the surface
    /// goes around the centre once.
    fn is_around(&self, points: &[DVec3], center: DVec3, radius: f64) -> bool {
        let least = MIN_EXTENT * radius;
        let is_beneath =
            |plane: &FaceRecord| plane.offset - plane.normal.as_dvec3().dot(center) > least;
        self.planes.iter().all(is_beneath)
            && met_by_ray(points, self.matrix.triangles(), center).count() == 1
    }
}
