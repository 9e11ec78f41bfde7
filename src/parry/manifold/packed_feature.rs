//! Feature ids as parry packs them.

use parry3d::query::TrackedContact;
use parry3d::shape::PackedFeatureId;

use crate::query::{ContactId, Feature};

/// As parry packs feature ids; its own constructors are not inlined across crates.
#[inline]
pub(super) fn pack(feature: Feature) -> PackedFeatureId {
    PackedFeatureId(feature.code())
}

#[inline]
pub(super) fn unpack(id: PackedFeatureId) -> Option<Feature> {
    Feature::from_code(id.0)
}

impl ContactId {
    /// The id of a contact in a manifold that this crate wrote, for instance one of rapier's
    /// (`narrow_phase.contact_pair(a, b)`). `None` if another dispatcher wrote it without feature ids.
    pub fn of<C>(contact: &TrackedContact<C>) -> Option<Self> {
        Self::unpacked([contact.fid1, contact.fid2])
    }

    pub(super) fn unpacked([fid1, fid2]: [PackedFeatureId; 2]) -> Option<Self> {
        Some(Self::new([unpack(fid1)?, unpack(fid2)?]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(id: u32) -> Feature {
        Feature::Vertex(id.into())
    }

    fn edge(id: u32) -> Feature {
        Feature::Edge(id.into())
    }

    fn face(id: u32) -> Feature {
        Feature::Face(id.into())
    }

    #[test]
    fn packed_features_are_parrys() {
        assert_eq!(pack(vertex(7)), PackedFeatureId::vertex(7));
        assert_eq!(pack(edge(8)), PackedFeatureId::edge(8));
        assert_eq!(pack(face(9)), PackedFeatureId::face(9));
        for feature in [vertex(1), edge(2), face(3)] {
            assert_eq!(unpack(pack(feature)), Some(feature));
        }
        assert_eq!(unpack(PackedFeatureId::UNKNOWN), None);
    }
}
