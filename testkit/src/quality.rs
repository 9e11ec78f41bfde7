//! How well a world rests: what one sees of its contacts.

use std::collections::HashMap;

use isa_gjk::IsaGjkDispatcher;
use parry3d::query::QueryDispatcher;
use rapier3d::prelude::*;

use crate::scenes::World;

/// Steps from one measurement of the true overlaps to the next.
const OVERLAPS_EVERY: usize = 16;

/// Observations of one world.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quality {
    /// How far the most tilted body has turned away from its first upright, in degrees.
    pub tilt: f64,
    /// Steps until every dynamic body slept, if they all did.
    pub asleep_after: Option<usize>,
    /// How far the body has come that moved most since [`Observer::mark`], in metres.
    pub drift: f64,
    /// The true overlap that 99 of 100 pairs of touching colliders do not exceed, in metres, by a new query
    /// of ours: manifolds can be some frames old, and miss the deepest point.
    pub overlap: f64,
    /// The speed that half of the bodies do not exceed at the end, in metres per second.
    pub median_speed: f64,
    /// Mean horizontal distance from the centre of mass of the upper body of a pair to the
    /// centroid of its contacts, in radii of that body.
    pub patch_offset: f64,
    /// How far that centroid moves against the centre from step to step, in radii: mean.
    pub patch_step: f64,
    /// The same, in the worst step.
    pub worst_patch_step: f64,
}

/// Follows a world from its first step on.
pub struct Observer {
    upright: Vec<Rotation>,
    marked: Vec<Vector>,
    overlaps: Vec<f64>,
    patches: HashMap<[ColliderHandle; 2], Vector>,
    offsets: Mean,
    patch_steps: Mean,
    worst_patch_step: f64,
    steps: usize,
    asleep_after: Option<usize>,
}

impl Observer {
    /// Starts with the world as it is.
    pub fn new(world: &World) -> Self {
        Self {
            upright: world.dynamic_bodies().map(|b| *b.rotation()).collect(),
            marked: places(world),
            overlaps: Vec::new(),
            patches: HashMap::new(),
            offsets: Mean::default(),
            patch_steps: Mean::default(),
            worst_patch_step: 0.0,
            steps: 0,
            asleep_after: None,
        }
    }

    /// Takes note of one step.
    pub fn step(&mut self, world: &World) {
        self.steps += 1;
        let all_asleep = world.dynamic_bodies().all(RigidBody::is_sleeping);
        self.asleep_after = match self.asleep_after {
            Some(steps) if all_asleep => Some(steps),
            _ => all_asleep.then_some(self.steps),
        };
        self.note_patches(world);
        if self.steps.is_multiple_of(OVERLAPS_EVERY) {
            self.overlaps.extend(overlaps(world));
        }
    }

    /// Forgets all observations of drift, overlaps and patches so far.
    pub fn mark(&mut self, world: &World) {
        self.marked = places(world);
        self.overlaps.clear();
        self.offsets = Mean::default();
        self.patch_steps = Mean::default();
        self.worst_patch_step = 0.0;
    }

    /// Where the contacts of bodies that stand on others are.
    fn note_patches(&mut self, world: &World) {
        let before = std::mem::take(&mut self.patches);
        for pair in world.physics.narrow_phase.contact_pairs() {
            let Some((radius, offset)) = patch(world, pair) else {
                continue;
            };
            self.offsets.add(f64::from(offset.length() / radius));
            let colliders = [pair.collider1, pair.collider2];
            if let Some(old) = before.get(&colliders) {
                let step = f64::from(offset.distance(*old) / radius);
                self.patch_steps.add(step);
                self.worst_patch_step = self.worst_patch_step.max(step);
            }
            self.patches.insert(colliders, offset);
        }
    }

    /// What came out of it.
    pub fn finish(&self, world: &World) -> Quality {
        let tilts = world
            .dynamic_bodies()
            .zip(&self.upright)
            .map(|(body, at_first)| {
                let up = *body.rotation() * (at_first.inverse() * Vector::Y);
                f64::from(up.y.clamp(-1.0, 1.0)).acos().to_degrees()
            });
        let drifts = places(world).into_iter().zip(&self.marked);
        let speeds = world
            .dynamic_bodies()
            .map(|body| f64::from(body.linvel().length()));
        Quality {
            tilt: tilts.fold(0.0, f64::max),
            asleep_after: self.asleep_after,
            drift: drifts
                .map(|(now, then)| f64::from(now.distance(*then)))
                .fold(0.0, f64::max),
            overlap: quantile(self.overlaps.clone(), 0.99),
            median_speed: quantile(speeds.collect(), 0.5),
            patch_offset: self.offsets.value(),
            patch_step: self.patch_steps.value(),
            worst_patch_step: self.worst_patch_step,
        }
    }
}

/// The value that a `share` of the others do not exceed; zero if there are none.
pub fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    let Some(last) = values.len().checked_sub(1) else {
        return 0.0;
    };
    let rank = (last as f64 * share).round() as usize;
    *values.select_nth_unstable_by(rank, f64::total_cmp).1
}

/// The true overlaps of all pairs with contacts.
pub(crate) fn overlaps(world: &World) -> impl Iterator<Item = f64> {
    let colliders = &world.physics.colliders;
    let pairs = world.physics.narrow_phase.contact_pairs();
    let touching = pairs.filter(|pair| pair.has_any_active_contact());
    let dispatcher = IsaGjkDispatcher::default();
    touching.map(move |pair| {
        let [a, b] = [pair.collider1, pair.collider2].map(|handle| &colliders[handle]);
        let pos12 = a.position().inv_mul(b.position());
        let contact = dispatcher.contact(&pos12, a.shape(), b.shape(), 0.0);
        let distance = contact.ok().flatten().map_or(0.0, |contact| contact.dist);
        f64::from(-distance.min(0.0))
    })
}

fn places(world: &World) -> Vec<Vector> {
    world.dynamic_bodies().map(RigidBody::translation).collect()
}

/// The radius of the upper body of a touching pair, and the horizontal way from its centre of
/// mass to the centroid of the contacts. `None` for contacts from the side.
fn patch(world: &World, pair: &ContactPair) -> Option<(Real, Vector)> {
    let manifold = pair
        .manifolds()
        .iter()
        .max_by_key(|m| m.data.solver_contacts.len())?;
    if manifold.data.solver_contacts.is_empty() || manifold.data.normal.y.abs() < 0.9 {
        return None;
    }
    let [lower, upper] = if manifold.data.normal.y > 0.0 {
        [pair.collider1, pair.collider2]
    } else {
        [pair.collider2, pair.collider1]
    };
    let collider = &world.physics.colliders[upper];
    let body = &world.physics.bodies[collider.parent()?];
    let on_upper = |point: &TrackedContact<ContactData>| {
        if lower == pair.collider1 {
            point.local_p2
        } else {
            point.local_p1
        }
    };
    let points = manifold.points.iter().map(on_upper);
    let centroid = points.sum::<Vector>() / manifold.points.len() as Real;
    let from_centre = collider.position() * centroid - body.center_of_mass();
    let extents = collider.shape().compute_local_aabb().half_extents();
    let horizontal = Vector::new(from_centre.x, 0.0, from_centre.z);
    Some((extents.x.max(extents.z), horizontal))
}

#[derive(Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn value(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}
