//! The crate's first promise: on hulls and poses whose exact signed distance is known, every
//! query of the dispatcher is right, in every regime and in f32.
//!
//! parry's own dispatcher is not: on these cases it reports wrong depths, normals that are far
//! from the best, wrong signs, and now and then no contact at all. A normal is never compared
//! with the published one (ties are common); instead its regret is measured, which is how much
//! separation a better normal would have shown.
//!
//! `cargo test --test dispatcher exact_cases -- --nocapture` prints the table of each regime.

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Real, Vector};
use parry3d::query::{ClosestPoints, QueryDispatcher, Unsupported};
use parry3d::shape::SharedShape;
use testkit::cases::{Case, Hull, built_by_parry, cases, hulls, trajectories};
use testkit::memory::Memory;
use testkit::oracle::{Solid, regret};
use testkit::report::{Finding, Report};

/// Distances and depths, relative to the size of the pair.
const DISTANCE_TOLERANCE: f64 = 1.0e-5;
/// Regret of normals, relative to the size of the pair.
const REGRET_TOLERANCE: f64 = 1.0e-4;
/// Closer than this to touching, relative to the size of the pair, either sign is right.
const MIN_DIRECTED_DISTANCE: f64 = 1.0e-6;

/// A case with the shapes to query, which need not be the published polyhedra themselves.
struct Pair<'a> {
    case: &'a Case,
    solid_a: &'a Solid,
    solid_b: &'a Solid,
    shape_a: SharedShape,
    shape_b: SharedShape,
}

/// What a query says: the signed distance, and a normal from A to B in A's frame.
#[derive(Clone, Copy)]
struct Claim {
    signed_distance: f64,
    normal: DVec3,
}

/// How the shapes of a case are made; not every way suits every case.
type Variant<'a> = fn(&'a Case) -> Option<Pair<'a>>;

impl<'a> Pair<'a> {
    const VARIANTS: [(&'static str, Variant<'a>); 3] = [
        ("", |case| Some(Self::new(case))),
        (", box as cuboid", Self::with_cuboid),
        (", by convex_hull", Self::built_by_parry),
    ];

    fn new(case: &'a Case) -> Self {
        let hull = |name: &str| -> &'static Hull { &hulls()[name] };
        let (a, b) = (hull(&case.shape_a), hull(&case.shape_b));
        Self {
            case,
            solid_a: &a.solid,
            solid_b: &b.solid,
            shape_a: a.shape.clone(),
            shape_b: b.shape.clone(),
        }
    }

    /// The same pair with one unit box as parry's own cuboid, if there is a box in it.
    fn with_cuboid(case: &'a Case) -> Option<Self> {
        let cuboid = SharedShape::cuboid(0.5, 0.5, 0.5);
        let mut pair = Self::new(case);
        if case.shape_a == "box_unit" {
            pair.shape_a = cuboid;
        } else if case.shape_b == "box_unit" {
            pair.shape_b = cuboid;
        } else {
            return None;
        }
        Some(pair)
    }

    /// The same pair as `convex_hull` builds it from the points, where it loses none.
    fn built_by_parry(case: &'a Case) -> Option<Self> {
        let built = built_by_parry();
        let mut pair = Self::new(case);
        pair.shape_a = built.get(&case.shape_a)?.clone();
        pair.shape_b = built.get(&case.shape_b)?.clone();
        Some(pair)
    }

    /// Just far enough for the manifold to hold the deepest point.
    fn manifold_prediction(&self) -> Real {
        (self.case.signed_distance.max(0.0) + 0.01 * self.case.scale) as Real
    }

    fn contact_prediction(&self) -> Real {
        (self.case.signed_distance.max(0.0) + self.case.scale) as Real
    }

    fn distance_limit(&self) -> f64 {
        (DISTANCE_TOLERANCE + self.case.pose_slack()) * self.case.scale
    }

    fn touching_limit(&self) -> f64 {
        (MIN_DIRECTED_DISTANCE + self.case.pose_slack()) * self.case.scale
    }

    /// Measures a claim against the exact answer.
    fn judge(&self, claim: Option<Claim>) -> Finding {
        let mut finding = Finding::default();
        let Some(claim) = claim else {
            finding.require(false, || "no answer".to_owned());
            return finding;
        };
        self.judge_distance(&mut finding, claim.signed_distance);
        let regret = regret(
            self.solid_a,
            self.solid_b,
            &self.case.pose(),
            claim.normal,
            self.case.signed_distance,
        );
        finding.at_most(
            "regret/scale",
            regret / self.case.scale,
            REGRET_TOLERANCE + self.case.pose_slack(),
        );
        finding
    }

    /// Measures a signed distance against the exact one.
    fn judge_distance(&self, finding: &mut Finding, claimed: f64) {
        let exact = self.case.signed_distance;
        finding.at_most(
            "error/scale",
            (claimed - exact).abs() / self.case.scale,
            DISTANCE_TOLERANCE + self.case.pose_slack(),
        );
        let same_side = (claimed > 0.0) == (exact > 0.0);
        let either_side = exact.abs() <= self.touching_limit();
        finding.require(same_side || either_side, || {
            format!("wrong sign: {claimed:e} for {exact:e}")
        });
    }

    fn check_distance(&self, dispatcher: &IsaGjkDispatcher) -> Finding {
        let mut finding = Finding::default();
        let answer =
            dispatcher.distance(&self.case.pose().to_f32(), &*self.shape_a, &*self.shape_b);
        match answer {
            Ok(answer) => finding.at_most(
                "error/scale",
                (f64::from(answer.distance) - self.case.signed_distance.max(0.0)).abs()
                    / self.case.scale,
                DISTANCE_TOLERANCE + self.case.pose_slack(),
            ),
            Err(Unsupported) => finding.require(false, || "no answer".to_owned()),
        }
        finding
    }

    fn check_intersection_test(&self, dispatcher: &IsaGjkDispatcher) -> Finding {
        let mut finding = Finding::default();
        let exact = self.case.signed_distance;
        let answer = dispatcher
            .intersection_test(&self.case.pose().to_f32(), &*self.shape_a, &*self.shape_b)
            .map(|answer| answer.intersecting);
        finding.require(
            answer == Ok(exact <= 0.0) || (answer.is_ok() && exact.abs() <= self.touching_limit()),
            || format!("{answer:?} for {exact:e}"),
        );
        finding
    }

    /// Within reach, the two points are in their shapes and as close as the shapes are; out of
    /// reach, the answer says so.
    fn check_closest_points(&self, dispatcher: &IsaGjkDispatcher) -> Finding {
        let mut finding = Finding::default();
        let exact = self.case.signed_distance;
        let touching = exact.abs() <= self.touching_limit();
        let ask = |reach: f64| {
            dispatcher.closest_points(
                &self.case.pose().to_f32(),
                &*self.shape_a,
                &*self.shape_b,
                reach as Real,
            )
        };
        match ask(exact.max(0.0) + 0.01 * self.case.scale) {
            Ok(ClosestPoints::WithinMargin(p1, p2)) => {
                finding.require(exact > 0.0 || touching, || "points inside".to_owned());
                self.judge_witnesses(&mut finding, p1, p2, exact.max(0.0));
            }
            Ok(ClosestPoints::Intersecting) => {
                finding.require(exact <= 0.0 || touching, || "says intersecting".to_owned());
            }
            other => finding.require(false, || format!("{other:?}")),
        }
        if exact > 2.0 * self.distance_limit() {
            let short = ask(0.5 * exact);
            finding.require(short == Ok(ClosestPoints::Disjoint), || {
                format!("{short:?} out of reach")
            });
        }
        finding
    }

    /// Checks a pair of closest points, each in the frame of its own shape.
    fn judge_witnesses(&self, finding: &mut Finding, p1: Vector, p2: Vector, distance: f64) {
        let (p1, p2) = (p1.as_dvec3(), p2.as_dvec3());
        let apart = self.case.pose().apply(p2).distance(p1);
        finding.at_most(
            "error/scale",
            (apart - distance).abs() / self.case.scale,
            DISTANCE_TOLERANCE + self.case.pose_slack(),
        );
        let outside = self.solid_a.outside(p1).max(self.solid_b.outside(p2));
        finding.at_most(
            "witness outside/scale",
            outside.max(0.0) / self.case.scale,
            DISTANCE_TOLERANCE,
        );
    }

    fn contact(&self, dispatcher: &IsaGjkDispatcher) -> Option<Claim> {
        let contact = dispatcher
            .contact(
                &self.case.pose().to_f32(),
                &*self.shape_a,
                &*self.shape_b,
                self.contact_prediction(),
            )
            .ok()??;
        Some(Claim {
            signed_distance: contact.dist.into(),
            normal: contact.normal1.as_dvec3(),
        })
    }

    fn contact_swapped(&self, dispatcher: &IsaGjkDispatcher) -> Option<Claim> {
        let pose = self.case.pose();
        let contact = dispatcher
            .contact(
                &pose.inverse().to_f32(),
                &*self.shape_b,
                &*self.shape_a,
                self.contact_prediction(),
            )
            .ok()??;
        Some(Claim {
            signed_distance: contact.dist.into(),
            normal: pose.rotation * -contact.normal1.as_dvec3(),
        })
    }

    /// The deepest point of the manifold that starts from memory.
    fn manifold(&self, dispatcher: &IsaGjkDispatcher, memory: &mut Memory) -> Option<Claim> {
        let manifold = memory.update(
            dispatcher,
            &self.case.pose().to_f32(),
            [&self.shape_a, &self.shape_b],
            self.manifold_prediction(),
        )?;
        Some(Claim {
            signed_distance: manifold.find_deepest_contact()?.dist.into(),
            normal: manifold.local_n1.as_dvec3(),
        })
    }

    /// Every route that needs no history.
    fn check_cold(&self, report: &mut Report, variant: &str) {
        let dispatcher = &IsaGjkDispatcher::default();
        let findings = [
            ("distance", self.check_distance(dispatcher)),
            (
                "intersection_test",
                self.check_intersection_test(dispatcher),
            ),
            ("closest_points", self.check_closest_points(dispatcher)),
            ("contact", self.judge(self.contact(dispatcher))),
            (
                "contact swapped",
                self.judge(self.contact_swapped(dispatcher)),
            ),
            (
                "manifold, cold",
                self.judge(self.manifold(dispatcher, &mut Memory::default())),
            ),
        ];
        for (route, finding) in findings {
            report.add(&format!("{route}{variant}"), &self.case.id, finding);
        }
    }
}

/// Every case of a regime, through every route that needs no history.
fn check_regime(regime: &str) {
    let mut report = Report::new(regime);
    for case in cases(regime) {
        for (variant, pair) in Pair::VARIANTS {
            if let Some(pair) = pair(&case) {
                pair.check_cold(&mut report, variant);
            }
        }
    }
    report.conclude();
}

#[test]
fn far() {
    check_regime("far");
}

#[test]
fn near() {
    check_regime("near");
}

#[test]
fn touching() {
    check_regime("touching");
}

#[test]
fn shallow() {
    check_regime("shallow");
}

#[test]
fn deep() {
    check_regime("deep");
}

#[test]
fn inside() {
    check_regime("inside");
}

#[test]
fn symmetric() {
    check_regime("symmetric");
}

#[test]
fn identical() {
    check_regime("identical");
}

#[test]
fn trajectories_cold() {
    check_regime("trajectories");
}

/// One memory kept from frame to frame, as rapier keeps it.
fn check_warm<'a>(report: &mut Report, route: &str, trajectory: &'a [Case], pair: Variant<'a>) {
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    for pair in trajectory.iter().filter_map(pair) {
        let warm = pair.manifold(&dispatcher, &mut memory);
        let cold = pair.manifold(&dispatcher, &mut Memory::default());
        let mut finding = pair.judge(warm);
        if let (Some(warm), Some(cold)) = (warm, cold) {
            finding.at_most(
                "warm-cold/scale",
                (warm.signed_distance - cold.signed_distance).abs() / pair.case.scale,
                DISTANCE_TOLERANCE,
            );
        }
        report.add(route, &pair.case.id, finding);
    }
}

#[test]
fn trajectories_warm() {
    let mut report = Report::new("trajectories, warm");
    for trajectory in trajectories() {
        for (variant, pair) in Pair::VARIANTS {
            let route = format!("manifold, warm{variant}");
            check_warm(&mut report, &route, &trajectory, pair);
        }
    }
    report.conclude();
}
