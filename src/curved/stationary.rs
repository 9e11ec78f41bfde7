//! Candidate normals along which two shapes may be nearest or overlap least, derived from the pieces of
//! surface that meet.

use glam::{DVec2, DVec3};

use super::circle::along_ruling;
use super::curvature::Curvature;
use super::separation::NormalSeparation;
use super::surface_pieces::{Ruling, SurfacePieces};
use crate::stats::Cost;
use crate::support::Cso;
use crate::tolerance::{PARALLEL_AXES, SETTLED_ANGLE};
use crate::tuning::{LONGEST_STEP, MAX_NEWTON_STEPS};

/// Of the flat sides at the extreme vertices whose normal is within an angle of the one at hand, the normal with the
/// greatest separation.
pub(super) fn flat<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
    turn: f64,
    cost: &mut Cost,
) -> Option<NormalSeparation> {
    let [id_1, id_2] = at.extreme.ids;
    let outward_2 = -cso.pose.direction_to_2(at.normal);
    let first = cso.shape_1.flat(at.normal, id_1).map(|flat| flat.normal);
    let second = cso.shape_2.flat(outward_2, id_2);
    let second = second.map(|flat| -cso.pose.direction_to_1(flat.normal));
    let normals = [first, second].into_iter().flatten();
    normals
        .filter(|normal| normal.distance_squared(at.normal) < turn * turn)
        .map(|normal| NormalSeparation::along(cso, normal, &at.extreme, cost))
        .reduce(NormalSeparation::or)
}

/// Whether an edge or a ruled side has normals within a small angle of `about`.
fn is_within(ruling: &Ruling, turn: f64, about: DVec3) -> bool {
    (ruling.axis.dot(about) - ruling.sine).abs() < turn
}

/// The normal with the greatest separation that satisfies two rulings, one of each shape. Both have normals within an
/// angle of the one at hand.
pub(super) fn ruled<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
    turn: f64,
    cost: &mut Cost,
) -> Option<NormalSeparation> {
    let mut best: Option<NormalSeparation> = None;
    let of_first = cso.shape_1.rulings(at.normal, at.extreme.ids[0]);
    for first in of_first.filter(|ruling| is_within(ruling, turn, at.normal)) {
        for second in rulings_2(cso, at).filter(|ruling| is_within(ruling, turn, at.normal)) {
            if let Some(normal) = satisfying_both(&first, &second, at.normal) {
                let found = NormalSeparation::along(cso, normal, &at.extreme, cost);
                best = Some(best.map_or(found, |best| best.or(found)));
            }
        }
    }
    best
}

/// The rulings of shape 2 in frame 1, as conditions for the contact normal.
fn rulings_2<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
) -> impl Iterator<Item = Ruling> {
    let outward_2 = -cso.pose.direction_to_2(at.normal);
    let rulings = cso.shape_2.rulings(outward_2, at.extreme.ids[1]);
    rulings.map(|ruling| Ruling {
        axis: cso.pose.direction_to_1(ruling.axis),
        sine: -ruling.sine,
    })
}

/// Of the two unit vectors that satisfy both rulings, the one nearer to `about`.
fn satisfying_both(first: &Ruling, second: &Ruling, about: DVec3) -> Option<DVec3> {
    let cross = first.axis.cross(second.axis);
    let area = cross.length_squared();
    if area < PARALLEL_AXES {
        return None;
    }
    let cosine = first.axis.dot(second.axis);
    let a = (first.sine - cosine * second.sine) / area;
    let b = (second.sine - cosine * first.sine) / area;
    let within = first.axis * a + second.axis * b;
    let rest = 1.0 - within.length_squared();
    (rest >= 0.0).then(|| {
        let out = (rest / area).sqrt().copysign(cross.dot(about));
        (within + cross * out).normalize()
    })
}

/// The normal with the greatest separation that satisfies one ruling, which has normals within an angle of the one at
/// hand.
pub(super) fn along_rulings<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
    turn: f64,
    cost: &mut Cost,
) -> Option<NormalSeparation> {
    let mut best: Option<NormalSeparation> = None;
    let of_first = cso.shape_1.rulings(at.normal, at.extreme.ids[0]);
    let rulings = of_first.chain(rulings_2(cso, at));
    for ruling in rulings.filter(|ruling| is_within(ruling, turn, at.normal)) {
        if let Some(found) = along_ruling(cso, &ruling, (at.normal, &at.extreme), cost) {
            best = Some(best.map_or(found, |best| best.or(found)));
        }
    }
    best
}

/// The normal close to the one at hand with the greatest separation, between vertices and rims, where no
/// ruling restricts it. Found by Newton's method.
pub(super) fn smooth<A: SurfacePieces, B: SurfacePieces>(
    cso: &Cso<'_, A, B>,
    at: &NormalSeparation,
    cost: &mut Cost,
) -> Option<NormalSeparation> {
    let mut found = *at;
    for _ in 0..MAX_NEWTON_STEPS {
        let (a, b) = found.normal.any_orthonormal_pair();
        let curvature = Curvature::of(cso, &found)?;
        let slope = DVec2::new(a.dot(found.extreme.w), b.dot(found.extreme.w));
        let (aa, bb) = (
            curvature.between(a, a) + found.distance,
            curvature.between(b, b) + found.distance,
        );
        let ab = curvature.between(a, b);
        let determinant = aa * bb - ab * ab;
        let step =
            DVec2::new(bb * slope.x - ab * slope.y, aa * slope.y - ab * slope.x) / -determinant;
        if !(aa > 0.0 && determinant > 0.0 && step.length() < LONGEST_STEP) {
            return None;
        }
        if step.length() < SETTLED_ANGLE {
            return Some(found);
        }
        let normal = (found.normal + a * step.x + b * step.y).normalize();
        found = NormalSeparation::along(cso, normal, &found.extreme, cost);
    }
    None
}
