//! Manifolds as lines of a recording.

use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use super::error::RecordingError;
use super::lines::{self, Lines};

/// A manifold without the solver's data.
pub(crate) fn bare<M, C>(manifold: &ContactManifold<M, C>) -> ContactManifold<(), ()> {
    let mut bare = ContactManifold::new();
    bare.local_n1 = manifold.local_n1;
    bare.local_n2 = manifold.local_n2;
    let contacts = manifold.points.iter();
    let contacts =
        contacts.map(|c| TrackedContact::new(c.local_p1, c.local_p2, c.fid1, c.fid2, c.dist));
    bare.points = contacts.collect();
    bare
}

pub(super) fn write(keyword: &str, manifold: &ContactManifold<(), ()>, text: &mut String) {
    let [n1, n2] = [manifold.local_n1, manifold.local_n2].map(|n| n.to_array());
    lines::push(keyword, [n1, n2].as_flattened(), text);
    lines::push("contacts", &[manifold.points.len()], text);
    for contact in &manifold.points {
        let [id_1, id_2] = [contact.fid1, contact.fid2].map(|id| id.0);
        let [p1, p2] = [contact.local_p1, contact.local_p2].map(|p| p.to_array());
        let numbers = [&p1[..], &p2, &[contact.dist]].concat();
        lines::push(&format!("{id_1} {id_2}"), &numbers, text);
    }
}

pub(super) fn read(
    keyword: &'static str,
    lines: &mut Lines<'_>,
) -> Result<ContactManifold<(), ()>, RecordingError> {
    let mut manifold = ContactManifold::new();
    let mut words = lines.after(keyword)?;
    (manifold.local_n1, manifold.local_n2) = (words.vector()?, words.vector()?);
    words.end()?;
    let contacts = lines.list("contacts", |words| {
        let [fid1, fid2] = words.numbers()?.map(PackedFeatureId);
        let (p1, p2) = (words.vector()?, words.vector()?);
        Ok(TrackedContact::new(p1, p2, fid1, fid2, words.number()?))
    })?;
    manifold.points = contacts.into_iter().collect();
    Ok(manifold)
}
