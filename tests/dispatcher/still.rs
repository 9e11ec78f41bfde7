//! Pairs at rest: a distance that was certified tells what contacts show until the pair has moved too far.
//! Whether it is known must not show in a bit.

use isa_gjk::{IsaGjkDispatcher, Stage};
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::shape::SharedShape;
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, cold_manifold};
use testkit::scenes::hulls;

const PREDICTION: Real = 0.02;

/// By how much a depth may differ from that of a cold query, as a share of the smaller radius: what contacts that
/// are left as they are may show, and the gaps of both queries.
const OFF: f64 = 8e-6 + 2e-6;

/// A body on a ground.
struct Pair {
    name: String,
    /// The ground comes first, or the body.
    shapes: [SharedShape; 2],
    is_reversed: bool,
    /// The height of the body over the ground's origin.
    height: Real,
    radius: Real,
}

impl Pair {
    /// The body, moved and turned a little.
    fn pose(&self, turn: Vector, by: Vector) -> Pose {
        let place = Vector::new(0.2, self.height, -0.1) * self.radius;
        let rotation = Rotation::from_scaled_axis(turn) * Rotation::from_rotation_y(0.3);
        let pose = Pose::from_parts(place + by, rotation);
        if self.is_reversed {
            pose.inverse()
        } else {
            pose
        }
    }

    fn update<'m>(
        &self,
        memory: &'m mut Memory,
        dispatcher: &IsaGjkDispatcher,
        pose: &Pose,
    ) -> &'m Manifold {
        let [first, second] = &self.shapes;
        let manifold = memory.update(dispatcher, pose, [first, second], PREDICTION);
        manifold.expect("supported")
    }
}

/// Their tops are at the height of their origins.
fn grounds() -> [(&'static str, SharedShape); 5] {
    let corner = |i: u32| {
        let side = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        Vector::new(4.0 * side(0), 0.5 * side(1) - 0.5, 4.0 * side(2))
    };
    let slab: Vec<Vector> = (0..8).map(corner).collect();
    let [a, b, c] = [(-9.0, 5.0), (9.0, 5.0), (0.0, -9.0)].map(|(x, z)| Vector::new(x, 0.0, z));
    [
        ("slab", SharedShape::convex_hull(&slab).expect("a slab")),
        ("cuboid", SharedShape::cuboid(4.0, 1e-4, 4.0)),
        ("half-space", SharedShape::halfspace(Vector::Y)),
        ("triangle", SharedShape::triangle(a, b, c)),
        ("disc", SharedShape::cylinder(1e-4, 4.0)),
    ]
}

/// They reach half of their radius downwards.
fn bodies(radius: Real) -> [(&'static str, SharedShape); 6] {
    let half = 0.5 * radius;
    let prism = |sides| hulls::prism(sides, radius, half).expect("a prism");
    let corners = [(1.0, 1.0), (-1.0, 1.0), (0.0, -1.0)];
    let mut corners = corners
        .map(|(x, z)| Vector::new(x, -0.4, z) * radius)
        .to_vec();
    corners.push(Vector::Y * radius);
    let round = SharedShape::round_convex_hull(&corners, 0.1 * radius);
    [
        ("prism of 4", prism(4)),
        ("prism of 7", prism(7)),
        ("prism of 64", prism(64)),
        ("rounded hull", round.expect("a solid")),
        ("cylinder", SharedShape::cylinder(half, radius)),
        ("cone", SharedShape::cone(half, radius)),
    ]
}

/// All pairs of which we answer contacts, in either order.
fn pairs(radius: Real) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (ground_name, ground) in grounds() {
        for (body_name, body) in bodies(radius) {
            let is_curved = matches!(body_name, "cylinder" | "cone");
            if is_curved && ground.as_halfspace().is_some() {
                continue;
            }
            let thickness = if ground.as_halfspace().is_some()
                || ground_name == "slab"
                || ground_name == "triangle"
            {
                0.0
            } else {
                1e-4
            };
            for is_reversed in [false, true] {
                let mut shapes = [ground.clone(), body.clone()];
                if is_reversed {
                    shapes.reverse();
                }
                pairs.push(Pair {
                    name: format!("{body_name} on {ground_name}, reversed: {is_reversed}"),
                    shapes,
                    is_reversed,
                    height: 0.499 + thickness / radius,
                    radius,
                });
            }
        }
    }
    pairs
}

fn deepest(manifold: &Manifold) -> f64 {
    manifold
        .find_deepest_contact()
        .expect("a contact")
        .dist
        .into()
}

/// Every bit of a manifold that a later frame or a solver reads.
fn bits(manifold: &Manifold) -> Vec<u32> {
    let vector = |v: Vector| v.to_array().map(f32::to_bits);
    let normals = [manifold.local_n1, manifold.local_n2];
    let points = manifold.points.iter().flat_map(|point| {
        let ids = [point.dist.to_bits(), point.fid1.0, point.fid2.0];
        let places = [point.local_p1, point.local_p2];
        places.into_iter().flat_map(vector).chain(ids)
    });
    normals.into_iter().flat_map(vector).chain(points).collect()
}

fn still(dispatcher: &IsaGjkDispatcher) -> u64 {
    dispatcher.stats().answered[Stage::Still as usize]
}

/// Bodies drift, slowly in all directions: what one frame adds is far below the limit, and all of them are far
/// above. No depth is ever off by more than the tolerance.
#[test]
fn what_drifts_slowly_is_as_deep_as_a_cold_query_finds_it() {
    const FRAMES: usize = 400;
    let mut rng = Rng::new(501);
    let judge = IsaGjkDispatcher::default();
    let mut worst = 0.0_f64;
    for radius in [0.02, 1.0] {
        for pair in pairs(radius) {
            let dispatcher = IsaGjkDispatcher::default();
            let mut memory = Memory::default();
            let step = [2e-7, 4e-7 * f64::from(radius)].map(|step| rng.direction() * step);
            for frame in 0..FRAMES {
                let [turn, by] = step.map(|step| (step * frame as f64).as_vec3());
                let pose = pair.pose(turn, by);
                let warm = deepest(pair.update(&mut memory, &dispatcher, &pose));
                if frame % 7 == 0 {
                    let [first, second] = &pair.shapes;
                    let cold = cold_manifold(&judge, &pose, [first, second], PREDICTION);
                    let cold = deepest(&cold.expect("supported"));
                    let off = (warm - cold).abs() / f64::from(radius);
                    assert!(off < OFF, "{}, frame {frame}: off by {off}", pair.name);
                    worst = worst.max(off);
                }
            }
            let still = still(&dispatcher);
            assert!(
                5 * still > FRAMES as u64,
                "{}: only {still} still",
                pair.name
            );
        }
    }
    println!("off by {worst:.1e} radii at most");
}

/// Bodies tremble. Certificates are kept by thread: all updates are in one, or each is in a new one.
#[test]
fn whether_a_certificate_is_there_does_not_show() {
    const FRAMES: usize = 60;
    let run = |forgets: bool| {
        let mut rng = Rng::new(502);
        let mut states = Vec::new();
        let dispatcher = IsaGjkDispatcher::default();
        for pair in pairs(0.1) {
            let mut memory = Memory::default();
            for frame in 0..FRAMES {
                let noise = [1e-8, 1e-7, 3e-7, 1e-6, 1e-5][frame / 5 % 5];
                let [turn, by] = [(); 2].map(|()| (rng.direction() * noise).as_vec3());
                let pose = pair.pose(turn, by * pair.radius);
                let mut update = || bits(pair.update(&mut memory, &dispatcher, &pose));
                let state = if forgets {
                    std::thread::scope(|scope| scope.spawn(update).join().expect("no panic"))
                } else {
                    update()
                };
                states.push(state);
            }
        }
        (states, still(&dispatcher))
    };
    let (states, times) = run(false);
    let (forgetful, never) = run(true);
    assert_eq!(never, 0);
    let updates = states.len();
    assert!(
        2 * times > updates as u64,
        "only {times} of {updates} still"
    );
    let first = states.iter().zip(&forgetful).position(|(a, b)| a != b);
    assert_eq!(first, None, "of {updates} updates");
}

/// It is held at both ends of its way, which are farther apart than a certificate reaches.
#[test]
fn a_body_that_goes_to_and_fro_is_queried_at_both_ends_once() {
    const FRAMES: usize = 20;
    for pair in pairs(1.0) {
        let dispatcher = IsaGjkDispatcher::default();
        let mut memory = Memory::default();
        for frame in 0..FRAMES {
            let by = Vector::X * [0.0, 8e-6][frame % 2];
            pair.update(&mut memory, &dispatcher, &pair.pose(Vector::ZERO, by));
        }
        let queried = FRAMES as u64 - still(&dispatcher);
        assert!(queried <= 4, "{}: queried {queried} times", pair.name);
    }
}

/// Another shape lies where the first one lay. The manifold is the same.
#[test]
fn a_certificate_is_only_that_of_its_shapes() {
    for (pair, thicker) in pairs(1.0).iter().zip(pairs(1.001)) {
        let dispatcher = IsaGjkDispatcher::default();
        let mut memory = Memory::default();
        let pose = pair.pose(Vector::ZERO, Vector::ZERO);
        for _ in 0..4 {
            pair.update(&mut memory, &dispatcher, &pose);
        }
        let before = still(&dispatcher);
        assert!(before >= 2, "{}", pair.name);
        let warm = deepest(thicker.update(&mut memory, &dispatcher, &pose));
        let [first, second] = &thicker.shapes;
        let cold = cold_manifold(&dispatcher, &pose, [first, second], PREDICTION);
        let off = (warm - deepest(&cold.expect("supported"))).abs();
        assert!(off < OFF, "{}: {off}", pair.name);
        assert_eq!(still(&dispatcher), before, "{}", pair.name);
    }
}
