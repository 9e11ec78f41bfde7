//! The contacts of a hull with a half-space.

use super::kernel_manifold::KernelManifold;
use super::normals::Normals;
use super::sink::UpdateContacts;
use crate::hull::Hull;
use crate::manifold::{self, ClipScratch};
use crate::pose::RelativePose;
use crate::query::{LastContacts, Proximity};
use crate::support::Support;

pub(super) struct HalfSpaceContacts<'a> {
    pub hull: &'a Hull,
    pub pose: &'a RelativePose,
    pub max_distance: f64,
    pub scratch: &'a mut ClipScratch,
}

impl UpdateContacts for HalfSpaceContacts<'_> {
    #[inline(always)]
    fn pose(&self) -> Option<&RelativePose> {
        Some(self.pose)
    }

    #[inline(always)]
    fn update_contacts(
        &mut self,
        manifold: &mut KernelManifold<'_, '_>,
        last: Option<&LastContacts>,
        near: &Proximity,
    ) -> bool {
        let (hull, pose) = (self.hull, self.pose);
        let normals = Normals::of(near, pose);
        let is_kept = manifold.keep_contacts(last, near, &normals, hull.radius());
        if !is_kept {
            let contacts =
                manifold::half_space_contacts(hull, pose, near, self.max_distance, self.scratch);
            manifold.set_contacts(normals.rounded, &contacts);
        }
        is_kept
    }
}
