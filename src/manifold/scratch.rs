//! Memory for manifolds.

use super::clip::Clipper;
use super::contact_frame::FaceHeight;
use super::reduce::Candidates;

/// Memory for manifolds, reused from one to the next, so that they do not allocate.
#[derive(Clone, Debug, Default)]
pub struct ClipScratch {
    pub(super) planes: [Vec<FaceHeight>; 2],
    pub(super) clipper: Clipper,
    pub(super) candidates: Candidates,
}
