//! The pieces of a cylinder.

use glam::DVec3;

use super::body::{Body, CircularEdge, Ruling};
use super::piece::{FlatSide, Generator, Outline, Piece, RuledSurface, TangentBall};
use crate::primitive::Cylinder;
use crate::support::VertexId;

impl Body for Cylinder {
    fn flat_normal(&self, dir: DVec3, _: VertexId) -> Option<DVec3> {
        Some(DVec3::new(0.0, 1_f64.copysign(dir.y), 0.0))
    }

    fn rulings(&self, _: DVec3, _: VertexId) -> impl Iterator<Item = Ruling> {
        std::iter::once(Ruling {
            axis: DVec3::Y,
            sine: 0.0,
        })
    }

    fn edge(&self, _: DVec3, _: VertexId) -> Option<[DVec3; 2]> {
        None
    }

    fn rim(&self, dir: DVec3) -> Option<CircularEdge> {
        Some(CircularEdge {
            center: DVec3::Y * self.half_height().copysign(dir.y),
            axis: DVec3::Y,
            radius: self.rim_radius(),
        })
    }

    fn piece(&self, dir: DVec3, _: VertexId, border: f64, _: &mut Vec<(DVec3, VertexId)>) -> Piece {
        let (half_height, radius) = (self.half_height(), self.rim_radius());
        if dir.y.abs() >= dir.x.hypot(dir.z) {
            let normal = DVec3::new(0.0, 1_f64.copysign(dir.y), 0.0);
            let offset = half_height + border;
            return Piece::Flat(FlatSide {
                normal,
                offset,
                outline: Outline::Disc {
                    center: normal * offset,
                    radius,
                },
            });
        }
        let outward = DVec3::new(dir.x, 0.0, dir.z).normalize_or(DVec3::X);
        let around = radius + border;
        Piece::Line(Generator {
            ends: [-half_height, half_height].map(|height| outward * around + DVec3::Y * height),
            surface: RuledSurface {
                origin: DVec3::ZERO,
                axis: DVec3::Y,
                radius: around,
                slope: 0.0,
            },
            ball: TangentBall {
                growth: [2.0 * half_height; 2],
                most: radius,
            },
        })
    }
}
