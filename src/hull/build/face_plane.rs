//! The supporting plane of a face.

use std::mem;

use glam::{DVec3, Vec3};

use super::area_vectors::AreaVector;
use super::bends::Bends;
use super::half_edge::{HalfEdge, HalfEdgeMesh};
use crate::at::At;
use crate::tolerance::FACE_FLATNESS;

/// A supporting plane.
pub(super) struct FacePlane {
    pub normal: Vec3,
    pub offset: f64,
    /// Whether a neighbour is higher than a corner.
    pub is_overtopped: bool,
}

impl FacePlane {
    /// The plane of a sliver, whose direction is mere rounding: it is no plane of the hull, and farther out
    /// than any. Outlines have no plane either.
    pub const NONE: Self = Self {
        normal: Vec3::ZERO,
        offset: f64::INFINITY,
        is_overtopped: false,
    };

    /// Whether it is a plane.
    #[inline]
    pub fn is_some(&self) -> bool {
        self.offset < f64::INFINITY
    }

    /// The plane of a triangle through its outermost corner: that of a face whose corners are steep.
    #[inline]
    pub fn of_triangle(triangle: &AreaVector, radius: f64) -> Self {
        let plane = Self {
            normal: triangle.normal,
            offset: triangle.highest,
            is_overtopped: false,
        };
        plane.or_none(triangle.lowest, radius)
    }

    /// No plane if a corner is too far from it.
    #[inline]
    fn or_none(self, lowest: f64, radius: f64) -> Self {
        if is_flat(self.offset - lowest, radius) {
            self
        } else {
            Self::NONE
        }
    }

    /// The plane goes through the outermost of the polygon's corners and their neighbours: on a convex hull
    /// no vertex is farther out. Around a steep corner, no neighbour is.
    pub fn new(
        points: &[DVec3],
        mesh: &HalfEdgeMesh<'_>,
        polygon: &[HalfEdge],
        bends: &Bends,
        radius: f64,
    ) -> Self {
        let normal = normal_of(points, mesh, polygon).as_vec3();
        let direction = normal.as_dvec3();
        let height = |v: u32| direction.dot(points.at(v));
        // No value is NaN here, so the NaN check of `f64::max` is not needed.
        let higher = |a: f64, b: f64| if a > b { a } else { b };
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut around = f64::NEG_INFINITY;
        let mut before = mesh.start(polygon[polygon.len() - 1]);
        for &side in polygon {
            let [corner, after] = [mesh.start(side), mesh.end(side)];
            let level = height(corner);
            lowest = -higher(-lowest, -level);
            highest = higher(highest, level);
            if !bends.is_steep(corner) {
                for to in mesh.outgoing(corner).iter().map(|side| u32::from(side.to)) {
                    if to != before && to != after {
                        around = higher(around, height(to));
                    }
                }
            }
            before = corner;
        }
        let plane = Self {
            normal,
            offset: higher(highest, around),
            is_overtopped: around > lowest,
        };
        plane.or_none(lowest, radius)
    }
}

/// Whether a face of this thickness has a plane.
#[inline]
pub(super) fn is_flat(thickness: f64, radius: f64) -> bool {
    thickness <= 2.0 * FACE_FLATNESS * radius
}

/// The normal of a polygon of a mesh.
pub(super) fn normal_of(points: &[DVec3], mesh: &HalfEdgeMesh<'_>, polygon: &[HalfEdge]) -> DVec3 {
    polygon_normal(polygon.iter().map(|&side| points.at(mesh.start(side))))
}

/// The area vector of a polygon, normalised (Newell's method, about its first vertex).
pub(super) fn polygon_normal(mut corners: impl Iterator<Item = DVec3>) -> DVec3 {
    let origin = corners.next().unwrap_or_default();
    let mut from_origin = corners.map(|corner| corner - origin);
    let mut before = from_origin.next().unwrap_or_default();
    let crosses = from_origin.map(|corner| mem::replace(&mut before, corner).cross(corner));
    let sum = crosses.reduce(|a, b| a + b).unwrap_or_default();
    sum.normalize_or(DVec3::Z)
}
