//! Bodies at rest across the border of a flat side: the place where an outline crosses another one, or a line, near the
//! deepest contact. No outline is walked along.

use glam::DVec3;

use super::at_rest::AtRest;
use super::query::CurvedQuery;
use super::separation::NormalSeparation;
use super::surface_pieces::SurfacePieces;
use crate::query::{Disc, LastContacts};
use crate::stats::Cost;
use crate::support::{Cso, CsoVertex};
use crate::tolerance::KEPT_ANGLE_COS;

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// What the borders at the deepest contact prove, along the normal that suits both of them there. The normals are
    /// outward, each in the frame of its shape.
    pub(super) fn on_border(&mut self, last: &LastContacts, normals: [DVec3; 2]) -> Option<AtRest> {
        let (cso, about) = (self.cso, normals[0]);
        let pose = cso.pose;
        let [near_1, near_2] = last.deepest_points(about);
        let first = cso.shape_1.border_near(about, near_1)?;
        let second = cso
            .shape_2
            .border_near(normals[1], pose.point_to_2(near_2))?;
        let square = first.along.cross(pose.direction_to_1(second.along));
        let normal = square.try_normalize()? * square.dot(about).signum();
        let start = CsoVertex {
            ids: cso.start_vertices(normal),
            ..CsoVertex::default()
        };
        let found = NormalSeparation::along(cso, normal, &start, self.cost);
        let most = found.distance + self.tolerance();
        let between = pose.point_to_1(second.at) - first.at;
        let is_proved = if found.distance > 0.0 {
            between.length() <= most
        } else {
            let gap = normal.dot(between);
            let disc = self.disc_near(last.middle(), normal)?;
            let over_origin = disc.over_origin(gap, (between - normal * gap).length());
            over_origin <= most && disc.proves(cso, normal, over_origin, most)
        };
        is_proved.then_some(AtRest {
            signed_distance: found.distance,
            normal,
            on_1: first.at,
        })
    }

    /// Differences of points of both sides near a place that is over both of them.
    fn disc_near(&mut self, middle: DVec3, normal: DVec3) -> Option<Disc> {
        let Cso {
            shape_1,
            shape_2,
            pose,
        } = self.cso;
        let outward_2 = -pose.direction_to_2(normal);
        let first = SideDisc::near(*shape_1, normal, middle, self.cost)?;
        let second = SideDisc::near(*shape_2, outward_2, pose.point_to_2(middle), self.cost)?;
        let between = pose.point_to_1(second.center) - first.center;
        let height = normal.dot(between);
        let radius = first.radius * first.cosine + second.radius * second.cosine
            - (between - normal * height).length();
        (radius > 0.0).then(|| Disc {
            radius,
            highest: height + first.lift() + second.lift(),
        })
    }
}

/// A disc on a flat side, or a point of a ruled side.
struct SideDisc {
    center: DVec3,
    radius: f64,
    /// Of the angle between its normal and that of the contact.
    cosine: f64,
}

impl SideDisc {
    /// The greatest one around about the point of a side over or under `near`.
    fn near<S: SurfacePieces>(
        shape: &S,
        outward: DVec3,
        near: DVec3,
        cost: &mut Cost,
    ) -> Option<Self> {
        if let Some(flat) = shape.flat_towards(outward, cost)
            && flat.normal.dot(outward) >= KEPT_ANGLE_COS
        {
            let center = flat.foot(near);
            let radius = shape.inset(&flat, center);
            return (radius > 0.0).then(|| Self {
                center,
                radius,
                cosine: flat.normal.dot(outward),
            });
        }
        let center = shape.point_on_side(outward, near, cost)?;
        Some(Self {
            center,
            radius: 0.0,
            cosine: 1.0,
        })
    }

    /// How much its highest point is above its centre, along the contact normal.
    fn lift(&self) -> f64 {
        self.radius * (1.0 - self.cosine * self.cosine).max(0.0).sqrt()
    }
}
