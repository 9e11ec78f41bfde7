//! Ids of contacts that last from frame to frame.

use super::feature::{FACE, Feature, KIND, VERTEX};
use crate::map_pair::map_pair;
use crate::simd::u32x4;

/// The id of a contact within its pair: the features of both shapes that meet there, in the order of the
/// shapes.
///
/// It depends only on the shapes and their poses, and stays the same from frame to frame while the same
/// features meet. The id of a vertex on a face is that vertex, whichever face it slides over, so the contacts
/// of a sliding box keep their ids on a triangulated floor. [`ContactId::of`] reads the ids of contacts in
/// rapier's manifolds. Impulses find their contacts from step to step by these ids.
///
/// Ids are unique within one patch, but not between pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContactId([u32; 2]);

impl ContactId {
    /// The id of the contact where these features meet.
    pub fn new(features: [Feature; 2]) -> Self {
        let codes = features.map(|feature| u32x4::splat(feature.code()));
        Self(contact_keys(codes).map(|key| key.to_array()[0]))
    }
}

/// The ids of four contacts at once, from the codes of both shapes' features. Against a vertex, all faces are
/// the same.
// perf: in a call the lanes go through memory.
#[inline(always)]
pub(crate) fn contact_keys([a, b]: [u32x4; 2]) -> [u32x4; 2] {
    let [kind, face] = [u32x4::splat(KIND), u32x4::splat(FACE)];
    let vertex_and_face = ((a ^ b) & kind).simd_eq(u32x4::splat(VERTEX ^ FACE));
    map_pair([a, b], |code| {
        let any = vertex_and_face & (code & kind).simd_eq(face);
        any.bitselect(face, code)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_faces_under_vertices_do_not_matter() {
        let features = [1_u32, 2].map(|i| {
            let (vertex, edge) = (Feature::Vertex(i.into()), Feature::Edge(i.into()));
            [vertex, edge, Feature::Face(i.into())]
        });
        let features = features.as_flattened();
        let pairs = features
            .iter()
            .flat_map(|a| features.iter().map(|b| [*a, *b]));
        let pairs: Vec<[Feature; 2]> = pairs.collect();
        let with_any_face = |[a, b]: [Feature; 2]| match [a, b] {
            [Feature::Vertex(_), Feature::Face(_)] => [Some(a), None],
            [Feature::Face(_), Feature::Vertex(_)] => [None, Some(b)],
            _ => [Some(a), Some(b)],
        };
        for &a in &pairs {
            for &b in &pairs {
                let same = ContactId::new(a) == ContactId::new(b);
                assert_eq!(
                    same,
                    with_any_face(a) == with_any_face(b),
                    "{a:?} and {b:?}"
                );
            }
        }
    }
}
