//! The order of the stages, from a remembered normal to a proved answer.

use std::ops::ControlFlow;

use glam::DVec3;

use super::patch::Patch;
use super::separation::NormalSeparation;
use super::surface_pieces::SurfacePieces;
use crate::epa::EpaScratch;
use crate::gjk::SeparatingAxis;
use crate::query::{LastContacts, Start};
use crate::stats::{Cost, Stage};
use crate::support::{Cso, CsoVertex, VertexId};
use crate::tuning::TILT;

/// Memory that queries work in.
#[derive(Clone, Debug, Default)]
pub struct CurvedScratch {
    /// The contact patch of the last answer.
    pub patch: Patch,
    /// The expanding polytope.
    pub epa: EpaScratch,
    /// Points of the difference at which EPA starts.
    pub(super) seeds: Vec<CsoVertex>,
}

/// What the previous frame tells about a pair.
#[derive(Clone, Copy, Debug)]
pub enum Hint {
    /// Nothing.
    None,
    /// The shapes were apart along this unit axis, at these vertices.
    Apart(DVec3, [VertexId; 2]),
    /// The shapes were in contact along these unit normals, each pointing out of its shape and in its frame.
    Contact([DVec3; 2]),
}

impl Hint {
    fn start(&self) -> Start {
        match self {
            Self::None => Start::Cold,
            Self::Apart(..) | Self::Contact(..) => Start::Warm,
        }
    }
}

/// The answer to a query about cores, in frame 1.
#[derive(Clone, Copy, Debug)]
pub enum CurvedAnswer {
    /// The bounding spheres are farther apart than the maximum distance.
    SpheresApart,
    /// The cores are farther apart than the maximum distance.
    Separated(SeparatingAxis),
    /// The cores are within the maximum distance, or overlap. Complete the contact patch to get its places.
    Near {
        /// The signed distance of the cores.
        signed_distance: f64,
        /// From shape 1 to shape 2.
        normal: DVec3,
        /// The point on shape 1 where the shapes are nearest or overlap most.
        on_1: DVec3,
    },
}

/// A query about two shapes, at least one of which is curved.
pub struct CurvedQuery<'a, 'c, A, B> {
    /// The pair without borders.
    pub cso: &'a Cso<'c, A, B>,
    /// The widths of the rounded borders.
    pub border_radii: [f64; 2],
    /// If the cores are farther apart than this, the answer is [`CurvedAnswer::Separated`].
    pub max_distance: f64,
    /// The contacts of the previous frame.
    pub(crate) last: Option<&'a LastContacts>,
    /// Memory to work in.
    pub scratch: &'a mut CurvedScratch,
    /// The cost of the query is added here.
    pub cost: &'a mut Cost,
}

impl<A: SurfacePieces, B: SurfacePieces> CurvedQuery<'_, '_, A, B> {
    /// The answer, and the stage that found it. `None` if the pair is not finite or has no volume.
    pub fn run(&mut self, hint: Hint) -> Option<(CurvedAnswer, Stage)> {
        if self.cso.are_spheres_apart(self.max_distance) {
            return Some((CurvedAnswer::SpheresApart, Stage::BoundingSpheres));
        }
        let start = hint.start();
        if let Hint::Contact(normals) = hint
            && let Some(answer) = self.on_segment().or_else(|| self.at_rest(normals))
        {
            return Some((answer, Stage::Feature));
        }
        let mut at = self.along_hint(hint);
        if at.distance <= self.max_distance && !matches!(hint, Hint::Contact(..)) {
            at = at.or(self.tilted(&at));
        }
        if at.distance > self.max_distance {
            return Some((apart(&at), Stage::Axis));
        }
        if !matches!(hint, Hint::Contact(..))
            && let Some(answer) = self.on_segment()
        {
            return Some((answer, Stage::Feature));
        }
        let best = match self.by_pieces(&at, matches!(hint, Hint::Contact(..))) {
            ControlFlow::Break(answer) => return Some((answer, Stage::Feature)),
            ControlFlow::Continue(best) => best,
        };
        // Faces of a polytope that does not contain the origin say nothing about how far it is outside.
        let is_deep = best.distance <= 0.0 && self.did_overlap(hint);
        if !is_deep && let Some(found) = self.by_gjk(&at, start) {
            return Some(found);
        }
        let answer = self.by_epa(best, is_deep)?;
        Some((answer, start.epa()))
    }

    /// Whether the cores still overlap where the last contacts were.
    fn did_overlap(&self, hint: Hint) -> bool {
        let Hint::Contact([normal, _]) = hint else {
            return false;
        };
        let borders = self.border_radii[0] + self.border_radii[1];
        self.last
            .is_some_and(|last| last.least(normal) + borders < 0.0)
    }

    /// The separation along the remembered axis or normal, or along the line of centres.
    fn along_hint(&mut self, hint: Hint) -> NormalSeparation {
        let cso = self.cso;
        let (axis, ids) = match hint {
            Hint::None => {
                let axis = cso.towards_origin();
                (axis, cso.start_vertices(axis))
            }
            Hint::Apart(axis, ids) => (axis, cso.clamp_vertices(ids)),
            Hint::Contact([normal, _]) => (normal, cso.start_vertices(normal)),
        };
        let start = CsoVertex {
            ids,
            ..CsoVertex::default()
        };
        NormalSeparation::along(cso, axis.normalize(), &start, self.cost)
    }

    /// The separation along an axis that is tilted away from the point where the shapes come too near.
    fn tilted(&mut self, at: &NormalSeparation) -> NormalSeparation {
        let aside = at.extreme.w - at.normal * at.normal.dot(at.extreme.w);
        let tilted = (at.normal - aside.normalize_or_zero() * TILT).normalize();
        NormalSeparation::along(self.cso, tilted, &at.extreme, self.cost)
    }
}

pub(super) fn apart(found: &NormalSeparation) -> CurvedAnswer {
    CurvedAnswer::Separated(SeparatingAxis {
        axis: found.normal,
        separation: found.distance,
        ids: found.extreme.ids,
    })
}
