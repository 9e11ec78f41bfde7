//! Every scene of the comparison lives through five seconds with our dispatcher: nothing is lost
//! in it, nothing sinks, and what rests stays at rest.

use isa_gjk::IsaGjkDispatcher;
use parry3d::query::QueryDispatcher;
use rapier3d::prelude::*;
use testkit::scenes::{self, HullSource, Hulls, Scene, SceneParams, World};

const FRAMES: usize = 300;

fn params(scene: Scene, hull_shape: bool) -> SceneParams {
    let hulls = match scene.hulls() {
        Hulls::Prisms | Hulls::Upright => HullSource::Prism { sides: 12 },
        Hulls::Boxes => HullSource::Box,
        Hulls::Own => HullSource::Own,
        Hulls::Any | Hulls::None => HullSource::Random { vertices: 40 },
    };
    SceneParams {
        distinct: 8,
        seed: 3,
        hull_shape,
        can_sleep: scene == Scene::Asleep,
        ..SceneParams::new(hulls, 64)
    }
}

fn world(scene: Scene, params: &SceneParams) -> World {
    scenes::build(scene, params, Some(IsaGjkDispatcher::default())).expect("a valid scene")
}

/// The box around everything that does not move by itself. Whoever is thrown over a wall or
/// falls through one leaves it at once or by falling.
fn container(world: &World) -> Aabb {
    let colliders = &world.physics.colliders;
    let fixed = colliders
        .iter()
        .filter(|(_, collider)| !is_dynamic(world, collider));
    let boxes = fixed.map(|(_, collider)| collider.compute_aabb());
    boxes
        .reduce(|a, b| a.merged(&b))
        .expect("a scene has a floor")
}

fn is_dynamic(world: &World, collider: &Collider) -> bool {
    let body = collider
        .parent()
        .map(|parent| &world.physics.bodies[parent]);
    body.is_some_and(|body| body.is_dynamic())
}

/// Every dynamic body is somewhere, and above the ground between the walls.
fn check_places(world: &World, container: &Aabb, frame: usize) {
    for (_, body) in world
        .physics
        .bodies
        .iter()
        .filter(|(_, body)| body.is_dynamic())
    {
        let place = body.translation();
        let moving = body.linvel().is_finite() && body.angvel().is_finite();
        assert!(place.is_finite() && moving, "not finite in frame {frame}");
        let (mins, maxs) = (container.mins, container.maxs);
        let between = |axis: usize| (mins[axis]..maxs[axis]).contains(&place[axis]);
        let inside = between(0) && between(2) && place.y > mins.y;
        assert!(inside, "left the container for {place} in frame {frame}");
    }
}

/// The deepest overlap of a pair, as a share of the smaller one's smallest extent. Asked for
/// anew: pairs that rapier recycles keep the distances that they had.
fn deepest_overlap(world: &World) -> Real {
    let colliders = &world.physics.colliders;
    let pairs = world.physics.narrow_phase.contact_pairs();
    let overlaps = pairs.map(|pair| {
        let [a, b] = [pair.collider1, pair.collider2].map(|handle| &colliders[handle]);
        let pos12 = a.position().inv_mul(b.position());
        let contact = IsaGjkDispatcher::default().contact(&pos12, a.shape(), b.shape(), 0.0);
        let depth = contact
            .expect("supported")
            .map_or(0.0, |contact| -contact.dist);
        // A mesh has no thickness.
        let thickness = [a, b].map(|collider| 2.0 * collider.shape().ccd_thickness());
        let thinner = thickness.into_iter().filter(|t| *t > 0.0);
        depth / thinner.fold(Real::INFINITY, Real::min)
    });
    overlaps.fold(0.0, Real::max)
}

/// Steps a scene to its end, checking every frame.
fn live(scene: Scene, params: &SceneParams) -> World {
    let mut world = world(scene, params);
    let container = container(&world);
    for frame in 0..FRAMES {
        world.step();
        check_places(&world, &container, frame);
    }
    world
}

/// How deep a scene may overlap at its end, and the least mean height in metres of what stands.
struct Settled {
    overlap: Real,
    height: f64,
}

/// `None` where nothing settles.
fn settled(scene: Scene) -> Option<Settled> {
    let (overlap, height) = match scene {
        // The row is still falling, and so are the last bodies of a burst. New hulls overlap as they come.
        Scene::Drum | Scene::Dominoes | Scene::Bursts | Scene::Reshaped => return None,
        // Towers that stand: they start at 2.27 m and 0.49 m.
        Scene::Stack => (0.05, 2.2),
        // The solver's soft contacts give way under sixteen coins by a few millimetres each.
        Scene::Coins => (0.25, 0.41),
        Scene::Asleep => (0.05, 0.35),
        // Flat on the floor: half of their height of 0.06 m.
        Scene::Top => (0.1, 0.025),
        // A layer or two, in the hollows of the ground.
        Scene::Trimesh | Scene::Heightfield | Scene::Rubble => (0.1, -0.1),
        // Four millimetres thick, and pressed into each other by a few.
        Scene::Plates | Scene::Needles => (2.0, 0.002),
        // Lying, much thinner than long. Crossed, they overlap by some millimetres.
        Scene::Pencils => (0.4, 0.01),
        // Rings fall into each other and are wedged there.
        Scene::Rings => (1.0, 0.01),
        // A brick or two are wedged between others.
        Scene::Breach => (0.2, 0.05),
        // Held in the air, 0.2 m above the floor, by fingers of 2 cm.
        Scene::Grippers | Scene::ShakenGrippers => (0.3, 0.18),
        // Coins of a centimetre give way by a millimetre or two.
        Scene::Solids => (0.3, 0.02),
        // A quarter of what a body measures. Small stones, a few centimetres thick, sink into each other by
        // some millimetres, as soft contacts let them.
        Scene::Dice | Scene::Rocks | Scene::Pebbles => {
            (0.2, 0.25 * f64::from(scene.default_size().unwrap_or(1.0)))
        }
        _ => (0.1, 0.25 * f64::from(scene.default_size().unwrap_or(1.0))),
    };
    Some(Settled { overlap, height })
}

fn check(scene: Scene, hull_shape: bool) {
    let end = live(scene, &params(scene, hull_shape));
    let Some(settled) = settled(scene) else {
        return;
    };
    let overlap = deepest_overlap(&end);
    assert!(overlap < settled.overlap, "{scene}: overlap of {overlap}");
    let height = end.mean_height();
    assert!(height > settled.height, "{scene}: sank to {height}");
    if scene == Scene::Asleep {
        // All but one, which bounces.
        assert!(end.sleeping() >= 60, "{} asleep", end.sleeping());
    }
}

#[test]
fn scenes_of_plain_hulls_live() {
    for scene in Scene::ALL {
        check(scene, false);
    }
}

#[test]
fn scenes_of_hull_shapes_live() {
    for scene in Scene::ALL {
        if scene.hulls() != Hulls::None {
            check(scene, true);
        }
    }
}

/// Bodies that rest keep resting: whoever lost a contact would move.
#[test]
fn what_rests_keeps_resting() {
    for scene in [Scene::Stack, Scene::Coins, Scene::Pile] {
        let mut world = live(scene, &params(scene, true));
        let before = world.mean_height();
        for _ in 0..FRAMES {
            world.step();
        }
        let sunk = before - world.mean_height();
        assert!(sunk.abs() < 2e-3, "{scene}: sank by {sunk}");
        let energy = world.kinetic_energy();
        assert!(energy < 0.01, "{scene}: {energy} J left");
    }
}
