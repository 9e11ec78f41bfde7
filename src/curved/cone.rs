//! The pieces of a cone.

use glam::DVec3;

use super::piece::{FlatSide, Generator, Piece, RuledSurface, TangentBall};
use super::round;
use super::surface_pieces::{BorderPlace, CircularEdge, Foot, Ruling, SurfacePieces};
use crate::primitive::Cone;
use crate::stats::Cost;
use crate::support::VertexId;
use crate::tuning::SMALL_TURN;

impl Cone {
    /// The base, moved outwards by the width of the border.
    fn base(&self, border: f64) -> FlatSide {
        round::end(DVec3::NEG_Y, self.half_height() + border, self.rim_radius())
    }

    fn tangent_ball(&self) -> TangentBall {
        let [sine, cosine] = self.lean();
        TangentBall {
            growth: [
                2.0 * self.half_height() / (1.0 + sine),
                self.rim_radius() / cosine,
            ],
            most: f64::INFINITY,
        }
    }
}

impl SurfacePieces for Cone {
    fn flat(&self, dir: DVec3, _: VertexId) -> Option<FlatSide> {
        (dir.y < 0.0).then(|| self.base(0.0))
    }

    fn flat_towards(&self, dir: DVec3, _: &mut Cost) -> Option<FlatSide> {
        self.flat(dir, VertexId::default())
    }

    fn inset(&self, _: &FlatSide, p: DVec3) -> f64 {
        round::inset_of_end(p, self.rim_radius())
    }

    fn point_on_side(&self, dir: DVec3, near: DVec3, _: &mut Cost) -> Option<DVec3> {
        let (half_height, radius) = (self.half_height(), self.rim_radius());
        if dir.y < 0.0 && round::is_along_axis(dir) {
            return round::point_on_end(near, -half_height, radius);
        }
        let height = near.y.clamp(-half_height, half_height);
        let around = 0.5 * radius * (1.0 - height / half_height);
        let [sine, _] = self.lean();
        let is_along = (dir.y - sine).abs() < SMALL_TURN;
        is_along.then(|| round::point_on_circle(dir, height, around))
    }

    fn border_near(&self, dir: DVec3, near: DVec3) -> Option<BorderPlace> {
        if dir.y < 0.0 && round::is_along_axis(dir) {
            return round::rim_near(near, -self.half_height(), self.rim_radius());
        }
        let at = self.point_on_side(dir, near, &mut Cost::default())?;
        let along = DVec3::Y * self.half_height() - at;
        (along.y > 0.0).then_some(BorderPlace { at, along })
    }

    fn ball_at(&self, p: DVec3) -> (DVec3, f64) {
        let share = 0.5 + 0.5 * p.y / self.half_height();
        let radius = self.tangent_ball().radius(share.clamp(0.0, 1.0));
        let [sine, cosine] = self.lean();
        let around = p.with_y(0.0).normalize_or_zero();
        (p - (around * cosine + DVec3::Y * sine) * radius, radius)
    }

    fn foot(&self, p: DVec3, v: DVec3) -> Option<Foot> {
        let (half_height, radius) = (self.half_height(), self.rim_radius());
        let across = p.with_y(0.0);
        let from_axis = across.length();
        if p.y < -half_height && from_axis <= radius {
            return Some(Foot {
                at: across.with_y(-half_height),
                following: v.x * v.x + v.z * v.z,
            });
        }
        let [sine, cosine] = self.lean();
        let (outwards, upwards) = (from_axis - radius, p.y + half_height);
        let length = 2.0 * half_height / cosine;
        let up_slant = cosine * upwards - sine * outwards;
        if up_slant >= length {
            return Some(Foot {
                at: DVec3::Y * half_height,
                following: 0.0,
            });
        }
        let on_rim = up_slant <= 0.0;
        if !on_rim && sine * upwards + cosine * outwards <= 0.0 {
            return None;
        }
        let up = up_slant.max(0.0);
        let around = radius - sine * up;
        let turning = around / from_axis * round::around_axis(across, v);
        let rise = cosine * v.y - sine * across.dot(v) / from_axis;
        Some(Foot {
            at: (across * (around / from_axis)).with_y(cosine * up - half_height),
            following: turning + if on_rim { 0.0 } else { rise * rise },
        })
    }

    fn rulings(&self, _: DVec3, _: VertexId) -> impl Iterator<Item = Ruling> {
        let [sine, _] = self.lean();
        std::iter::once(Ruling {
            axis: DVec3::Y,
            sine,
        })
    }

    fn edge(&self, _: DVec3, _: VertexId) -> Option<[DVec3; 2]> {
        None
    }

    fn rim(&self, dir: DVec3) -> Option<CircularEdge> {
        let is_apex = dir.y > self.slope() * dir.with_y(0.0).length();
        (!is_apex).then(|| CircularEdge {
            center: DVec3::NEG_Y * self.half_height(),
            axis: DVec3::Y,
            radius: self.rim_radius(),
        })
    }

    fn piece(&self, dir: DVec3, _: VertexId, border: f64, _: &mut Vec<(DVec3, VertexId)>) -> Piece {
        let (half_height, radius) = (self.half_height(), self.rim_radius());
        let [sine, cosine] = self.lean();
        if -dir.y >= cosine * dir.with_y(0.0).length() + sine * dir.y {
            return Piece::Flat(self.base(border));
        }
        let around = DVec3::new(dir.x, 0.0, dir.z).normalize_or(DVec3::X);
        let normal = around * cosine + DVec3::Y * sine;
        let moved = normal * border;
        let rim = around * radius - DVec3::Y * half_height;
        Piece::Line(Generator {
            ends: [rim + moved, DVec3::Y * half_height + moved],
            normal,
            surface: RuledSurface {
                origin: DVec3::ZERO,
                axis: DVec3::Y,
                radius: 0.5 * radius + border / cosine,
                slope: -self.slope(),
            },
            ball: self.tangent_ball(),
        })
    }
}
