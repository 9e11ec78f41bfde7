//! Whether a manifold looks wrong.

use parry3d::query::ContactManifold;
use parry3d::shape::Shape;

use super::view::PairView;
use crate::query::SeparationBounds;
use crate::tolerance::SUSPECT;

/// Why a manifold looks wrong. Distances are compared with [`SeparationBounds`], which are proved at the
/// same poses without the memory of the pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Suspicion {
    /// A normal, a point or a distance is NaN or infinite.
    NotFinite,
    /// The shapes are nearer to each other than the prediction distance, and have no contact.
    Missing,
    /// The shapes are farther apart than the prediction distance, and have a contact.
    Invented,
    /// The deepest contact is deeper than the shapes are.
    TooDeep,
    /// The deepest contact is not as deep as the shapes are.
    TooShallow,
}

impl Suspicion {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::NotFinite,
        Self::Missing,
        Self::Invented,
        Self::TooDeep,
        Self::TooShallow,
    ];

    /// Its name in recordings.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotFinite => "not-finite",
            Self::Missing => "missing",
            Self::Invented => "invented",
            Self::TooDeep => "too-deep",
            Self::TooShallow => "too-shallow",
        }
    }
}

/// What looks wrong about a manifold after its update; `None` also if the bounds are unknown.
pub(super) fn judge(pair: &PairView<'_>) -> Option<Suspicion> {
    let manifold = pair.after;
    if !is_finite(manifold) {
        return Some(Suspicion::NotFinite);
    }
    let [shape_1, shape_2] = pair.shapes;
    let bounds = SeparationBounds::between(shape_1, shape_2, pair.pos12).ok()?;
    let slack = SUSPECT * pair.shapes.map(diameter).into_iter().fold(0.0, f64::max);
    let prediction = f64::from(pair.prediction);
    let distances = manifold
        .points
        .iter()
        .map(|contact| f64::from(contact.dist));
    let deepest = distances.min_by(f64::total_cmp);
    if pair.has_corrected_normals {
        // Seen along any normal, shapes are no farther apart than they are.
        let is_above = deepest.is_some_and(|deepest| deepest > bounds.upper + slack);
        return is_above.then_some(Suspicion::TooShallow);
    }
    match deepest {
        None => (bounds.upper + slack < prediction).then_some(Suspicion::Missing),
        Some(_) if bounds.lower - slack > prediction => Some(Suspicion::Invented),
        Some(deepest) if deepest + slack < bounds.lower => Some(Suspicion::TooDeep),
        Some(deepest) if deepest - slack > bounds.upper => Some(Suspicion::TooShallow),
        Some(_) => None,
    }
}

fn is_finite(manifold: &ContactManifold<(), ()>) -> bool {
    let contacts = manifold.points.iter();
    let are_finite = contacts.clone().all(|contact| {
        contact.local_p1.is_finite() && contact.local_p2.is_finite() && contact.dist.is_finite()
    });
    let has_normals =
        contacts.len() == 0 || manifold.local_n1.is_finite() && manifold.local_n2.is_finite();
    are_finite && has_normals
}

/// The radius of the bounding sphere; zero for unbounded shapes.
fn diameter(shape: &dyn Shape) -> f64 {
    let radius = f64::from(shape.compute_local_bounding_sphere().radius);
    if shape.as_halfspace().is_some() || !radius.is_finite() {
        0.0
    } else {
        2.0 * radius
    }
}
