//! The systems as a plugin, in step with Bevy's fixed clock, with diagnostics.

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time};

use super::collision::CollisionEvent;
use super::context::PhysicsContext;
use super::systems::{NarrowPhaseStats, PhysicsSystems, add_systems, begin_install};

/// Steps a [`PhysicsContext`] in `FixedPostUpdate`, by the time step of `Time<Fixed>`.
///
/// The rest is the same as with [`install`](super::install), except that [`CollisionEvent`]s are kept as long
/// as other messages of an `App`. The associated constants name the diagnostics; the times need the feature
/// `profiler`. Each value is from the last step of its frame.
///
/// ```
/// use bevy_app::{App, TaskPoolPlugin};
/// use bevy_time::TimePlugin;
/// use isa_gjk::bevy::{Collider, PhysicsPlugin};
/// use rapier3d::prelude::ColliderBuilder;
///
/// let mut app = App::new();
/// app.add_plugins((TaskPoolPlugin::default(), TimePlugin, PhysicsPlugin));
/// app.world_mut().spawn(Collider(ColliderBuilder::ball(0.5)));
/// app.update();
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct PhysicsPlugin;

impl PhysicsPlugin {
    /// Contact pairs of the narrow phase, touching or not.
    pub const CONTACT_PAIRS: DiagnosticPath = DiagnosticPath::const_new("isa_gjk/contact_pairs");
    /// Queries that this crate's dispatcher answered.
    pub const QUERIES: DiagnosticPath = DiagnosticPath::const_new("isa_gjk/queries");
    /// Time of a step, in milliseconds.
    #[cfg(feature = "profiler")]
    pub const STEP_TIME: DiagnosticPath = DiagnosticPath::const_new("isa_gjk/step_time");
    /// Time of the narrow phase in a step, in milliseconds.
    #[cfg(feature = "profiler")]
    pub const NARROW_PHASE_TIME: DiagnosticPath =
        DiagnosticPath::const_new("isa_gjk/narrow_phase_time");
}

impl Plugin for PhysicsPlugin {
    fn build(&self, app: &mut App) {
        if !begin_install(app.world_mut()) {
            return;
        }
        app.add_message::<CollisionEvent>()
            .edit_schedule(FixedPostUpdate, add_systems)
            .add_systems(
                FixedPostUpdate,
                (
                    follow_fixed_clock.in_set(PhysicsSystems::SyncBackend),
                    measure.after(PhysicsSystems::Writeback),
                ),
            )
            .register_diagnostic(Diagnostic::new(Self::CONTACT_PAIRS))
            .register_diagnostic(Diagnostic::new(Self::QUERIES));
        #[cfg(feature = "profiler")]
        app.register_diagnostic(Diagnostic::new(Self::STEP_TIME).with_suffix("ms"))
            .register_diagnostic(Diagnostic::new(Self::NARROW_PHASE_TIME).with_suffix("ms"));
    }
}

fn follow_fixed_clock(time: Option<Res<Time<Fixed>>>, mut context: ResMut<PhysicsContext>) {
    if let Some(time) = time {
        context.world.integration_parameters.dt = time.timestep().as_secs_f32();
    }
}

fn measure(
    context: Res<PhysicsContext>,
    stats: Res<NarrowPhaseStats>,
    mut diagnostics: Diagnostics<'_, '_>,
) {
    diagnostics.add_measurement(&PhysicsPlugin::CONTACT_PAIRS, || {
        context.world.contact_pairs().count() as f64
    });
    diagnostics.add_measurement(&PhysicsPlugin::QUERIES, || stats.last_step.queries() as f64);
    #[cfg(feature = "profiler")]
    {
        let counters = &context.world.physics_pipeline.counters;
        diagnostics.add_measurement(&PhysicsPlugin::STEP_TIME, || counters.step_time_ms());
        diagnostics.add_measurement(&PhysicsPlugin::NARROW_PHASE_TIME, || {
            counters.narrow_phase_time_ms()
        });
    }
}
