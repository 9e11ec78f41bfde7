//! Cylinders and cones at rest keep their contacts, are as right as without a past, and cost little.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Rotation, Vector};
use testkit::curved::{Body, Judge};
use testkit::generate::Rng;
use testkit::memory::{Memory, kept};
use testkit::pair::{PREDICTION, hull, trajectory};
use testkit::pose::ExactPose;

/// The promise, as a share of the smaller diameter.
const PROMISE: f64 = 1e-5;
const FRAMES: usize = 30;

/// Their tops are level, 0.5 above their origins.
fn grounds() -> Vec<Body> {
    let half = Vector::new(0.4, 0.5, 0.6);
    let corner = |i: usize| {
        let side = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        half * Vector::new(side(0), side(1), side(2))
    };
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    let around = |i: u8| {
        let angle = f32::from(i % 24) * std::f32::consts::TAU / 24.0;
        Vector::new(
            0.5 * angle.cos(),
            if i < 24 { 0.5 } else { -0.5 },
            0.5 * angle.sin(),
        )
    };
    let of_24_sides: Vec<Vector> = (0..48).map(around).collect();
    let level = |x: Real, z: Real| Vector::new(x, 0.5, z);
    vec![
        Body::cuboid(half, 0.0),
        Body::cuboid(Vector::new(0.3, 0.4, 0.5), 0.1),
        Body::hull(&corners, 0.0).expect("a solid"),
        Body::hull(&of_24_sides, 0.0).expect("a prism"),
        Body::cylinder(0.5, 0.4, 0.0),
        Body::triangle([level(-1.0, 1.0), level(1.0, 1.0), level(0.0, -1.3)], 0.0),
    ]
}

/// Bodies, how they are turned, and how far they reach down then.
fn bodies() -> Vec<(Body, Rotation, Real)> {
    let on_its_side = Rotation::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let lean = (0.25_f32).atan2(0.6);
    let on_its_slant = Rotation::from_rotation_x(std::f32::consts::FRAC_PI_2 + lean);
    vec![
        (Body::cylinder(0.3, 0.25, 0.0), Rotation::IDENTITY, 0.3),
        (Body::cylinder(0.3, 0.4, 0.0), Rotation::IDENTITY, 0.3),
        (Body::cylinder(0.3, 0.25, 0.05), Rotation::IDENTITY, 0.35),
        (Body::cylinder(0.3, 0.25, 0.0), on_its_side, 0.25),
        (Body::cylinder(0.3, 0.25, 0.05), on_its_side, 0.3),
        (Body::cone(0.3, 0.25, 0.0), Rotation::IDENTITY, 0.3),
        (Body::cone(0.3, 0.25, 0.0), on_its_slant, 0.3 * lean.sin()),
    ]
}

fn exact(pose: &Pose) -> ExactPose {
    ExactPose {
        rotation: pose.rotation.as_dquat().normalize(),
        translation: pose.translation.as_dvec3(),
    }
}

/// By how much a body trembles, in metres and radians, and at most how many support points an update then takes.
#[derive(Clone, Copy)]
struct Tremble {
    noise: f64,
    supports: f64,
}

/// Updates a pair that trembles around a pose, and checks its answers, and its cost.
fn tremble(
    [ground, body]: [&Body; 2],
    place: Vector,
    turn: Rotation,
    limits: Tremble,
    rng: &mut Rng,
) {
    let Tremble {
        noise: size,
        supports: most,
    } = limits;
    let what = format!("{} on {} at {place}, by {size}", body.name, ground.name);
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let mut supports = 0;
    for frame in 0..FRAMES {
        let mut noise = || (rng.direction() * size).as_vec3();
        let spin = Rotation::from_scaled_axis(noise());
        let pose = Pose::from_parts(place + noise(), spin * turn);
        let before = dispatcher.stats();
        let shapes = [&ground.shape, &body.shape];
        let manifold = memory.update(&dispatcher, &pose, shapes, PREDICTION);
        if frame > 0 {
            supports += dispatcher.stats().since(&before).supports;
        }
        if frame % 10 == 9 {
            let judge = Judge::new([ground, body], exact(&pose));
            let mut faults = judge.manifold(manifold, PREDICTION.into());
            // Contacts that stay are off their common line by the drift that they may have.
            faults.gap = 0.0;
            assert!(faults.are_within(PROMISE), "{what}: {faults:?}");
        }
    }
    let kept = kept(&dispatcher.stats());
    assert!(kept + 2 >= FRAMES as u64, "{what}: kept {kept} times");
    let mean = supports as f64 / (FRAMES - 1) as f64;
    assert!(mean < most, "{what}: {mean} supports per update");
}

/// How far aside, and how far apart.
const PLACES: [(Real, Real); 4] = [(0.0, 1e-3), (0.02, -1e-3), (0.3, -1e-3), (0.1, -2e-2)];

/// Shaken bodies lean by more than the tolerance of a proof: the deepest place is that of a rim, a corner or the end of
/// a line, or where an outline crosses another one.
const FLAT: [Tremble; 2] = [
    Tremble {
        noise: 1e-6,
        supports: 1.5,
    },
    Tremble {
        noise: 2e-5,
        supports: 5.0,
    },
];

#[test]
fn bodies_at_rest_keep_their_contacts_at_little_cost() {
    let mut rng = Rng::new(401);
    for ground in grounds() {
        for (body, turn, reach) in bodies() {
            for (aside, gap) in PLACES {
                let place = Vector::new(aside, 0.5 + reach + gap, 0.04);
                let turn = Rotation::from_rotation_y(0.3) * turn;
                for limits in FLAT {
                    tremble([&ground, &body], place, turn, limits, &mut rng);
                }
            }
        }
    }
}

/// On the side of a cylinder that lies.
#[test]
fn logs_at_rest_keep_their_contacts_at_little_cost() {
    let mut rng = Rng::new(402);
    let ground = Body::cylinder(0.5, 0.4, 0.0);
    let lean = (0.25_f32).atan2(0.6);
    let ends = [-0.3, 0.3].map(|y| Vector::Y * y);
    let logs = [
        (Body::cylinder(0.3, 0.25, 0.0), 0.0, 0.25),
        (Body::cylinder(0.3, 0.25, 0.05), 0.0, 0.3),
        (Body::capsule(ends, 0.2), 0.0, 0.2),
        (Body::cone(0.3, 0.25, 0.0), lean, 0.3 * lean.sin()),
    ];
    let limits = [1e-6, 2e-5].map(|noise| Tremble {
        noise,
        supports: 12.0,
    });
    for (body, lean, reach) in logs {
        for (aside, gap) in PLACES {
            let place = Vector::new(0.0, aside, 0.4 + reach + gap);
            let turn = Rotation::from_rotation_x(-lean);
            for limits in limits {
                tremble([&ground, &body], place, turn, limits, &mut rng);
            }
        }
    }
}

/// Every edge beside the normal was tried, by a search of its own.
#[test]
fn no_update_of_a_hull_takes_long() {
    for curved in [Body::cylinder(0.5, 0.4, 0.0), Body::cone(0.5, 0.4, 0.0)] {
        let shapes = [hull(60, 1), curved.shape.clone()];
        for gap in [0.005, -0.001, -0.05] {
            let dispatcher = IsaGjkDispatcher::default();
            let mut memory = Memory::default();
            for pose in trajectory(&shapes, gap, 1.0) {
                let before = dispatcher.stats();
                memory.update(&dispatcher, &pose, [&shapes[0], &shapes[1]], PREDICTION);
                let cost = dispatcher.stats().since(&before);
                let most = cost.supports.max(3 * cost.iterations);
                assert!(most <= 150, "{} at {gap}: {cost:?}", curved.name);
            }
        }
    }
}
