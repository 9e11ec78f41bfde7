//! Bodies at rest across the border of a flat side: the place where an outline crosses another one, or a line, proves
//! the answer.

use glam::DVec3;

use super::at_rest::AtRest;
use super::query::CurvedQuery;
use super::separation::NormalSeparation;
use super::surface_pieces::SurfacePieces;
use crate::query::LastContacts;

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// What the deepest crossing proves, along the normal that suits both outlines there.
    pub(super) fn on_crossing(&mut self, last: &LastContacts, about: DVec3) -> Option<AtRest> {
        let (cso, tolerance) = (self.cso, self.tolerance());
        let extreme = cso.support(about, cso.start_vertices(about), self.cost);
        let patch = &mut self.scratch.patch;
        patch.aim(about, &extreme);
        patch.find_cores(cso);
        let crossing = patch.deepest_crossing()?;
        let found = NormalSeparation::along(cso, crossing.normal, &extreme, self.cost);
        let (normal, most) = (found.normal, found.distance + tolerance);
        let [on_1, on_2] = crossing.points;
        patch.aim_along(normal);
        let between = on_2 - on_1;
        let is_proved = if found.distance > 0.0 {
            between.length() <= most
        } else {
            let gap = normal.dot(between);
            let middle = crossing.middle.unwrap_or_else(|| last.middle());
            let disc = patch.disc_around(middle)?;
            let over_origin = disc.over_origin(gap, (between - normal * gap).length());
            over_origin <= most && (most >= 0.0 || disc.proves(cso, normal, over_origin, most))
        };
        is_proved.then_some(AtRest {
            signed_distance: found.distance,
            normal,
            on_1,
        })
    }
}
