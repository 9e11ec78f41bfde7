//! A pair as lines of a recording.

use parry3d::math::Pose;

use super::judge::Suspicion;
use super::view::PairView;
use super::{lines, manifold, shape};

/// How a recording begins, before the version.
pub(super) const HEAD: &str = "isa-gjk pairs";
pub(super) const VERSION: &str = "1";
/// Stands for no suspicion.
pub(super) const NOTHING: &str = "nothing";
pub(super) const CORRECTED: &str = "corrected";
pub(super) const POSE: &str = "pose";

/// A pair as text; `None` if a recording cannot have its shapes.
pub(super) fn write(pair: &PairView<'_>, suspicion: Option<Suspicion>) -> Option<String> {
    let name = suspicion.map_or(NOTHING, Suspicion::name);
    let corrected = [" ", CORRECTED].concat();
    let corrected = if pair.has_corrected_normals {
        &*corrected
    } else {
        ""
    };
    let mut text = format!("\npair {name}{corrected}\n");
    for shape in pair.shapes {
        shape::write(shape, &mut text)?;
    }
    let Pose {
        translation,
        rotation,
        ..
    } = pair.pos12;
    let pose = [&translation.to_array()[..], &rotation.to_array()].concat();
    lines::push(POSE, &pose, &mut text);
    lines::push("prediction", &[pair.prediction], &mut text);
    manifold::write("before", pair.before, &mut text);
    manifold::write("after", pair.after, &mut text);
    Some(text)
}
