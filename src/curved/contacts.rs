//! The choice of the places of a patch that become contacts.
//!
//! The rule is that of `manifold/reduce.rs`, except that low places come first only where both pieces are polygons. That
//! one works in f32 on four corners at once, which only pays for the many corners of polygons. A curved patch has few
//! places, in f64, and each comes with its points and features.

use glam::{DVec2, DVec3};

use super::patch::{ContactPlace, Patch};
use crate::manifold::{Contacts, MAX_POINTS};
use crate::pose::RelativePose;
use crate::query::Feature;
use crate::simd::f32x4;
use crate::support::FaceId;
use crate::tolerance::SAME_GAP;
use crate::tuning::{CORNER_RISE, SAME_POINT};

/// Up to four contacts of a patch. The deepest place comes first, then places within `max_distance` that are
/// spread out, then the nearest of the others. A query found that the shapes, with their borders, are `least`
/// apart at `on_1` on shape 1. This point becomes the first contact if the patch has no place as deep.
/// `scale` is the radius of the smaller shape.
pub fn contacts(
    patch: &Patch,
    pose: &RelativePose,
    (on_1, least): (DVec3, f64),
    max_distance: f64,
    scale: f64,
) -> Contacts {
    let witness = ContactPlace {
        on_1,
        on_2: on_1 + patch.normal() * least,
        distance: least,
        features: [Feature::Face(FaceId::default()); 2],
    };
    let as_deep = |place: &&ContactPlace| place.distance <= least + SAME_GAP * scale;
    let first = patch.deepest().filter(as_deep).unwrap_or(&witness);
    let mut chosen = Chosen {
        same: f64::from(SAME_POINT) * scale,
        normal: patch.normal(),
        places: [first; MAX_POINTS],
        count: 1,
    };
    let low_first = patch.is_of_polygons() && patch.places.len() > MAX_POINTS;
    let rise = if low_first { CORNER_RISE.into() } else { 0.0 };
    chosen.spread(&patch.places, max_distance, rise);
    chosen.fill(&patch.places);
    chosen.contacts(pose, least)
}

/// Places in the contact plane, relative to one of them.
struct PlanarPlaces<'a> {
    places: &'a [ContactPlace],
    max_distance: f64,
    origin: DVec3,
    axes: [DVec3; 2],
    /// By how much the distance grows from the origin, where it is `level`, towards other places.
    slope: DVec2,
    level: f64,
    /// How much nearer a place counts for its height above that.
    rise: f64,
}

impl<'a> PlanarPlaces<'a> {
    fn at(&self, place: &ContactPlace) -> DVec2 {
        let offset = place.on_1 - self.origin;
        DVec2::from(self.axes.map(|axis| offset.dot(axis)))
    }

    /// The place within reach with the greatest measure, if that is above `least`. The measure is the distance from
    /// something times `length`.
    fn farthest(
        &self,
        length: f64,
        least: f64,
        measure: impl Fn(DVec2) -> f64,
    ) -> Option<&'a ContactPlace> {
        let mut best = (f64::NEG_INFINITY, None);
        for place in self.places {
            let at = self.at(place);
            let far = measure(at);
            let height = place.distance - self.level - self.slope.dot(at);
            let value = far - self.rise * length * height.max(0.0);
            if place.distance <= self.max_distance && far > least && value > best.0 {
                best = (value, Some(place));
            }
        }
        best.1
    }
}

/// Twice the area by which `p` extends the triangle of the origin, `a` and `b`, beyond one of the edges at `b`.
fn added_area(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let turn = a.perp_dot(b).signum();
    let beyond_ab = (p - a).perp_dot(b - a) * turn;
    let beyond_bo = p.perp_dot(-b) * turn;
    beyond_ab.max(beyond_bo)
}

/// The contacts chosen so far. The first one fills the places that are free.
struct Chosen<'a> {
    same: f64,
    normal: DVec3,
    places: [&'a ContactPlace; MAX_POINTS],
    count: usize,
}

impl<'a> Chosen<'a> {
    fn push(&mut self, place: &'a ContactPlace) {
        if self.count < MAX_POINTS {
            self.places[self.count] = place;
            self.count += 1;
        }
    }

    fn is_new(&self, place: &ContactPlace) -> bool {
        let is_there = |other: &&ContactPlace| {
            let offset = place.on_1 - other.on_1;
            let along = offset.dot(self.normal);
            offset.length_squared() - along * along <= self.same * self.same
        };
        !self.places[..self.count].iter().any(is_there)
    }

    /// Adds places that span a large area with the first one: the farthest from it, and the farthest from the
    /// line through both, on either side. If one side is empty, the place that extends the triangle most. Each counts
    /// as nearer by `rise` times its height.
    fn spread(&mut self, places: &'a [ContactPlace], max_distance: f64, rise: f64) {
        let u = self.normal.any_orthonormal_vector();
        let mut projected = PlanarPlaces {
            places,
            max_distance,
            origin: self.places[0].on_1,
            axes: [u, self.normal.cross(u)],
            slope: DVec2::ZERO,
            level: self.places[0].distance,
            rise,
        };
        let Some(far) = projected.farthest(1.0, self.same, DVec2::length) else {
            return;
        };
        let line = projected.at(far);
        let length = line.length();
        projected.slope = line * ((far.distance - projected.level) / (length * length));
        let beyond = |measure: &dyn Fn(DVec2) -> f64| {
            projected.farthest(length, self.same * length, measure)
        };
        let sides = [1.0, -1.0].map(|sign| beyond(&|p| sign * line.perp_dot(p)));
        let last = match sides {
            [Some(side), None] | [None, Some(side)] => {
                beyond(&|p| added_area(p, line, projected.at(side)))
            }
            _ => None,
        };
        self.push(far);
        sides.into_iter().flatten().for_each(|side| self.push(side));
        if let Some(last) = last.filter(|last| self.is_new(last)) {
            self.push(last);
        }
    }

    /// Adds the nearest of the remaining places while there is room.
    fn fill(&mut self, places: &'a [ContactPlace]) {
        while self.count < MAX_POINTS {
            let left = places.iter().filter(|place| self.is_new(place));
            let Some(next) = left.min_by(|a, b| a.distance.total_cmp(&b.distance)) else {
                return;
            };
            self.push(next);
        }
    }

    fn contacts(&self, pose: &RelativePose, least: f64) -> Contacts {
        let [mut on_1, mut on_2] = [[[0.0; MAX_POINTS]; 3]; 2];
        let mut distances = [0.0; MAX_POINTS];
        // perf: maps over arrays of places are calls, which took a tenth of a heap's updates.
        for (lane, place) in self.places.iter().enumerate() {
            set_lane(&mut on_1, lane, place.on_1);
            set_lane(&mut on_2, lane, pose.point_to_2(place.on_2));
            distances[lane] = place.distance.max(least) as f32;
        }
        let [a, b, c, d] = self.places;
        Contacts {
            on_1: on_1.map(f32x4::new),
            on_2: on_2.map(f32x4::new),
            distance: f32x4::new(distances),
            features: [a.features, b.features, c.features, d.features],
            len: self.count,
        }
    }
}

fn set_lane(points: &mut [[f32; MAX_POINTS]; 3], lane: usize, p: DVec3) {
    let [x, y, z] = points;
    [x[lane], y[lane], z[lane]] = p.as_vec3().to_array();
}
