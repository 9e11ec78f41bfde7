//! Pieces of a surface: flat sides, lines of ruled surfaces, and points.

use glam::DVec3;

use crate::pose::RelativePose;
use crate::primitive::nearest_share;
use crate::support::{FaceId, VertexId};
use crate::tolerance::{ON_OUTLINE, SAME_NORMAL};

/// A piece of the surface of a shape, moved outwards by the width of its border.
#[derive(Clone, Copy, Debug)]
pub enum Piece {
    /// A flat side.
    Flat(FlatSide),
    /// A line of a ruled surface, or an edge with a border.
    Line(Generator),
    /// A point, moved along the contact normal.
    Point(DVec3),
}

/// A flat side of a shape.
#[derive(Clone, Copy, Debug)]
pub struct FlatSide {
    /// Its outward unit normal.
    pub normal: DVec3,
    /// `normal · p` of its points.
    pub offset: f64,
    /// The boundary of the side.
    pub outline: Outline,
}

impl FlatSide {
    /// The point of its plane that is nearest to a point.
    #[inline]
    pub fn foot(&self, p: DVec3) -> DVec3 {
        p - self.normal * (self.normal.dot(p) - self.offset)
    }
}

/// The outline of a flat side.
#[derive(Clone, Copy, Debug)]
pub enum Outline {
    /// A circle.
    Disc {
        /// Its centre.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A face. Its corners are stored beside the piece.
    Polygon(FaceId),
}

impl Outline {
    /// The centre and the radius, if it is a circle.
    pub(super) fn circle(&self) -> Option<(DVec3, f64)> {
        match *self {
            Self::Disc { center, radius } => Some((center, radius)),
            Self::Polygon(_) => None,
        }
    }
}

/// The line of a ruled surface that is extreme along the contact normal.
#[derive(Clone, Copy, Debug)]
pub struct Generator {
    /// Its ends.
    pub ends: [DVec3; 2],
    /// The outward unit normal along it.
    pub normal: DVec3,
    /// The surface that it is on.
    pub surface: RuledSurface,
    /// The balls inside the core that touch it along this line.
    pub ball: TangentBall,
}

/// The radius of the largest ball inside a core that touches a line of its surface, as a function of the
/// place along that line.
#[derive(Clone, Copy, Debug, Default)]
pub struct TangentBall {
    /// How much the radius grows over the whole line, from zero at either end.
    pub growth: [f64; 2],
    /// An upper bound of the radius.
    pub most: f64,
}

impl TangentBall {
    /// The radius at a fraction `share` of the way from the first end to the second.
    pub fn radius(&self, share: f64) -> f64 {
        let [from_first, from_second] = self.growth;
        (from_first * share)
            .min(from_second * (1.0 - share))
            .min(self.most)
    }
}

/// The side of a cylinder or a cone, without its ends.
#[derive(Clone, Copy, Debug)]
pub struct RuledSurface {
    /// A point of the axis.
    pub origin: DVec3,
    /// The unit vector along the axis.
    pub axis: DVec3,
    /// The radius at the origin.
    pub radius: f64,
    /// The growth of the radius per unit length along the axis.
    pub slope: f64,
}

/// The part of the unit vector `dir` perpendicular to `axis`, normalised. `None` if they are parallel up to
/// rounding.
pub(super) fn across(dir: DVec3, axis: DVec3) -> Option<DVec3> {
    let part = dir.reject_from_normalized(axis);
    let length = part.length();
    (length > SAME_NORMAL).then(|| part / length)
}

impl Piece {
    /// An edge with a border: the line on its side that is extreme along `dir`. `None` for a point.
    pub fn of_edge([a, b]: [DVec3; 2], dir: DVec3, border: f64) -> Option<Self> {
        let axis = (b - a).try_normalize()?;
        let outward = across(dir.normalize(), axis)?;
        Some(Self::Line(Generator {
            ends: [a, b].map(|end| end + outward * border),
            normal: outward,
            surface: RuledSurface {
                origin: a,
                axis,
                radius: border,
                slope: 0.0,
            },
            ball: TangentBall::default(),
        }))
    }

    /// From frame 2 to frame 1, and so its corners, if it is a polygon.
    pub fn to_frame_1(self, pose: &RelativePose, corners: &mut [(DVec3, VertexId)]) -> Self {
        for (corner, _) in corners {
            *corner = pose.point_to_1(*corner);
        }
        match self {
            Self::Flat(flat) => {
                let normal = pose.direction_to_1(flat.normal);
                let outline = match flat.outline {
                    Outline::Disc { center, radius } => Outline::Disc {
                        center: pose.point_to_1(center),
                        radius,
                    },
                    polygon @ Outline::Polygon(_) => polygon,
                };
                Self::Flat(FlatSide {
                    normal,
                    offset: flat.offset + normal.dot(pose.point_to_1(DVec3::ZERO)),
                    outline,
                })
            }
            Self::Line(line) => Self::Line(Generator {
                ends: line.ends.map(|p| pose.point_to_1(p)),
                normal: pose.direction_to_1(line.normal),
                surface: RuledSurface {
                    origin: pose.point_to_1(line.surface.origin),
                    axis: pose.direction_to_1(line.surface.axis),
                    ..line.surface
                },
                ..line
            }),
            Self::Point(p) => Self::Point(pose.point_to_1(p)),
        }
    }
}

impl Generator {
    /// The distance along `outward` at which the line through `p` leaves the surface, near this generator.
    pub fn exit(&self, p: DVec3, outward: DVec3) -> Option<f64> {
        let [a, b] = self.ends;
        let about = self.normal.dot(a - p) / self.normal.dot(outward);
        let at = p + outward * about;
        // On the line itself rounding may hide the root.
        let along = b - a;
        let nearest = a + along * nearest_share(self.ends, at);
        if at.distance_squared(nearest) <= ON_OUTLINE * ON_OUTLINE * along.length_squared() {
            return Some(about);
        }
        self.surface.exit(p, outward, about)
    }
}

impl RuledSurface {
    /// The sine of the angle between the outward normals and the plane across the axis.
    pub fn sine(&self) -> f64 {
        -self.slope / (1.0 + self.slope * self.slope).sqrt()
    }

    /// The radius at the height of `p`.
    pub fn radius_at(&self, p: DVec3) -> f64 {
        self.radius + self.slope * self.axis.dot(p - self.origin)
    }

    /// The outward normal at a point.
    pub fn normal_at(&self, p: DVec3) -> DVec3 {
        let across = (p - self.origin).reject_from_normalized(self.axis);
        let around = across.normalize_or_zero();
        (around - self.axis * self.slope).normalize_or_zero()
    }

    /// The distance along the unit vector `dir` at which the line through `p` leaves the surface. Of two such
    /// distances, the one nearer to `about`.
    pub fn exit(&self, p: DVec3, dir: DVec3, about: f64) -> Option<f64> {
        let from = p - self.origin;
        let (height, rise) = (self.axis.dot(from), self.axis.dot(dir));
        let (across, step) = (from - self.axis * height, dir - self.axis * rise);
        let (radius, growth) = (self.radius + self.slope * height, self.slope * rise);
        let a = step.length_squared() - growth * growth;
        let b = step.dot(across) - radius * growth;
        let c = across.length_squared() - radius * radius;
        let discriminant = b * b - a * c;
        if discriminant < 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        // Without cancellation (Press et al., Numerical Recipes, 5.6).
        let q = -(b + root.copysign(b));
        let nearer = |t: f64, u: f64| {
            if (t - about).abs() <= (u - about).abs() {
                t
            } else {
                u
            }
        };
        let found = match (a != 0.0, q != 0.0) {
            (true, true) => nearer(q / a, c / q),
            (true, false) => 0.0,
            (false, true) => c / q,
            (false, false) => return None,
        };
        found.is_finite().then_some(found)
    }
}
