//! The contacts of two capsules, in closed form.
//!
//! Capsules that lie side by side touch along a line. With a single contact at the deepest point they could
//! turn about it, so they get a contact at both ends of their common part.

use glam::DVec3;

use crate::primitive::{
    common_stretch, exit_from_capsule, middle_direction, nearest_share, stretch_beside,
};
use crate::tolerance::{CAPSULE_TOUCH, SAME_GAP};
use crate::tuning::SHORT_LINE;

/// A segment with a rounded border.
#[derive(Clone, Copy, Debug)]
pub struct Capsule {
    pub a: DVec3,
    pub b: DVec3,
    pub radius: f64,
}

/// A contact. Its points on both surfaces lie on one line along the normal.
#[derive(Clone, Copy, Debug)]
pub struct CapsuleContact {
    pub points: [DVec3; 2],
    /// Negative where they overlap.
    pub distance: f64,
    pub place: Place,
}

/// The place of a contact. The ends are in the order of the first capsule's axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Deepest,
    FirstEnd,
    SecondEnd,
}

/// The contacts of two capsules in one frame.
#[derive(Clone, Debug)]
pub struct CapsuleContacts {
    /// A unit vector from the first to the second.
    pub normal: DVec3,
    /// At least one.
    pub in_places: [Option<CapsuleContact>; 3],
}

impl CapsuleContacts {
    /// The contacts up to a distance; `None` if the capsules are farther apart.
    pub fn new(capsules: [Capsule; 2], max_distance: f64) -> Option<Self> {
        let [first, second] = capsules;
        let radii = first.radius + second.radius;
        let [c1, c2] = nearest_on_cores(first, second);
        let distance = c1.distance(c2) - radii;
        if !distance.is_finite() || distance > max_distance {
            return None;
        }
        let normal = normal(first, second, c2 - c1);
        let nearest = CapsuleContact {
            points: [c1 + normal * first.radius, c2 - normal * second.radius],
            distance,
            place: Place::Deepest,
        };
        let line = common_line(capsules, normal).unwrap_or_default();
        let ends = line.map(|end| end.filter(|end| end.distance <= max_distance));
        let least = ends.iter().flatten().map(|end| end.distance);
        let is_deepest = least.fold(f64::INFINITY, f64::min) > distance + SAME_GAP * radii;
        let [first_end, second_end] = ends;
        Some(Self {
            normal,
            in_places: [is_deepest.then_some(nearest), first_end, second_end],
        })
    }

    /// The contacts, at least one.
    pub fn iter(&self) -> impl Iterator<Item = &CapsuleContact> {
        self.in_places.iter().flatten()
    }
}

impl Capsule {
    /// How far the line from `p` along a unit vector goes until it leaves the capsule; `None` if it misses it.
    fn exit(&self, p: DVec3, dir: DVec3) -> Option<f64> {
        exit_from_capsule([self.a, self.b], self.radius, p, dir)
    }

    fn axis(&self) -> DVec3 {
        self.b - self.a
    }

    fn at(&self, share: f64) -> DVec3 {
        self.a + self.axis() * share
    }

    /// The fraction of the way from `a` to `b` at which the core is nearest to a point.
    fn nearest_share(&self, p: DVec3) -> f64 {
        nearest_share([self.a, self.b], p)
    }
}

/// The nearest points of the cores (Ericson, *Real-Time Collision Detection*, 5.1.9). If the axes are nearly
/// parallel, rounding spoils their common perpendicular, but then an end is as near.
fn nearest_on_cores(first: Capsule, second: Capsule) -> [DVec3; 2] {
    let (d1, d2) = (first.axis(), second.axis());
    let between = first.a - second.a;
    let (a, b, e) = (d1.length_squared(), d1.dot(d2), d2.length_squared());
    let denominator = a * e - b * b;
    let share = if denominator > 0.0 {
        ((b * d2.dot(between) - d1.dot(between) * e) / denominator).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let on_second = second.at(second.nearest_share(first.at(share)));
    let inner = [first.at(first.nearest_share(on_second)), on_second];
    let from_first = |p: DVec3| [p, second.at(second.nearest_share(p))];
    let from_second = |p: DVec3| [first.at(first.nearest_share(p)), p];
    let ends = [
        from_first(first.a),
        from_first(first.b),
        from_second(second.a),
        from_second(second.b),
    ];
    let nearer = |best: [DVec3; 2], other: [DVec3; 2]| {
        let is_nearer = other[0].distance_squared(other[1]) < best[0].distance_squared(best[1]);
        if is_nearer { other } else { best }
    };
    ends.into_iter().fold(inner, nearer)
}

/// The direction in which the capsules are nearest, or overlap least. If the cores meet, the depth is the sum
/// of the radii, in every direction perpendicular to both axes.
fn normal(first: Capsule, second: Capsule, between: DVec3) -> DVec3 {
    let (d1, d2) = (first.axis(), second.axis());
    let size = d1.length() + d2.length() + first.radius + second.radius;
    if between.length() > CAPSULE_TOUCH * size {
        return between.normalize();
    }
    let centers = second.at(0.5) - first.at(0.5);
    let longer = if d1.length() > d2.length() { d1 } else { d2 };
    let axis = longer.normalize_or(DVec3::X);
    let (cross, aside) = (d1.cross(d2), centers.reject_from_normalized(axis));
    let across = if cross.length() > CAPSULE_TOUCH * d1.length() * d2.length() {
        cross.normalize()
    } else if aside.length() > CAPSULE_TOUCH * size {
        aside.normalize()
    } else {
        axis.any_orthonormal_vector()
    };
    if across.dot(centers) < 0.0 {
        -across
    } else {
        across
    }
}

/// The contacts at the ends of the common part of two capsules, seen along the normal, if they lie side by
/// side.
fn common_line(
    [first, second]: [Capsule; 2],
    normal: DVec3,
) -> Option<[Option<CapsuleContact>; 2]> {
    let radii = first.radius + second.radius;
    let along = middle_direction([first.axis(), second.axis()], normal)?;
    let beside = normal.cross(along);
    let ends = [first, second].map(|capsule| [capsule.a, capsule.b].map(|p| p.dot(along)));
    let [low, high] = common_stretch(ends);
    if high - low < SHORT_LINE * first.radius.min(second.radius) {
        return None;
    }
    let core = |capsule: &Capsule, [a, b]: [f64; 2], at| capsule.at((at - a) / (b - a));
    let cores = |at: f64| (core(&first, ends[0], at), core(&second, ends[1], at));
    let beside_first = |at: f64| {
        let (c1, c2) = cores(at);
        beside.dot(c2 - c1)
    };
    let [low, high] = stretch_beside([low, high], beside_first, |_| radii);
    let contact = |at: f64, place| {
        let (c1, c2) = cores(at);
        // The surfaces are nearest where the way between the axes is divided in proportion to the radii.
        let offset = beside.dot(c2 - c1) * first.radius / radii;
        let on_line = c1 + beside * offset;
        let out = first.exit(on_line, normal)?;
        let back = -second.exit(on_line, -normal)?;
        Some(CapsuleContact {
            points: [out, back].map(|t| on_line + normal * t),
            distance: back - out,
            place,
        })
    };
    Some([
        contact(low, Place::FirstEnd),
        contact(high, Place::SecondEnd),
    ])
}
