//! Pairs that are apart, and hardly move, need no look at their vertices. That changes no answer.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::shape::{RoundShape, SharedShape};
use testkit::generate::Rng;
use testkit::memory::{Manifold, Memory, cold_manifold};
use testkit::scenes::hulls;

const PREDICTION: Real = 0.02;

/// A way past another shape, or into it, in frames of any size.
fn wanderings(rng: &mut Rng) -> Vec<Pose> {
    let [from, to] = [(); 2].map(|()| rng.direction() * rng.range(0.2, 2.5));
    let axis = rng.direction();
    let turn = rng.range(0.0, 3.0);
    let jump = 10_f64.powf(rng.range(-6.0, -1.0));
    let frames = 80;
    (0..frames)
        .map(|frame| {
            let share = f64::from(frame) / f64::from(frames);
            let place = from.lerp(to, share) + rng.direction() * jump;
            let turn = axis * (turn * share) + rng.direction() * jump;
            Pose::from_parts(place.as_vec3(), Rotation::from_scaled_axis(turn.as_vec3()))
        })
        .collect()
}

fn update(shapes: [&SharedShape; 2], pose: &Pose, memory: &mut Memory) -> Manifold {
    let dispatcher = IsaGjkDispatcher::default();
    let manifold = memory.update(&dispatcher, pose, shapes, PREDICTION);
    manifold.expect("supported").clone()
}

fn bits(manifold: &Manifold) -> String {
    let points = manifold.points.iter();
    let points: Vec<_> = points
        .map(|p| (p.local_p1, p.local_p2, p.dist, p.fid1, p.fid2))
        .collect();
    format!("{:?} {:?} {points:?}", manifold.local_n1, manifold.local_n2)
}

/// A thread that has just begun, or trimmed its memory, has no proof.
#[test]
fn manifolds_do_not_depend_on_what_a_thread_has_proved() {
    let mut rng = Rng::new(17);
    for _ in 0..60 {
        let shapes = [(); 2].map(|()| {
            let corners = rng.count(4, 90);
            let size = rng.range(0.3, 1.2);
            rng.hull(corners, size).shape
        });
        let poses = wanderings(&mut rng);
        let follow = |forgets: bool| {
            let mut memory = Memory::default();
            let frames = poses.iter().map(|pose| {
                if forgets {
                    IsaGjkDispatcher::default().trim();
                }
                bits(&update([&shapes[0], &shapes[1]], pose, &mut memory))
            });
            frames.collect::<Vec<_>>()
        };
        assert_eq!(follow(false), follow(true));
    }
}

#[test]
fn a_contact_is_found_in_the_frame_in_which_it_begins() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut rng = Rng::new(18);
    let mut found = 0;
    for _ in 0..60 {
        let shapes = [(); 2].map(|()| {
            let corners = rng.count(4, 40);
            let size = rng.range(0.3, 1.2);
            rng.hull(corners, size).shape
        });
        let shapes = [&shapes[0], &shapes[1]];
        let mut memory = Memory::default();
        for pose in wanderings(&mut rng) {
            let warm = update(shapes, &pose, &mut memory);
            let cold = cold_manifold(&dispatcher, &pose, shapes, PREDICTION).expect("supported");
            let deepest = |m: &Manifold| m.points.iter().map(|p| p.dist).fold(Real::MAX, Real::min);
            // At the very limit of the prediction, either is right.
            if warm.points.is_empty() != cold.points.is_empty() {
                let nearest = deepest(&warm).min(deepest(&cold));
                assert!(nearest > 0.999 * PREDICTION, "{nearest}");
            }
            found += usize::from(!cold.points.is_empty());
        }
    }
    assert!(found > 100, "{found} contacts");
}

/// The pose turns the second shape, whichever of the two the kernels take first.
#[test]
fn a_large_hull_that_turns_meets_what_is_beside_it() {
    let hull = hulls::cuboid(Vector::splat(1.0)).expect("a box");
    let small = [
        SharedShape::ball(0.01),
        SharedShape::cuboid(0.01, 0.01, 0.01),
        SharedShape::capsule(Vector::ZERO, Vector::X * 0.01, 0.01),
        hulls::cuboid(Vector::splat(0.01)).expect("a box"),
    ];
    let dispatcher = IsaGjkDispatcher::default();
    for other in &small {
        for is_first in [true, false] {
            let mut memory = Memory::default();
            let mut touches = |angle: Real| {
                let of_hull = Pose::from_parts(Vector::Y * -1.05, Rotation::from_rotation_z(angle));
                let (shapes, pose) = match is_first {
                    true => ([other, &hull], of_hull),
                    false => ([&hull, other], of_hull.inverse()),
                };
                let manifold = memory.update(&dispatcher, &pose, shapes, PREDICTION);
                !manifold.expect("supported").points.is_empty()
            };
            assert!([0.0; 3].map(&mut touches).iter().all(|touches| !touches));
            assert!(touches(0.3), "first: {is_first}");
        }
    }
}

/// What was proved of a shape says nothing about another in its place, nor about one with a wider border, nor
/// about a longer prediction.
#[test]
fn a_proof_is_not_of_another_question() {
    let half = |size: Real| hulls::cuboid(Vector::splat(size)).expect("a box");
    let round = |border_radius: Real| {
        let inner_shape = half(0.5).as_convex_polyhedron().expect("a hull").clone();
        SharedShape::new(RoundShape {
            inner_shape,
            border_radius,
        })
    };
    let [small, large, fixed] = [half(0.5), half(0.8), half(0.5)];
    // Apart by the bounding spheres, and only by an axis.
    for x in [2.2, 1.25] {
        let pose = Pose::translation(x, 0.0, 0.0);
        let questions = [
            ([&small, &fixed], PREDICTION, false),
            ([&large, &fixed], x - 1.2, true),
            ([&small, &fixed], PREDICTION, false),
            ([&fixed, &large], x - 1.2, true),
            ([&small, &fixed], PREDICTION, false),
            ([&small, &fixed], x, true),
        ];
        let rounded = [round(0.01), round(x - 1.0)];
        let wider = [
            ([&rounded[0], &fixed], PREDICTION, false),
            ([&rounded[1], &fixed], PREDICTION, true),
        ];
        let dispatcher = IsaGjkDispatcher::default();
        let mut memory = Memory::default();
        for (shapes, prediction, touches) in questions.into_iter().chain(wider) {
            for _ in 0..3 {
                let manifold = memory.update(&dispatcher, &pose, shapes, prediction);
                let manifold = manifold.expect("supported");
                assert_eq!(!manifold.points.is_empty(), touches, "{x}, {prediction}");
                if touches {
                    memory = Memory::default();
                }
            }
        }
    }
}

#[test]
fn pairs_that_hardly_move_need_no_vertex() {
    let mut rng = Rng::new(19);
    let hulls = [(); 2].map(|()| rng.hull(12, 1.0).shape);
    let dispatcher = IsaGjkDispatcher::default();
    let mut memory = Memory::default();
    let mut supports = Vec::new();
    for frame in 0..50 {
        let turn = Rotation::from_scaled_axis(Vector::new(0.1, 0.3, 0.2) * (0.01 * frame as Real));
        let pose = Pose::from_parts(Vector::new(1.6, 1.0, 0.4 + 0.002 * frame as Real), turn);
        let before = dispatcher.stats();
        let shapes = [&hulls[0], &hulls[1]];
        let manifold = memory.update(&dispatcher, &pose, shapes, PREDICTION);
        assert!(manifold.expect("supported").points.is_empty());
        supports.push(dispatcher.stats().since(&before).supports);
    }
    let idle = supports.iter().filter(|&&count| count == 0).count();
    assert!(idle > 40, "{supports:?}");
}
