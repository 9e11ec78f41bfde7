//! Families of pairs on which contacts were once lost or invented: each answer is judged in f64.
//!
//! `FUZZ_SECONDS=600 FUZZ_SEED=7 cargo test --release --test dispatcher families` runs longer.

use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use isa_gjk::internals::tolerance::KEPT_DRIFT;
use parry3d::math::Real;
use parry3d::query::{ClosestPoints, Contact, QueryDispatcher, ShapeCastOptions};
use testkit::budget;
use testkit::families::{FAMILIES, Frame};
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, cold_manifold};
use testkit::oracle::{Solid, signed_distance};
use testkit::pose::ExactPose;
use testkit::report::{Finding, Report};

/// Relative to the larger diameter: what the documentation promises.
const DISTANCE: f64 = 1e-5;
const REGRET: f64 = 2e-5;
/// Relative to the smaller diameter: how far a witness may be off its surface.
const OFF: f64 = 1e-5;
/// The f32 rounding of points, relative to the larger coordinates.
const SINGLE: f64 = 1e-6;
/// Relative to the larger coordinates: nearer than that, shapes touch.
const TOUCHING: f64 = 1e-9;
/// The oracle compares so many pairs of points in a moment.
const SMALL: usize = 2500;

struct Judge<'a> {
    frame: &'a Frame,
    size: f64,
    smaller: f64,
    /// The larger coordinates.
    reach: f64,
    /// Where there is time for it: the exact signed distance if the shapes overlap.
    overlap: Option<f64>,
}

impl<'a> Judge<'a> {
    fn new(frame: &'a Frame) -> Self {
        let [a, b] = frame.solids.each_ref();
        let sizes = [a.diameter(), b.diameter()];
        let farthest = |solid: &Solid| solid.points.iter().map(|p| p.length()).fold(0.0, f64::max);
        let mut judge = Self {
            frame,
            size: sizes[0].max(sizes[1]),
            smaller: sizes[0].min(sizes[1]),
            reach: farthest(a) + farthest(b) + frame.pose.translation.length(),
            overlap: None,
        };
        let is_small = a.points.len() * b.points.len() < SMALL;
        if is_small && judge.face_normals().all(|n| judge.separation(n) < 0.0) {
            judge.overlap = Some(signed_distance(a, b, &frame.pose)).filter(|d| *d < 0.0);
        }
        judge
    }

    fn slack(&self) -> f64 {
        DISTANCE * self.size + SINGLE * self.frame.pose.translation.length()
    }

    /// How far the shapes are apart along a unit direction.
    fn separation(&self, normal: DVec3) -> f64 {
        let [a, b] = &self.frame.solids;
        let pose = &self.frame.pose;
        let in_b = pose.rotation.inverse() * normal;
        normal.dot(pose.translation) - b.support(-in_b) - a.support(normal)
    }

    /// Towards the second shape.
    fn face_normals(&self) -> impl Iterator<Item = DVec3> {
        let normals = |solid: &'a Solid| {
            let normal = |face: &[u32; 3]| {
                let [a, b, c] = face.map(|v| solid.points[v as usize]);
                (b - a).cross(c - a).try_normalize()
            };
            solid.faces().iter().filter_map(normal)
        };
        let [a, b] = &self.frame.solids;
        let rotation = self.frame.pose.rotation;
        normals(a).chain(normals(b).map(move |n| -(rotation * n)))
    }

    /// Whether a contact is the deepest one, and its points are where it says, or have drifted apart by so
    /// much.
    fn judge_deepest(&self, finding: &mut Finding, contact: &Contact, drift: f64) {
        let (normal, dist) = (contact.normal1.as_dvec3(), f64::from(contact.dist));
        let slack = self.slack();
        finding.at_most(
            "regret",
            (dist - self.separation(normal)) / self.size,
            REGRET,
        );
        let best = self.face_normals().map(|n| self.separation(n));
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        finding.at_most("too deep", (best - dist) / slack, 1.0);
        if let Some(exact) = self.overlap {
            finding.at_most("depth", (exact - dist).abs() / slack, 1.0);
        }
        self.judge_points(finding, contact, drift);
    }

    fn judge_points(&self, finding: &mut Finding, contact: &Contact, drift: f64) {
        let [a, b] = &self.frame.solids;
        let (normal, dist) = (contact.normal1.as_dvec3(), f64::from(contact.dist));
        let (p1, p2) = (contact.point1.as_dvec3(), contact.point2.as_dvec3());
        let off = OFF * self.smaller + SINGLE * self.reach;
        let sideways = self.frame.pose.apply(p2) - p1 - normal * dist;
        finding.at_most("point1", a.distance_to_surface(p1) / off, 1.0);
        finding.at_most("point2", b.distance_to_surface(p2) / off, 1.0);
        finding.at_most("sideways", sideways.length() / (off + drift), 1.0);
    }

    fn judge_manifold(
        &self,
        finding: &mut Finding,
        manifold: &Manifold,
        drift: f64,
    ) -> Option<f64> {
        let deepest = manifold.find_deepest_contact()?;
        let contact = Contact::new(
            deepest.local_p1,
            deepest.local_p2,
            manifold.local_n1,
            manifold.local_n2,
            deepest.dist,
        );
        self.judge_deepest(finding, &contact, drift);
        Some(deepest.dist.into())
    }

    /// All answers agree on whether there is a contact, and on its distance.
    fn agree(&self, finding: &mut Finding, answers: &[(&str, Option<f64>)]) {
        let reach = self.frame.prediction - self.slack();
        for window in answers.windows(2) {
            let [(name_1, dist_1), (name_2, dist_2)] = window else {
                continue;
            };
            let alike = match (dist_1, dist_2) {
                (Some(a), Some(b)) => (a - b).abs() <= 2.0 * self.slack(),
                (Some(dist), None) | (None, Some(dist)) => *dist >= reach,
                (None, None) => true,
            };
            finding.require(alike, || {
                format!("{name_1} {dist_1:?}, {name_2} {dist_2:?}")
            });
        }
    }
}

fn check(frame: &Frame, us: &IsaGjkDispatcher, memory: &mut Memory) -> Finding {
    let mut finding = Finding::default();
    let judge = Judge::new(frame);
    let (pose, prediction) = (frame.pose.to_f32(), frame.prediction as Real);
    let shapes = frame.shapes.each_ref();
    let [a, b] = shapes.map(|shape| &**shape);
    let warm = memory.update(us, &pose, shapes, prediction).cloned();
    let drift = KEPT_DRIFT * judge.smaller;
    let warm = judge.judge_manifold(&mut finding, &warm.expect("supported"), drift);
    let cold = cold_manifold(us, &pose, shapes, prediction).expect("supported");
    let cold = judge.judge_manifold(&mut finding, &cold, 0.0);
    let contact = us.contact(&pose, a, b, prediction).expect("supported");
    if let Some(contact) = &contact {
        judge.judge_deepest(&mut finding, contact, 0.0);
    }
    let swapped = ExactPose::inverse(&frame.pose).rounded().to_f32();
    let swapped = us.contact(&swapped, b, a, prediction).expect("supported");
    let distance = us.distance(&pose, a, b).expect("supported").distance;
    let [contact, swapped] = [contact, swapped].map(|c| c.map(|c| f64::from(c.dist)));
    let of_answers = [
        ("warm", warm),
        ("cold", cold),
        ("contact", contact),
        ("swapped", swapped),
    ];
    judge.agree(&mut finding, &of_answers);
    let meet = us.intersection_test(&pose, a, b).expect("supported");
    let closest = us
        .closest_points(&pose, a, b, prediction)
        .expect("supported");
    let is_near = closest == ClosestPoints::Intersecting;
    finding.require(meet.intersecting == is_near, || {
        format!("{meet:?}, {closest:?}")
    });
    finding.require(meet.intersecting == (distance == 0.0), || {
        format!("{meet:?} at a distance of {distance}")
    });
    let overlap = contact.filter(|dist| *dist < 0.0);
    let apart = contact.filter(|dist| *dist > TOUCHING * judge.reach);
    let is_at_odds =
        meet.intersecting && apart.is_some() || !meet.intersecting && overlap.is_some();
    finding.require(!is_at_odds, || format!("{meet:?}, but {contact:?}"));
    let velocity = -pose.translation;
    us.cast_shapes(&pose, velocity, a, b, ShapeCastOptions::default())
        .expect("supported");
    finding
}

#[test]
fn each_family_is_answered_right() {
    let seed = budget::seed();
    let mut report = Report::new("families");
    for turn in budget::turns(150) {
        for (number, (name, make)) in FAMILIES.iter().enumerate() {
            let seed_of_pair = (u128::from(seed) << 64) + (u128::from(turn) << 8) + number as u128;
            let frames = make(&mut Rng::new(seed_of_pair));
            let (us, mut memory) = (IsaGjkDispatcher::default(), Memory::default());
            for (i, frame) in frames.iter().enumerate() {
                let checked = catch_unwind(AssertUnwindSafe(|| check(frame, &us, &mut memory)));
                let finding = checked.unwrap_or_else(|_| {
                    let mut finding = Finding::default();
                    finding.require(false, || "a panic".to_owned());
                    finding
                });
                report.add(
                    name,
                    &format!("seed {seed}, turn {turn}, frame {i}"),
                    finding,
                );
            }
        }
    }
    report.conclude();
}
