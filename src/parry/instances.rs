//! The functions that the update of a manifold calls for each pair of a hull and a polytope, compiled once.
//!
//! The update is generic over the data that the solver keeps in manifolds, so every program that steps a
//! world compiles it. If it called generic functions, the program would compile these as well, which are most
//! of this crate. Each function here is for one pair of shapes, and is compiled with the crate.

use glam::{DVec3, Vec3};

use crate::hull::Hull;
use crate::manifold::{self, ClipScratch, Contacts};
use crate::parry::constraints::{ConstrainedPair, Corrected};
use crate::primitive::{Ball, CuboidPolytope, Segment, TrianglePolytope};
use crate::query::{Feature, FlushFaces, Found, Full, Proximity, Query, Start, Strategy, Verdict};
use crate::support::{Cso, CsoVertex, Polytope};

/// A polytope that hulls meet. Each function is the generic one of the same name, with a hull as the first
/// shape. (Default bodies would be generic again.)
pub(crate) trait HullPartner: Polytope + Sized {
    fn start_from_features(
        query: &mut Query<'_, '_, Hull, Self>,
        normal: DVec3,
        features: [Feature; 2],
        verdict: &Verdict,
        flush: Option<&FlushFaces>,
    ) -> Found;

    fn start_from_axis(
        query: &mut Query<'_, '_, Hull, Self>,
        axis: DVec3,
        vertex: CsoVertex,
        start: Start,
    ) -> Found;

    fn contacts(
        cso: &Cso<'_, Hull, Self>,
        near: &Proximity,
        max_distance: f64,
        scratch: &mut ClipScratch,
    ) -> Contacts;

    fn contacts_along(
        cso: &Cso<'_, Hull, Self>,
        near: &Proximity,
        normal: DVec3,
        range: [f64; 2],
        scratch: &mut ClipScratch,
    ) -> Option<Contacts>;

    fn correct(pair: &ConstrainedPair<'_, '_, Hull, Self>, normals: [Vec3; 2])
    -> Option<Corrected>;

    fn way_out(
        pair: &ConstrainedPair<'_, '_, Hull, Self>,
        side: usize,
        beyond: f64,
    ) -> Option<Corrected>;

    fn covered_side(
        pair: &ConstrainedPair<'_, '_, Hull, Self>,
        contacts: &Contacts,
        normals: [Vec3; 2],
    ) -> Option<usize>;
}

macro_rules! compile {
    ($($shape:ty),*) => {$(
        impl HullPartner for $shape {
            fn start_from_features(
                query: &mut Query<'_, '_, Hull, Self>,
                normal: DVec3,
                features: [Feature; 2],
                verdict: &Verdict,
                flush: Option<&FlushFaces>,
            ) -> Found {
                Full.start_from_features(query, normal, features, verdict, flush)
            }

            fn start_from_axis(
                query: &mut Query<'_, '_, Hull, Self>,
                axis: DVec3,
                vertex: CsoVertex,
                start: Start,
            ) -> Found {
                Full.start_from_axis(query, axis, vertex, start)
            }

            fn contacts(
                cso: &Cso<'_, Hull, Self>,
                near: &Proximity,
                max_distance: f64,
                scratch: &mut ClipScratch,
            ) -> Contacts {
                manifold::contacts(cso, near, max_distance, scratch)
            }

            fn contacts_along(
                cso: &Cso<'_, Hull, Self>,
                near: &Proximity,
                normal: DVec3,
                range: [f64; 2],
                scratch: &mut ClipScratch,
            ) -> Option<Contacts> {
                manifold::contacts_along(cso, near, normal, range, scratch)
            }

            fn correct(
                pair: &ConstrainedPair<'_, '_, Hull, Self>,
                normals: [Vec3; 2],
            ) -> Option<Corrected> {
                pair.correct(normals)
            }

            fn way_out(
                pair: &ConstrainedPair<'_, '_, Hull, Self>,
                side: usize,
                beyond: f64,
            ) -> Option<Corrected> {
                pair.way_out(side, beyond)
            }

            fn covered_side(
                pair: &ConstrainedPair<'_, '_, Hull, Self>,
                contacts: &Contacts,
                normals: [Vec3; 2],
            ) -> Option<usize> {
                pair.covered_side(contacts, normals)
            }
        }
    )*};
}

compile!(Hull, Ball, Segment, TrianglePolytope, CuboidPolytope);

/// Runs every stage, as [`Full`] does.
#[derive(Clone, Copy)]
pub(crate) struct FullWithHull;

impl<B: HullPartner> Strategy<Hull, B> for FullWithHull {
    #[inline]
    fn certify(
        self,
        query: &mut Query<'_, '_, Hull, B>,
        features: [Feature; 2],
        flush: impl FnMut() -> Option<FlushFaces>,
    ) -> Verdict {
        Full.certify(query, features, flush)
    }

    #[inline]
    fn start_from_features(
        self,
        query: &mut Query<'_, '_, Hull, B>,
        normal: DVec3,
        features: [Feature; 2],
        verdict: &Verdict,
        flush: Option<&FlushFaces>,
    ) -> Found {
        B::start_from_features(query, normal, features, verdict, flush)
    }

    #[inline]
    fn start_from_axis(
        self,
        query: &mut Query<'_, '_, Hull, B>,
        axis: DVec3,
        vertex: CsoVertex,
        start: Start,
    ) -> Found {
        B::start_from_axis(query, axis, vertex, start)
    }
}
