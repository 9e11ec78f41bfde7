//! The contact manifold of two convex shapes, coherently.

use glam::DVec3;
use parry3d::math::{Pose, Real};
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use super::pair::{PairVisitor, Scratch};
use super::{cache, half_space};
use crate::hull::Hull;
use crate::manifold::{self, ContactPoint, Contacts, MAX_POINTS};
use crate::pose::RelativePose;
use crate::query::{Answer, Proximity, Query};
use crate::stats::{Cost, SharedStats, Stage};
use crate::support::{Cso, Polytope};

/// Corrected normals of mesh edges can turn a deep overlap into an absurd depth along a face
/// that the shapes do not meet. As parry does, such points are left out beyond this multiple of
/// the uncorrected depth.
const ABSURD_DEPTH: f64 = 5.0;

/// Brings a manifold up to date.
pub(super) struct UpdateManifold<'a, M, C> {
    pub pos12: &'a Pose,
    pub prediction: Real,
    pub constraints: [Option<&'a dyn NormalConstraints>; 2],
    pub manifold: &'a mut ContactManifold<M, C>,
    pub stats: &'a SharedStats,
}

impl<M, C: Default + Copy> PairVisitor for UpdateManifold<'_, M, C> {
    /// `None` if the pair has no answer here (not finite): it is left to parry.
    type Output = Option<()>;

    #[inline]
    fn visit<B: Polytope>(
        self,
        hull: &Hull,
        other: &B,
        borders: [f64; 2],
        swapped: bool,
        scratch: &mut Scratch<'_>,
    ) -> Option<()> {
        if !RelativePose::is_valid(self.pos12) {
            return None;
        }
        let pose = RelativePose::of_first(self.pos12, swapped);
        let cso = Cso {
            shape_1: hull,
            shape_2: other,
            pose: &pose,
        };
        let max_distance = f64::from(self.prediction) + borders[0] + borders[1];
        let mut cost = Cost::default();
        let (answer, stage) = Query {
            cso: &cso,
            max_distance,
            scratch: scratch.epa,
            cost: &mut cost,
        }
        .run(&cache::read(self.manifold, swapped))?;
        self.stats.record(stage, &cost);
        match answer {
            Answer::Apart(apart) => cache::write_axis(self.manifold, &apart),
            Answer::Near(near) => {
                self.write_contacts(&cso, &near, max_distance, borders, swapped, scratch);
            }
        }
        Some(())
    }

    fn visit_half_space(
        self,
        hull: &Hull,
        normal: DVec3,
        border: f64,
        swapped: bool,
        scratch: &mut Scratch<'_>,
    ) -> Option<()> {
        if !RelativePose::is_valid(self.pos12) {
            return None;
        }
        let pose = RelativePose::of_first(self.pos12, swapped);
        let max_distance = f64::from(self.prediction) + border;
        let mut cost = Cost::default();
        let memory = cache::read(self.manifold, swapped);
        let near = half_space::deepest(hull, normal, &pose, &memory, &mut cost);
        if near.signed_distance > max_distance {
            self.stats.record(Stage::Axis, &cost);
            cache::write_axis(self.manifold, &half_space::axis(&near));
        } else {
            self.stats.record(Stage::Feature, &cost);
            let contacts = manifold::half_space_contacts(hull, &near, max_distance, scratch.clip);
            let [n1, n2] = cache::ordered(normals(&near, &pose), swapped);
            self.manifold.local_n1 = n1.as_vec3();
            self.manifold.local_n2 = n2.as_vec3();
            write_points(self.manifold, &pose, &contacts, [border, 0.0], swapped);
        }
        Some(())
    }
}

/// The contact normal as both shapes see it, outwards.
fn normals(near: &Proximity, pose: &RelativePose) -> [DVec3; 2] {
    [near.normal, -pose.direction_to_2(near.normal)]
}

impl<M, C: Default + Copy> UpdateManifold<'_, M, C> {
    fn write_contacts<B: Polytope>(
        self,
        cso: &Cso<'_, Hull, B>,
        near: &Proximity,
        max_distance: f64,
        borders: [f64; 2],
        swapped: bool,
        scratch: &mut Scratch<'_>,
    ) {
        let [mut n1, mut n2] =
            cache::ordered(normals(near, cso.pose), swapped).map(|n| n.as_vec3());
        let unconstrained = n1;
        let [c1, c2] = self.constraints;
        let constrained = c1.is_some() || c2.is_some();
        if constrained && !(c1, c2).project_local_normals(self.pos12, &mut n1, &mut n2) {
            // Discarded: there is no contact, but there is a place to start from.
            cache::write_start(self.manifold, near, cso);
            return;
        }
        let contacts = if n1 == unconstrained {
            manifold::contacts(cso, near, max_distance, scratch.clip)
        } else {
            let [normal, _] = cache::ordered([n1, n2], swapped);
            let normal = normal.as_dvec3().normalize();
            let limit = ABSURD_DEPTH * near.signed_distance.min(0.0);
            manifold::contacts_along(cso, near, normal, [limit, max_distance], scratch.clip)
        };
        self.manifold.local_n1 = n1;
        self.manifold.local_n2 = n2;
        write_points(self.manifold, cso.pose, &contacts, borders, swapped);
    }
}

/// Replaces the manifold's points, and hands the data (the solver's impulses) of the old ones on.
fn write_points<M, C: Default + Copy>(
    manifold: &mut ContactManifold<M, C>,
    pose: &RelativePose,
    contacts: &Contacts,
    borders: [f64; 2],
    swapped: bool,
) {
    let normals = cache::ordered([manifold.local_n1, manifold.local_n2], swapped);
    let [n1, n2] = normals.map(|n| n.as_dvec3());
    let ids = |contact: &ContactPoint| cache::ordered(contact.features.map(cache::pack), swapped);
    let place = |contact: &ContactPoint| {
        let points = [
            contact.on_1 + n1 * borders[0],
            pose.point_to_2(contact.on_2) + n2 * borders[1],
        ];
        let [local_p1, local_p2] = cache::ordered(points.map(|p| p.as_vec3()), swapped);
        let [fid1, fid2] = ids(contact);
        TrackedContact {
            local_p1,
            local_p2,
            dist: (contact.distance - borders[0] - borders[1]) as Real,
            fid1,
            fid2,
            data: (),
        }
    };
    let contacts = contacts.as_slice();
    let tracked = &mut manifold.points;
    let old = Identities::of(tracked.iter().map(|contact| [contact.fid1, contact.fid2]));
    let new = Identities::of(contacts.iter().map(ids));
    if old == new && tracked.len() == contacts.len() {
        for (tracked, place) in tracked.iter_mut().zip(contacts.iter().map(place)) {
            // Copies of the data would cost more than all the rest.
            tracked.local_p1 = place.local_p1;
            tracked.local_p2 = place.local_p2;
            tracked.dist = place.dist;
            tracked.fid1 = place.fid1;
            tracked.fid2 = place.fid2;
        }
        return;
    }
    let places = contacts.iter().map(place);
    let heirs = heirs(tracked, &old, places.clone(), &new);
    let data = heirs.map(|heir| heir.map_or_else(C::default, |j| tracked[j].data));
    tracked.clear();
    tracked.extend(places.zip(data).map(|(place, data)| TrackedContact {
        local_p1: place.local_p1,
        local_p2: place.local_p2,
        dist: place.dist,
        fid1: place.fid1,
        fid2: place.fid2,
        data,
    }));
}

/// What the first contacts of a manifold are between; see [`cache::identity`].
#[derive(PartialEq)]
struct Identities([u64; MAX_POINTS]);

impl Identities {
    fn of(contacts: impl Iterator<Item = [PackedFeatureId; 2]>) -> Self {
        let mut identities = Self([0; MAX_POINTS]);
        for (identity, ids) in identities.0.iter_mut().zip(contacts) {
            *identity = cache::identity(ids);
        }
        identities
    }
}

/// For each new contact the old one whose data it takes over: that between the same features. What
/// is left over goes to the nearest of the others, however far: an impulse in a wrong place of the
/// patch is a better start for the solver than a body that is borne by three contacts of four.
/// (Of another dispatcher's manifold no more points than ours have hand their data on.)
fn heirs<C>(
    old: &[TrackedContact<C>],
    old_ids: &Identities,
    new: impl Iterator<Item = TrackedContact<()>>,
    new_ids: &Identities,
) -> [Option<usize>; MAX_POINTS] {
    let old = &old[..old.len().min(MAX_POINTS)];
    let mut heirs = [None; MAX_POINTS];
    let mut left = [true; MAX_POINTS];
    for (heir, sought) in heirs.iter_mut().zip(&new_ids.0) {
        for j in 0..old.len() {
            if old_ids.0[j] == *sought {
                *heir = Some(j);
                left[j] = false;
            }
        }
    }
    for (heir, new) in heirs.iter_mut().zip(new).filter(|(heir, _)| heir.is_none()) {
        let away = |j: &usize| old[*j].local_p1.distance_squared(new.local_p1);
        let others = (0..old.len()).filter(|j| left[*j]);
        *heir = others.min_by(|j, k| away(j).total_cmp(&away(k)));
        if let Some(j) = *heir {
            left[j] = false;
        }
    }
    heirs
}
