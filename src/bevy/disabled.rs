//! Bodies whose entities are disabled.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use bevy_ecs::change_detection::{DetectChanges, Tick};
use bevy_ecs::entity::Entity;

/// When components were last brought to rapier.
#[derive(Clone, Copy)]
pub(super) struct Synced {
    /// The run of the system that did it.
    pub at: Tick,
    /// When we had last written components ourselves.
    pub written: Tick,
}

impl Synced {
    pub fn is_changed(self, component: &impl DetectChanges) -> bool {
        component.is_changed_after(self.at)
    }

    /// Each system that runs has a tick of its own, so none of the user's is that of our writing.
    pub fn is_changed_by_user(self, component: &impl DetectChanges) -> bool {
        self.is_changed(component) && component.last_changed() != self.written
    }
}

/// The disabled entities, in a fixed order, and when their components were last looked at.
#[derive(Default)]
pub(super) struct DisabledEntities(BTreeMap<Entity, Synced>);

impl DisabledEntities {
    /// Whether the entity was not disabled before.
    pub fn insert(&mut self, entity: Entity, synced: Synced) -> bool {
        let entry = self.0.entry(entity);
        let is_new = matches!(entry, Entry::Vacant(_));
        entry.or_insert(synced);
        is_new
    }

    /// Takes out all for which this does not hold any more.
    pub fn take_unless(
        &mut self,
        is_disabled: impl Fn(Entity) -> bool,
    ) -> BTreeMap<Entity, Synced> {
        let left = std::mem::take(&mut self.0);
        let (kept, taken) = left
            .into_iter()
            .partition(|(entity, _)| is_disabled(*entity));
        self.0 = kept;
        taken
    }
}
