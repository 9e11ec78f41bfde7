//! What happens in Bevy's worlds.

mod entities;
#[cfg(feature = "bevy_app")]
mod plugin;
