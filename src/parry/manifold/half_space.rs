//! The manifold of a hull and a half-space.

use super::kernel_manifold::KernelManifold;
use super::normals::Normals;
use super::own_contacts::{OwnCheck, are_near, are_on_plane};
use super::packed_feature::unpack;
use super::still::Still;
use crate::hull::Hull;
use crate::manifold::{self, ClipScratch};
use crate::map_pair::map_pair;
use crate::parry::convert::HalfSpace;
use crate::parry::half_space::Plane;
use crate::parry::pair::Pair;
use crate::parry::still_cache::StillCache;
use crate::pose::RelativePose;
use crate::query::{LastContacts, PairMemory, Proximity};
use crate::stats::{Cost, Stage};
use crate::support::{Support, VertexId};

/// The update of a manifold. One support query is all that it takes.
pub(super) struct HalfSpaceUpdate<'a, 'm> {
    pub pair: &'a Pair<'a, HalfSpace>,
    pub pose: &'a RelativePose,
    pub max_distance: f64,
    pub manifold: KernelManifold<'a, 'm>,
    /// The contacts, if they may stay as they are.
    pub still: Option<&'a Still>,
    /// The contacts, once they are read.
    pub last: &'a mut Option<LastContacts>,
}

impl HalfSpaceUpdate<'_, '_> {
    /// Returns the stage that found the answer.
    // perf: in a call all of this would go through memory.
    #[inline(always)]
    pub fn run(
        &mut self,
        scratch: &mut ClipScratch,
        cache: &mut StillCache,
        cost: &mut Cost,
    ) -> Stage {
        let (hull, pose) = (self.pair.hull, self.pose);
        let plane = Plane::new(self.pair.other, pose);
        let has_contacts = !self.manifold.manifold.is_empty();
        // Every hull of a world is in a pair with its ground, and most of these pairs end here.
        if plane.is_sphere_apart(hull, self.max_distance) {
            self.manifold.forget();
            return Stage::BoundingSpheres;
        }
        if has_contacts && self.last.is_none() {
            self.manifold.read_contacts(pose, self.last);
        }
        let start = self.start_vertex(&plane);
        let near = plane.deepest(hull, start, cost);
        if near.signed_distance > self.max_distance {
            let vertices = [near.features[0].vertex(hull), VertexId::default()];
            self.manifold.set_axis(plane.normal, vertices, pose);
            return Stage::Axis;
        }
        if self.is_held(near.signed_distance, cache) || self.update_contacts(&near, scratch, cache)
        {
            return Stage::Kept;
        }
        let shapes = [hull.id(), Some(self.pair.other.id())];
        self.manifold.note_chosen(shapes, cache);
        Stage::Feature
    }

    /// Leaves the contacts as they are, if that is right at this signed distance of the cores. Returns whether it is.
    #[inline]
    fn is_held(&mut self, core_distance: f64, cache: &mut StillCache) -> bool {
        let borders: f64 = self.pair.border_radii.iter().sum();
        let still = self
            .still
            .filter(|still| still.shows(core_distance - borders));
        let (Some(still), Some(last)) = (still, &*self.last) else {
            return false;
        };
        let is_own = still.is_of_half_space(self.pair, self.pose, &self.manifold, last);
        if is_own {
            self.manifold.manifold.hold(still);
            still.store(cache, core_distance);
        } else {
            *self.last = None;
        }
        is_own
    }

    /// Where the search for the deepest vertex begins. If several tie, this one is the answer.
    #[inline(always)]
    fn start_vertex(&self, plane: &Plane) -> VertexId {
        let hull = self.pair.hull;
        if let Some(last) = &*self.last
            && let points = self.manifold.manifold.points()
            && let Some(ids) = points.features(last.deepest(plane.normal))
        {
            let [feature, _] = self.manifold.order.to_kernel(ids);
            let feature = unpack(feature);
            return feature.map_or_else(VertexId::default, |feature| feature.vertex(hull));
        }
        match self.manifold.memory(None) {
            PairMemory::None => hull.start_vertex(plane.normal),
            PairMemory::Axis(_, [vertex, _]) => hull.clamp_vertex(vertex),
            PairMemory::Contact(_, [feature, _]) => feature.vertex(hull),
        }
    }

    /// Writes the contacts, or leaves the `last` ones where they are. Returns whether it left them.
    #[inline(always)]
    fn update_contacts(
        &mut self,
        near: &Proximity,
        scratch: &mut ClipScratch,
        cache: &mut StillCache,
    ) -> bool {
        let hull: &Hull = self.pair.hull;
        // The plane's own normal is the one that points out of the half-space.
        let exact = [near.normal, self.pair.other.normal];
        let normals = Normals {
            exact,
            rounded: map_pair(exact, |normal| normal.as_vec3()),
        };
        let (pair, pose) = (self.pair, self.pose);
        let key = self.manifold.manifold.key();
        let are_own = |last: &LastContacts, normals| {
            let shapes = [hull.id(), Some(pair.other.id())];
            OwnCheck { cache, key }.passes_if(shapes, last, normals, || {
                let ([on_1, on_2], radius) = (last.points(pose), hull.radius());
                are_near(hull, &on_1, pair.border_radii[0], radius)
                    && are_on_plane(pair.other, &on_2, radius)
            })
        };
        let last = self.last.as_ref();
        let is_kept = (self.manifold).keep_contacts(last, near, &normals, hull.radius(), are_own);
        if !is_kept {
            let mut contacts =
                manifold::half_space_contacts(hull, self.pose, near, self.max_distance, scratch);
            let (border, least) = (self.pair.border_radii[0], near.signed_distance);
            if border != 0.0 && contacts.len > 1 {
                contacts.fit_to_border(hull, near.normal, border, least);
            }
            self.manifold.set_contacts(normals.rounded, &contacts);
        }
        is_kept
    }
}
