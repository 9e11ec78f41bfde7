//! The pieces of a cylinder.

use glam::DVec3;

use super::piece::{FlatSide, Generator, Piece, RuledSurface, TangentBall};
use super::round;
use super::surface_pieces::{BorderPlace, CircularEdge, Foot, Ruling, SurfacePieces};
use crate::primitive::Cylinder;
use crate::stats::Cost;
use crate::support::VertexId;
use crate::tuning::SMALL_TURN;

impl Cylinder {
    /// The cap on the side of `dir`, moved outwards by the width of the border.
    fn cap(&self, dir: DVec3, border: f64) -> FlatSide {
        let normal = DVec3::new(0.0, 1_f64.copysign(dir.y), 0.0);
        round::end(normal, self.half_height() + border, self.rim_radius())
    }

    fn tangent_ball(&self) -> TangentBall {
        TangentBall {
            growth: [2.0 * self.half_height(); 2],
            most: self.rim_radius(),
        }
    }
}

impl SurfacePieces for Cylinder {
    fn flat(&self, dir: DVec3, _: VertexId) -> Option<FlatSide> {
        Some(self.cap(dir, 0.0))
    }

    fn flat_towards(&self, dir: DVec3, _: &mut Cost) -> Option<FlatSide> {
        Some(self.cap(dir, 0.0))
    }

    fn inset(&self, _: &FlatSide, p: DVec3) -> f64 {
        round::inset_of_end(p, self.rim_radius())
    }

    fn point_on_side(&self, dir: DVec3, near: DVec3, _: &mut Cost) -> Option<DVec3> {
        let (half_height, radius) = (self.half_height(), self.rim_radius());
        if round::is_along_axis(dir) {
            return round::point_on_end(near, half_height.copysign(dir.y), radius);
        }
        let height = near.y.clamp(-half_height, half_height);
        let is_across = dir.y.abs() < SMALL_TURN;
        is_across.then(|| round::point_on_circle(dir, height, radius))
    }

    fn border_near(&self, dir: DVec3, near: DVec3) -> Option<BorderPlace> {
        if round::is_along_axis(dir) {
            let height = self.half_height().copysign(dir.y);
            return round::rim_near(near, height, self.rim_radius());
        }
        let at = self.point_on_side(dir, near, &mut Cost::default())?;
        Some(BorderPlace {
            at,
            along: DVec3::Y,
        })
    }

    fn ball_at(&self, p: DVec3) -> (DVec3, f64) {
        let share = 0.5 + 0.5 * p.y / self.half_height();
        let radius = self.tangent_ball().radius(share.clamp(0.0, 1.0));
        (p - p.with_y(0.0) * (radius / self.rim_radius()), radius)
    }

    fn foot(&self, p: DVec3, v: DVec3) -> Option<Foot> {
        let (half_height, radius) = (self.half_height(), self.rim_radius());
        let height = p.y.clamp(-half_height, half_height);
        let along = if p.y == height { v.y * v.y } else { 0.0 };
        let across = p.with_y(0.0);
        let from_axis = across.length();
        if from_axis > radius {
            let share = radius / from_axis;
            return Some(Foot {
                at: (across * share).with_y(height),
                following: along + share * round::around_axis(across, v),
            });
        }
        (p.y != height).then(|| Foot {
            at: across.with_y(height),
            following: v.x * v.x + v.z * v.z,
        })
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
        if dir.y.abs() >= dir.with_y(0.0).length() {
            return Piece::Flat(self.cap(dir, border));
        }
        let outward = DVec3::new(dir.x, 0.0, dir.z).normalize_or(DVec3::X);
        let around = radius + border;
        Piece::Line(Generator {
            ends: [-half_height, half_height].map(|height| outward * around + DVec3::Y * height),
            normal: outward,
            surface: RuledSurface {
                origin: DVec3::ZERO,
                axis: DVec3::Y,
                radius: around,
                slope: 0.0,
            },
            ball: self.tangent_ball(),
        })
    }
}
