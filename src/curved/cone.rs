//! The pieces of a cone.

use glam::DVec3;

use super::body::{Body, CircularEdge, Ruling};
use super::piece::{FlatSide, Generator, Outline, Piece, RuledSurface, TangentBall};
use crate::primitive::Cone;
use crate::support::VertexId;

/// The sine and the cosine of the angle between the side's normals and the base.
fn lean(cone: &Cone) -> [f64; 2] {
    let slope = cone.slope();
    let length = slope.hypot(1.0);
    [slope / length, 1.0 / length]
}

impl Body for Cone {
    fn flat_normal(&self, dir: DVec3, _: VertexId) -> Option<DVec3> {
        (dir.y < 0.0).then_some(DVec3::NEG_Y)
    }

    fn rulings(&self, _: DVec3, _: VertexId) -> impl Iterator<Item = Ruling> {
        let [sine, _] = lean(self);
        std::iter::once(Ruling {
            axis: DVec3::Y,
            sine,
        })
    }

    fn edge(&self, _: DVec3, _: VertexId) -> Option<[DVec3; 2]> {
        None
    }

    fn rim(&self, dir: DVec3) -> Option<CircularEdge> {
        let is_apex = dir.y > self.slope() * dir.x.hypot(dir.z);
        (!is_apex).then(|| CircularEdge {
            center: DVec3::NEG_Y * self.half_height(),
            axis: DVec3::Y,
            radius: self.rim_radius(),
        })
    }

    fn piece(&self, dir: DVec3, _: VertexId, border: f64, _: &mut Vec<(DVec3, VertexId)>) -> Piece {
        let (half_height, radius) = (self.half_height(), self.rim_radius());
        let [sine, cosine] = lean(self);
        if -dir.y >= cosine * dir.x.hypot(dir.z) + sine * dir.y {
            let offset = half_height + border;
            return Piece::Flat(FlatSide {
                normal: DVec3::NEG_Y,
                offset,
                outline: Outline::Disc {
                    center: DVec3::NEG_Y * offset,
                    radius,
                },
            });
        }
        let around = DVec3::new(dir.x, 0.0, dir.z).normalize_or(DVec3::X);
        let moved = (around * cosine + DVec3::Y * sine) * border;
        let rim = around * radius - DVec3::Y * half_height;
        Piece::Line(Generator {
            ends: [rim + moved, DVec3::Y * half_height + moved],
            surface: RuledSurface {
                origin: DVec3::ZERO,
                axis: DVec3::Y,
                radius: 0.5 * radius + border / cosine,
                slope: -self.slope(),
            },
            ball: TangentBall {
                growth: [2.0 * half_height / (1.0 + sine), radius / cosine],
                most: f64::INFINITY,
            },
        })
    }
}
