//! What identifies a contact from frame to frame.

use super::types::Feature;
use crate::support::FaceId;

/// Which contact of a pair this is: the features of both shapes that meet there, in the order of the shapes.
///
/// It depends on the shapes and their poses only, and stays the same from frame to frame while the same
/// features meet. A vertex on a face is that vertex, whichever of the faces it slides over: so the contacts
/// of a sliding box keep their ids on a triangulated floor. Ids are those of the contacts' features in
/// rapier's manifolds ([`ContactId::of`]), and this is how impulses find their contacts from step to step.
///
/// Ids differ within one patch, but mean nothing from pair to pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContactId([Feature; 2]);

/// Any face.
const ANY: Feature = Feature::Face(FaceId::new(u32::MAX as usize));

impl ContactId {
    /// Where these features meet.
    pub fn new(features: [Feature; 2]) -> Self {
        Self(match features {
            [vertex @ Feature::Vertex(_), Feature::Face(_)] => [vertex, ANY],
            [Feature::Face(_), vertex @ Feature::Vertex(_)] => [ANY, vertex],
            others => others,
        })
    }
}
