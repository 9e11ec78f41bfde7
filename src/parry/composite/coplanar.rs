//! The contacts of parts that meet the other shape in one plane.
//!
//! rapier merges the manifolds of a pair whose normals are nearly the same, and its solver takes four of
//! their contacts: the deepest one, and others far from it, however high they are above the surface. So a
//! body of two parts may lie on one contact that touches and on three that do not. It tips over, the next
//! four contacts are others, and it never comes to rest.
//!
//! So where some contacts are high, we leave four in the plane: those that are far from each other, but low. Up
//! to four parts have one of these each, unless that leaves too few low ones to lie on: a table that lies on its
//! top needs all corners of the top, and nothing under its legs, which end above. Parts without one of the four
//! keep their deepest contact, or one as deep, since that is the answer of their query.

use glam::Vec2;
use parry3d::math::{Real, Vector};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{Shape, ShapeType};

use super::spread::{PartContact, Spread};
use crate::manifold::MAX_POINTS;
use crate::parry::without_hull::{makes_pair_ours, makes_pair_with_triangle_ours};
use crate::tuning::{ALL_LEVEL, BEARING_WIDTH, ONE_DEPTH, ONE_PLANE_COS, RISE};

/// With more planes than these, contacts in the others stay as they are.
const MAX_PLANES: usize = 8;

/// A plane with more contacts than these keeps all of them.
const MAX_CONTACTS: usize = 64;

/// Reduces the contacts of the parts of two shapes, if some of these parts are ours to answer.
pub(super) fn reduce<M, C>(shapes: [&dyn Shape; 2], manifolds: &mut [ContactManifold<M, C>]) {
    let count: usize = manifolds.iter().map(|manifold| manifold.points.len()).sum();
    if count <= MAX_POINTS || !manifolds.iter().any(|manifold| is_ours(shapes, manifold)) {
        return;
    }
    let planes = Planes::of(manifolds);
    for plane in 0..planes.len {
        let Group {
            parts, contacts, ..
        } = planes.groups[plane];
        if parts > 1 && contacts > parts.max(MAX_POINTS) {
            planes.reduce(plane, manifolds);
        }
    }
}

/// The manifolds whose normals are nearly the same.
#[derive(Clone, Copy, Default)]
struct Group {
    /// Of the first of them, in the frame of the first shape.
    normal: Vector,
    parts: usize,
    contacts: usize,
}

/// The planes in which the parts meet the other shape.
struct Planes {
    groups: [Group; MAX_PLANES],
    len: usize,
}

impl Planes {
    fn of<M, C>(manifolds: &[ContactManifold<M, C>]) -> Self {
        let mut planes = Self {
            groups: Default::default(),
            len: 0,
        };
        for manifold in manifolds {
            if manifold.points.is_empty() {
                continue;
            }
            let normal = normal(manifold);
            let plane = planes.find(normal).unwrap_or(planes.len);
            if let Some(group) = planes.groups.get_mut(plane) {
                if plane == planes.len {
                    group.normal = normal;
                    planes.len += 1;
                }
                group.parts += 1;
                group.contacts += manifold.points.len();
            }
        }
        planes
    }

    /// The first plane with about this normal: rapier merges manifolds in the same way.
    fn find(&self, normal: Vector) -> Option<usize> {
        let groups = self.groups[..self.len].iter();
        groups
            .map(|group| group.normal.dot(normal))
            .position(|cos| cos >= ONE_PLANE_COS)
    }

    /// The contacts in a plane, in a buffer. `None` if there are more than fit into it.
    fn contacts<'a, M, C>(
        &self,
        plane: usize,
        manifolds: &[ContactManifold<M, C>],
        buffer: &'a mut [PartContact; MAX_CONTACTS],
    ) -> Option<&'a [PartContact]> {
        let (x, y) = self.groups[plane].normal.any_orthonormal_pair();
        let mut count = 0;
        for (manifold, part) in manifolds.iter().enumerate() {
            if part.points.is_empty() || self.find(normal(part)) != Some(plane) {
                continue;
            }
            let deepest = deepest(&part.points);
            let pos = part.subshape_pos1();
            for (place, point) in part.points.iter().enumerate() {
                let at = pos.map_or(point.local_p1, |pos| *pos * point.local_p1);
                *buffer.get_mut(count)? = PartContact {
                    manifold,
                    place,
                    at: Vec2::new(at.dot(x), at.dot(y)),
                    distance: point.dist,
                    above: point.dist - deepest,
                };
                count += 1;
            }
        }
        Some(&buffer[..count])
    }

    /// Drops the contacts of a plane that are not chosen, except for the deepest of a part that has no other.
    fn reduce<M, C>(&self, plane: usize, manifolds: &mut [ContactManifold<M, C>]) {
        let mut buffer = [PartContact::default(); MAX_CONTACTS];
        let Some(contacts) = self.contacts(plane, manifolds, &mut buffer) else {
            return;
        };
        let Some(spread) = choose(contacts, self.groups[plane].parts) else {
            return;
        };
        // From the last one, so that the places of the others stay.
        for (i, contact) in contacts.iter().enumerate().rev() {
            if !spread.contains(contact) && !spread.lacks(contact, &contacts[..i]) {
                manifolds[contact.manifold].points.remove(contact.place);
            }
        }
    }
}

/// The contacts to leave. `None` if all are about equally high: then any choice will do.
fn choose(contacts: &[PartContact], parts: usize) -> Option<Spread> {
    let deepest = greatest(contacts, |contact| Some(-contact.distance))?;
    let away = |contact: &PartContact| contact.at.distance(deepest.at);
    let extent = contacts.iter().map(away).fold(0.0, Real::max);
    let level = deepest.distance + ALL_LEVEL * extent;
    if contacts.iter().all(|contact| contact.distance <= level) {
        return None;
    }
    let spread = |parts| Spread::over(contacts, deepest, ONE_DEPTH * extent, parts);
    let bears = |spread: &Spread| spread.bears(level, BEARING_WIDTH * extent);
    if parts > MAX_POINTS {
        return Some(spread(0));
    }
    let shared = spread(parts);
    if bears(&shared) {
        return Some(shared);
    }
    let free = spread(0);
    Some(if bears(&free) { free } else { shared })
}

impl Spread {
    /// The deepest contact, and three others: each as far as possible from those before it, less its height
    /// above the deepest. The last ones are left to `parts` that have none yet.
    fn over(contacts: &[PartContact], deepest: &PartContact, tie: Real, parts: usize) -> Self {
        let mut spread = Self::new(tie);
        let height = |contact: &PartContact| contact.distance - deepest.distance;
        // Of equally deep ones, one at the rim leaves room for the others.
        let first = greatest(contacts, |contact| {
            (height(contact) <= tie).then(|| contact.at.distance(deepest.at))
        });
        spread.push(first.unwrap_or(deepest));
        for place in 1..MAX_POINTS {
            let without = parts.saturating_sub(spread.parts);
            let is_reserved = without >= MAX_POINTS - place;
            let room = spread.room();
            let best = greatest(contacts, |contact| {
                let is_new = !spread.contains(contact);
                let is_allowed = is_new && (!is_reserved || spread.would_serve(contact));
                is_allowed.then(|| room.at(contact.at) - RISE * height(contact))
            });
            let Some(best) = best else {
                break;
            };
            spread.push(best);
        }
        spread
    }
}

/// The contact with the greatest worth, of those that have one.
fn greatest(
    contacts: &[PartContact],
    worth: impl Fn(&PartContact) -> Option<Real>,
) -> Option<&PartContact> {
    let mut greatest = None;
    for contact in contacts {
        if let Some(worth) = worth(contact)
            && greatest.is_none_or(|(_, most)| worth > most)
        {
            greatest = Some((contact, worth));
        }
    }
    greatest.map(|(contact, _)| contact)
}

/// Whether the contacts of two parts are ours.
fn is_ours<M, C>([s1, s2]: [&dyn Shape; 2], manifold: &ContactManifold<M, C>) -> bool {
    is_part_ours([s1, s2], manifold.subshape1) || is_part_ours([s2, s1], manifold.subshape2)
}

/// Whether a part of the first shape makes its pairs with parts of the second one ours.
fn is_part_ours([shape, other]: [&dyn Shape; 2], part: u32) -> bool {
    let makes_ours = match other.shape_type() {
        ShapeType::TriMesh | ShapeType::HeightField => makes_pair_with_triangle_ours,
        _ => makes_pair_ours,
    };
    let Some(compound) = shape.as_compound() else {
        return makes_ours(shape);
    };
    let part = usize::try_from(part)
        .ok()
        .and_then(|part| compound.shapes().get(part));
    part.is_some_and(|(_, part)| makes_ours(&**part))
}

/// The normal in the frame of the first shape.
fn normal<M, C>(manifold: &ContactManifold<M, C>) -> Vector {
    let local = manifold.local_n1;
    manifold
        .subshape_pos1()
        .map_or(local, |pos| pos.rotation * local)
}

/// The least distance.
fn deepest<C>(points: &[TrackedContact<C>]) -> Real {
    let distances = points.iter().map(|point| point.dist);
    distances.fold(Real::MAX, Real::min)
}
