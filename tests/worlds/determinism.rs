//! Equal worlds have equal histories, bit for bit.
//!
//! Two runs in one process, a run on another thread whose table of prepared hulls is empty, pools
//! of one and of several threads, shapes that are shared or copied, and builds with other features:
//! none of them may show in a bit.
//! Rapier itself promises the latter only with `enhanced-determinism`, so what is compared between
//! builds is the contacts alone.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::Real;
use rapier3d::prelude::{PhysicsWorld, SharedShape};
use testkit::cases::{hulls, trajectories};
use testkit::memory::Memory;
use testkit::world::{Ground, mixed, ours, state};

const BODIES: usize = 35;
const FRAMES: usize = 120;

fn start(ground: Ground) -> PhysicsWorld {
    mixed(ground, BODIES, ours())
}

fn run(mut world: PhysicsWorld) -> Vec<u32> {
    (0..FRAMES).for_each(|_| world.step());
    state(&world)
}

/// FNV-1a over numbers.
fn hash(numbers: impl IntoIterator<Item = u32>) -> u64 {
    let bytes = numbers.into_iter().flat_map(u32::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[test]
fn equal_worlds_have_equal_histories() {
    for ground in Ground::ALL {
        let here = run(start(ground));
        assert!(here == run(start(ground)), "again, on {ground:?}");
        let there = std::thread::spawn(move || run(start(ground)));
        let there = there.join().expect("no panic");
        assert!(here == there, "on another thread, on {ground:?}");
    }
}

/// Colliders that share a shape, and colliders with equal shapes of their own, as in a loaded world.
#[test]
fn shared_shapes_do_not_show() {
    for ground in Ground::ALL {
        let run_with = |shape: fn(&SharedShape) -> SharedShape| {
            let mut world = start(ground);
            for (_, collider) in world.colliders.iter_mut() {
                let shape = shape(collider.shared_shape());
                collider.set_shape(shape);
            }
            run(world)
        };
        let shared = run_with(SharedShape::clone);
        let own = run_with(|shape| SharedShape(shape.clone_dyn().into()));
        assert!(shared == own, "on {ground:?}");
    }
}

/// A dispatcher that has seen other worlds, and other shapes at the same addresses.
#[test]
fn a_used_dispatcher_answers_as_a_new_one() {
    let before = run(start(Ground::Mesh));
    for ground in [Ground::HeightField, Ground::Slab, Ground::Voxels] {
        drop(run(start(ground)));
    }
    assert!(before == run(start(Ground::Mesh)));
}

#[cfg(feature = "parallel")]
#[test]
fn the_number_of_threads_does_not_show() {
    for ground in Ground::ALL {
        let [one, two, many] = [1, 2, 7].map(|threads| {
            let mut world = start(ground);
            world.configure_thread_pool(threads).expect("a thread pool");
            run(world)
        });
        assert!(one == two && one == many, "on {ground:?}");
    }
}

/// The contacts along the published trajectories. Whoever changes answers on purpose replaces it
/// by what the failing test says.
const CONTACTS: u64 = 0x1c5a_5381_9c60_6c95;

/// The SIMD width is none of our business: all builds find the same contacts.
#[test]
fn contacts_are_those_of_every_build() {
    let dispatcher = IsaGjkDispatcher::default();
    let mut bits = Vec::new();
    for frames in trajectories() {
        let shapes = [&frames[0].shape_a, &frames[0].shape_b].map(|name| &hulls()[name].shape);
        let mut memory = Memory::default();
        for case in &frames {
            let pose = case.pose().to_f32();
            let prediction = (0.02 * case.scale) as Real;
            let manifold = memory.update(&dispatcher, &pose, shapes, prediction);
            let manifold = manifold.expect("supported");
            let normals = [manifold.local_n1, manifold.local_n2];
            bits.extend(normals.iter().flat_map(|n| n.to_array()).map(f32::to_bits));
            for point in &manifold.points {
                let places = [point.local_p1, point.local_p2];
                bits.extend(places.iter().flat_map(|p| p.to_array()).map(f32::to_bits));
                bits.extend([point.dist.to_bits(), point.fid1.0, point.fid2.0]);
            }
        }
    }
    assert!(bits.len() > 10_000, "hardly a contact");
    let found = hash(bits);
    assert_eq!(found, CONTACTS, "the contacts are now {found:#x}");
}
