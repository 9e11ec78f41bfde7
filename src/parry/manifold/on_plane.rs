//! Manifolds of round cylinders and round cones on half-spaces. parry's routine moves all points of the core along the
//! plane's normal. Those beside the deepest are not on the surface then.

use glam::DVec3;
use parry3d::query::Unsupported;

use super::kernel_manifold::{AxisFrame, KernelManifold};
use super::normals::Normals;
use super::update::UpdateManifold;
use crate::curved::{self, SurfacePieces};
use crate::parry::constraints::Constraints;
use crate::parry::convert::HalfSpace;
use crate::parry::pair::{Pair, valid_pose};
use crate::parry::workspace::Workspace;
use crate::query::{Feature, Proximity};
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
        let patch = &mut workspace.curved.patch;
        let near = proximity(normal, patch.find_on_plane(normal, solid, &pose, border));
        let least = near.signed_distance;
        if least > max_distance {
            manifold.forget();
            return Ok(());
        }
        let mut last = None;
        manifold.read_contacts(&pose, &mut last);
        let normals = Normals::of(&near, &pose);
        let before = manifold.normals();
        let is_kept = before.is_some_and(|[_, before]| !solid.rolls(before, normals.exact[1]))
            && (manifold.keep_places(last.as_ref(), least, &normals, radius)).is_some();
        if !is_kept {
            let contacts = curved::contacts(patch, &pose, (near.on_1, least), max_distance, radius);
            manifold.set_contacts(normals.rounded, &contacts);
        }
        Ok(())
    }
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
