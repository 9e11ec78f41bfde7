//! Measures answers about two bodies against the true ones.

use glam::DVec3;
use parry3d::query::{Contact, ContactManifold};

use super::body::Body;
use super::separation::{Difference, SignedDistance};
use crate::pose::ExactPose;

/// Two bodies in a pose, and their true signed distance.
pub struct Judge<'a> {
    bodies: [&'a Body; 2],
    pose: ExactPose,
    difference: Difference<'a>,
    pub exact: SignedDistance,
    /// The smaller diameter.
    pub size: f64,
}

/// How wrong an answer is, in shares of the smaller diameter.
#[derive(Clone, Copy, Debug, Default)]
pub struct Faults {
    /// Of the signed distance.
    pub distance: f64,
    /// How much more separation than the normal another one shows.
    pub regret: f64,
    /// How far points are off their surfaces, or the two of a contact from being apart by its distance along
    /// the normal; the worst contact counts.
    pub gap: f64,
    /// There is no contact although the bodies are within the prediction.
    pub missing: bool,
    /// There are contacts although they are not.
    pub phantom: bool,
    /// Something is not a number.
    pub not_finite: bool,
}

impl Faults {
    /// The worst of both.
    pub fn or(self, other: Self) -> Self {
        Self {
            distance: self.distance.max(other.distance),
            regret: self.regret.max(other.regret),
            gap: self.gap.max(other.gap),
            missing: self.missing || other.missing,
            phantom: self.phantom || other.phantom,
            not_finite: self.not_finite || other.not_finite,
        }
    }

    /// Nothing is wrong by more than `tolerance`.
    pub fn are_within(&self, tolerance: f64) -> bool {
        let worst = self.distance.max(self.regret).max(self.gap);
        worst <= tolerance && !self.missing && !self.phantom && !self.not_finite
    }
}

impl<'a> Judge<'a> {
    pub fn new(bodies: [&'a Body; 2], pose: ExactPose) -> Self {
        let difference = Difference::new(bodies, pose);
        Self {
            bodies,
            pose,
            exact: difference.signed_distance(),
            size: bodies[0].diameter().min(bodies[1].diameter()),
            difference,
        }
    }

    /// A point of body 2 in the frame of body 1.
    pub fn apply(&self, on_2: DVec3) -> DVec3 {
        self.pose.apply(on_2)
    }

    /// How far a signed distance is outside of the true bounds.
    pub fn distance_error(&self, distance: f64) -> f64 {
        (self.exact.lower - distance)
            .max(distance - self.exact.upper)
            .max(0.0)
            / self.size
    }

    /// How much more separation than this normal, in the frame of body 1, another one shows.
    pub fn regret(&self, normal: DVec3) -> f64 {
        let shown = self.difference.separation(normal.normalize());
        let rounding = 1.0e-12 * (self.size + self.pose.translation.length());
        assert!(
            shown.is_nan() || shown <= self.exact.upper + rounding,
            "{normal} separates by {shown:e}, more than {:?}",
            self.exact
        );
        (self.exact.lower - shown).max(0.0) / self.size
    }

    /// Of a contact of points in their own bodies' frames, and its normal in that of body 1.
    pub fn gap_error(&self, points: [DVec3; 2], normal: DVec3, distance: f64) -> f64 {
        let way = self.pose.apply(points[1]) - points[0];
        let normals = [normal, self.pose.rotation.inverse() * -normal];
        let off_surface = (0..2).map(|i| {
            let (body, point) = (self.bodies[i], points[i]);
            // On the far side along the normal, not where the line enters.
            let beyond = point + normals[i] * (1.0e-3 * self.size);
            body.outside(point).abs().max(-body.outside(beyond))
        });
        off_surface.fold(way.distance(normal * distance), f64::max) / self.size
    }

    /// Of a contact without a past.
    pub fn contact(&self, contact: &Contact) -> Faults {
        let normal = contact.normal1.as_dvec3().normalize();
        let points = [contact.point1, contact.point2].map(|p| p.as_dvec3());
        if !contact.dist.is_finite() || !normal.is_finite() || points.iter().any(|p| !p.is_finite())
        {
            return Faults {
                not_finite: true,
                ..Faults::default()
            };
        }
        Faults {
            distance: self.distance_error(contact.dist.into()),
            regret: self.regret(normal),
            gap: self.gap_error(points, normal, contact.dist.into()),
            ..Faults::default()
        }
    }

    /// Of all contacts; `None` says that there is no manifold.
    pub fn manifold<M, C: Copy>(
        &self,
        manifold: Option<&ContactManifold<M, C>>,
        prediction: f64,
    ) -> Faults {
        let slack = 1.0e-5 * self.size;
        let contacts = manifold.map_or(&[][..], |manifold| &manifold.points);
        let Some(manifold) = manifold.filter(|_| !contacts.is_empty()) else {
            let missing = self.exact.upper < prediction - slack;
            return Faults {
                missing,
                ..Faults::default()
            };
        };
        let faults = contacts.iter().map(|point| {
            let contact = Contact {
                dist: point.dist,
                point1: point.local_p1,
                point2: point.local_p2,
                normal1: manifold.local_n1,
                normal2: manifold.local_n2,
                subshape1: 0,
                subshape2: 0,
            };
            self.contact(&contact)
        });
        // Only the deepest tells the distance.
        let nearest = faults
            .clone()
            .map(|faults| faults.distance)
            .fold(f64::INFINITY, f64::min);
        let worst = faults.fold(Faults::default(), Faults::or);
        let deepest = contacts
            .iter()
            .map(|point| f64::from(point.dist))
            .fold(f64::INFINITY, f64::min);
        Faults {
            distance: self.distance_error(deepest).max(nearest),
            phantom: self.exact.lower > prediction + slack,
            ..worst
        }
    }
}
