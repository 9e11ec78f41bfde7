//! Manifolds that parry's routine computes, with our hull.

use parry3d::math::Real;
use parry3d::query::details::contact_manifold_pfm_pfm;
use parry3d::shape::PolygonalFeatureMap;

use super::UpdateManifold;
use super::record::{AxisFrame, KernelManifold};
use crate::parry::pair::Pair;
use crate::parry::scaled::Scale;
use crate::support::Support;

impl<M: Default, C: Default + Copy> UpdateManifold<'_, M, C> {
    /// Calls the routine for shapes with features. It searches with extreme vertices of our hull, which are
    /// found by climbing.
    pub(super) fn update_by_parry<B: Support>(
        &mut self,
        pair: &Pair<'_, B>,
        features: &dyn PolygonalFeatureMap,
    ) {
        let scale = Scale::of(pair);
        let shapes = [scale.shape(pair.hull), scale.shape(features)];
        let [shape_1, shape_2] = pair.order.to_caller(shapes);
        let border_radii = pair
            .border_radii
            .map(|border_radius| scale.length(border_radius as Real));
        let [border_radius_1, border_radius_2] = pair.order.to_caller(border_radii);
        let (pos12, prediction) = (scale.pose(self.pos12), scale.length(self.prediction));
        let [c1, c2] = self.constraints;
        let mut manifold = KernelManifold::new(self.manifold, pair, AxisFrame::First);
        manifold.with_parry_axis(self.pos12.rotation, |manifold| {
            c1.with(|c1| {
                c2.with(|c2| {
                    scale.with_manifold(manifold, |manifold| {
                        contact_manifold_pfm_pfm(
                            &pos12,
                            &shape_1,
                            border_radius_1,
                            c1,
                            &shape_2,
                            border_radius_2,
                            c2,
                            prediction,
                            manifold,
                        );
                    });
                });
            });
        });
    }
}
