//! Manifolds of round cylinders and round cones on half-spaces. parry's routine moves all points of the core along the
//! plane's normal. Those beside the deepest are not on the surface then.

use glam::DVec3;
use parry3d::query::Unsupported;

use super::axis_frame::AxisFrame;
use super::kernel_manifold::KernelManifold;
use super::normals::Normals;
use super::own_contacts::{OwnCheck, are_near, are_on_plane};
use super::update::UpdateManifold;
use crate::curved::{self, SurfacePieces};
use crate::parry::constraints::Constraints;
use crate::parry::convert::HalfSpace;
use crate::parry::pair::{Pair, valid_pose};
use crate::parry::still_cache::StillCache;
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::{Feature, LastContacts, Proximity};
use crate::support::FaceId;

impl UpdateManifold<'_> {
    /// For a half-space, which comes first, and a shape with a rounded border.
    pub fn update_on_plane(
        &mut self,
        pair: &Pair<'_, impl SurfacePieces, HalfSpace>,
        workspace: &mut Workspace,
    ) -> Result<(), Unsupported> {
        if !Constraints::are_none(self.constraints) {
            return Err(Unsupported);
        }
        let pose = pair.pose(valid_pose(self.pos12)?);
        let (normal, solid, border) = (pair.hull.normal, pair.other, pair.border_radii[1]);
        let radius = solid.radius();
        let max_distance = f64::from(self.prediction) + pair.touching(radius);
        let mut manifold =
            KernelManifold::with_borders(&mut self.manifold, pair.order, AxisFrame::First);
        let height = normal.dot(pose.point_to_1(solid.center()));
        if height - radius - border > max_distance {
            manifold.forget();
            return Ok(());
        }
        let (patch, still_cache) = (&mut workspace.curved.patch, &mut workspace.still_cache);
        let near = proximity(normal, patch.find_on_plane(normal, solid, &pose, border));
        let least = near.signed_distance;
        if least > max_distance {
            manifold.forget();
            return Ok(());
        }
        let normals = Normals::of(&near, &pose);
        if !keep((pair, &pose), least, &mut manifold, &normals, still_cache) {
            let contacts = curved::contacts(patch, &pose, (near.on_1, least), max_distance, radius);
            manifold.set_contacts(normals.rounded, &contacts);
            let shapes = [Some(pair.hull.id()), solid.id()];
            manifold.note_chosen(shapes, still_cache);
        }
        Ok(())
    }
}

/// Keeps the contacts of a solid on a half-space where they are, if they are still in place at this signed distance.
fn keep<S: SurfacePieces>(
    (pair, pose): (&Pair<'_, S, HalfSpace>, &RelativePose),
    least: f64,
    manifold: &mut KernelManifold<'_, '_>,
    normals: &Normals,
    cache: &mut StillCache,
) -> bool {
    let (plane, solid, border) = (pair.hull, pair.other, pair.border_radii[1]);
    let (radius, key) = (solid.radius(), manifold.manifold.key());
    let mut last = None;
    manifold.read_contacts(pose, &mut last);
    let are_own = |last: &LastContacts, normals| {
        let shapes = [Some(plane.id()), solid.id()];
        OwnCheck { cache, key }.passes_if(shapes, last, normals, || {
            let [on_1, on_2] = last.points(pose);
            are_on_plane(plane, &on_1, radius) && are_near(solid, &on_2, border, radius)
        })
    };
    let before = manifold.normals();
    before.is_some_and(|[_, before]| !solid.rolls(before, normals.exact[1]))
        && (manifold.keep_places(last.as_ref(), least, normals, radius, are_own)).is_some()
}

/// Of the deepest point of the second shape, in frame 1, over the plane through the origin.
fn proximity(normal: DVec3, on_2: DVec3) -> Proximity {
    let signed_distance = normal.dot(on_2);
    Proximity {
        signed_distance,
        normal,
        on_1: on_2 - normal * signed_distance,
        on_2,
        features: [Feature::Face(FaceId::default()); 2],
    }
}
