//! Prepared hulls of dropped plain hulls do not take memory for long, and what is in use is not prepared
//! again and again.

use std::collections::VecDeque;
use std::env;
use std::panic::resume_unwind;
use std::process::Command;
use std::sync::mpsc;
use std::thread;

use isa_gjk::IsaGjkDispatcher;
use parry3d::query::QueryDispatcher;
use rapier3d::prelude::*;
use testkit::generate::Rng;
use testkit::memory::cold_manifold;

use crate::counting::{allocations, bytes};
use testkit::world::narrow_phase;

const MIB: usize = 1 << 20;

/// Runs this binary once more, for the other tests of this file: they count the memory of the whole process,
/// so they run in one of their own, one at a time.
#[test]
fn prepared_hulls_take_little_memory() {
    let program = env::current_exe().expect("a program");
    let tests = ["--ignored", "--test-threads=1", "--nocapture", "memory::"];
    let output = Command::new(program).args(tests).output().expect("it runs");
    let [text, errors] =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(output.status.success(), "{text}{errors}");
    println!("{text}");
}

/// Runs a test on a thread of its own: what threads keep is freed as they end.
fn on_a_thread(test: impl FnOnce() + Send + 'static) {
    if let Err(panic) = thread::spawn(test).join() {
        resume_unwind(panic);
    }
}

/// A hull of points on a sphere.
fn round(rng: &mut Rng, vertices: usize, radius: Real) -> SharedShape {
    let points: Vec<Vector> = (0..vertices)
        .map(|_| rng.direction().as_vec3() * radius)
        .collect();
    SharedShape::convex_hull(&points).expect("a hull")
}

fn touch(dispatcher: &IsaGjkDispatcher, shapes: [&SharedShape; 2]) {
    let pose = Pose::translation(0.1, 0.2, 0.1);
    let [a, b] = shapes;
    let answer = dispatcher.intersection_test(&pose, &**a, &**b);
    assert!(answer.is_ok_and(|answer| answer.intersecting));
}

/// Hulls that are made, queried and dropped, among allocations of other sizes; the most memory that was in
/// use meanwhile beyond what was in use before.
fn churn(dispatcher: &IsaGjkDispatcher, rng: &mut Rng, hulls: usize, live: usize) -> usize {
    let stays = round(rng, 100, 0.5);
    let mut ring = VecDeque::new();
    let (before, mut most) = (bytes(), 0);
    for _ in 0..hulls {
        let vertices = rng.count(50, 150);
        let comes = round(rng, vertices, 0.5);
        for _ in 0..3 {
            touch(dispatcher, [&comes, &stays]);
        }
        ring.push_back((comes, vec![0_u8; rng.count(16, 2000)]));
        if ring.len() > live {
            ring.pop_front();
        }
        most = most.max(bytes().saturating_sub(before));
    }
    most
}

#[test]
#[ignore = "counts the memory of a process of its own"]
fn hulls_that_came_and_went_take_no_memory() {
    on_a_thread(|| {
        let dispatcher = IsaGjkDispatcher::default();
        let mut rng = Rng::new(131);
        let before = bytes();
        let most = churn(&dispatcher, &mut rng, 3_000, 30);
        assert!(most < 48 * MIB, "{} MiB at most", most / MIB);
        dispatcher.trim();
        let stays = bytes().saturating_sub(before);
        assert!(stays < MIB, "{stays} bytes stay");
    });
}

/// A hull that comes, is in a world for a step, and goes.
#[test]
#[ignore = "counts the memory of a process of its own"]
fn debris_of_a_world_takes_no_memory() {
    on_a_thread(|| {
        let dispatcher = IsaGjkDispatcher::default();
        let mut rng = Rng::new(132);
        let mut world = PhysicsWorld {
            narrow_phase: narrow_phase(&dispatcher),
            ..PhysicsWorld::default()
        };
        world.insert_collider(ColliderBuilder::new(round(&mut rng, 60, 3.0)), None);
        let (before, mut most) = (bytes(), 0);
        for _ in 0..4_500 {
            let shape = round(&mut rng, 100, 0.4);
            let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 3.2, 0.0));
            let (body, _) = world.insert(body, ColliderBuilder::new(shape));
            world.step();
            world.remove_body_with_colliders(body, true);
            most = most.max(bytes().saturating_sub(before));
        }
        assert!(most < 48 * MIB, "{} MiB at most", most / MIB);
    });
}

#[test]
#[ignore = "counts the memory of a process of its own"]
fn trimming_reaches_other_threads_and_changes_no_answer() {
    on_a_thread(|| {
        let dispatcher = IsaGjkDispatcher::default();
        let (to_thread, orders) = mpsc::channel();
        let (to_us, answers) = mpsc::channel();
        let other = thread::spawn({
            let dispatcher = dispatcher.clone();
            move || {
                let mut rng = Rng::new(133);
                let shapes: Vec<_> = (0..200).map(|_| round(&mut rng, 100, 0.5)).collect();
                for few in orders {
                    let shapes = if few { &shapes[..2] } else { &shapes };
                    let pose = Pose::translation(0.6, 0.5, 0.4);
                    let manifold = |pair: &[SharedShape]| {
                        cold_manifold(&dispatcher, &pose, [&pair[0], &pair[1]], 0.1)
                    };
                    let manifolds = shapes.windows(2).map(manifold);
                    let text = format!("{:?}", manifolds.collect::<Vec<_>>());
                    to_us.send(text).expect("somebody waits");
                }
            }
        });
        let ask = |few: bool| {
            to_thread.send(few).expect("somebody listens");
            answers.recv().expect("an answer")
        };
        drop(ask(true));
        let before = bytes();
        let all = ask(false);
        let kept = bytes() - before;
        dispatcher.trim();
        drop(ask(true));
        let left = bytes().saturating_sub(before + all.len());
        assert!(
            kept > 2 * MIB && left < MIB / 2,
            "{left} of {kept} bytes are left"
        );
        assert_eq!(all, ask(false));
        drop(to_thread);
        other.join().expect("no panic");
    });
}

/// As `docs/measured.md` states it.
#[test]
#[ignore = "counts the memory of a process of its own"]
fn a_prepared_hull_takes_what_is_stated() {
    on_a_thread(|| {
        let dispatcher = IsaGjkDispatcher::default();
        let mut rng = Rng::new(136);
        let ball = SharedShape::ball(0.5);
        touch(&dispatcher, [&round(&mut rng, 30, 0.5), &ball]);
        for vertices in [8, 12, 32, 60, 100, 300] {
            let hulls: Vec<_> = (0..200).map(|_| round(&mut rng, vertices, 0.5)).collect();
            let before = bytes();
            for hull in &hulls {
                touch(&dispatcher, [hull, &ball]);
            }
            let each = (bytes() - before) / hulls.len();
            println!("{vertices} vertices: {each} bytes");
            assert!(
                each < 1000 + 160 * vertices,
                "{vertices} vertices: {each} bytes"
            );
            dispatcher.trim();
        }
    });
}

/// More hulls than may stay unused, each queried in turn.
#[test]
#[ignore = "counts the memory of a process of its own"]
fn many_hulls_in_use_are_prepared_once() {
    on_a_thread(|| {
        let dispatcher = IsaGjkDispatcher::default();
        let mut rng = Rng::new(134);
        let ball = SharedShape::ball(0.5);
        let hulls: Vec<_> = (0..450).map(|_| round(&mut rng, 1000, 0.5)).collect();
        let before = bytes();
        let ask_all = || {
            let calls = allocations();
            for hull in &hulls {
                touch(&dispatcher, [hull, &ball]);
            }
            allocations() - calls
        };
        let first = ask_all();
        // Hulls that were dropped before it was known that all are in use are prepared once more.
        let second = ask_all();
        assert!(second < first, "{second} after {first} allocations");
        let later = [(); 5].map(|()| ask_all());
        assert_eq!(later, [0; 5], "after {first} and {second}");
        let kept = bytes() - before;
        assert!(kept > 40 * MIB, "only {} MiB of hulls", kept / MIB);
    });
}

/// A hull that was dropped, as others came, is answered as before when it comes back.
#[test]
#[ignore = "counts the memory of a process of its own"]
fn what_was_dropped_is_answered_as_before() {
    on_a_thread(|| {
        let dispatcher = IsaGjkDispatcher::default();
        let mut rng = Rng::new(135);
        let pairs: Vec<_> = (0..50)
            .map(|_| [(); 2].map(|()| round(&mut rng, 40, 0.5)))
            .collect();
        let answers = || {
            let pose = Pose::translation(0.6, 0.5, 0.4);
            let answer =
                |pair: &[SharedShape; 2]| cold_manifold(&dispatcher, &pose, pair.each_ref(), 0.1);
            format!("{:?}", pairs.iter().map(answer).collect::<Vec<_>>())
        };
        let before = answers();
        churn(&dispatcher, &mut rng, 5_000, 30);
        let calls = allocations();
        assert_eq!(before, answers());
        assert!(allocations() - calls > 50 * 10, "nothing was dropped");
    });
}
