//! What happens in Bevy's worlds.

mod entities;
mod narrow_phase;
#[cfg(feature = "bevy_app")]
mod plugin;
