//! `ContactPatch` is the region that an oracle finds by clipping in f64; its corners are on both surfaces, and
//! their ids stay.

use std::collections::{BTreeSet, HashSet};
use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use isa_gjk::IsaGjkDispatcher;
use isa_gjk::query::{ContactId, ContactPatch, QueryError};
use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::SharedShape;
use rapier3d::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder};
use testkit::generate::{Rng, hull_of};
use testkit::memory::Memory;
use testkit::oracle::{regret, signed_distance};
use testkit::pose::ExactPose;
use testkit::rounded::{self, Rounded};
use testkit::scenes::hulls;
use testkit::world::ours;

/// Of both sizes, borders and the offset.
const EXACT: f64 = 1e-5;
/// The overlap, as a share of the smaller size, from which manifolds take in the faces beside.
const PRESSED: f64 = 0.01;

fn patch(shapes: [&SharedShape; 2], pose: &ExactPose, prediction: f64) -> Option<ContactPatch> {
    let [a, b] = shapes.map(|shape| &**shape);
    ContactPatch::between(a, b, &pose.to_f32(), prediction as Real).expect("known shapes")
}

/// Everything that holds for any patch.
fn judge(shapes: [&Rounded; 2], pose: &ExactPose, prediction: f64, what: &str) {
    let [a, b] = shapes;
    let scale = a.core.diameter()
        + b.core.diameter()
        + 2.0 * (a.border + b.border)
        + pose.translation.length();
    let slack = EXACT * scale;
    let core = signed_distance(&a.core, &b.core, pose);
    let exact = core - a.border - b.border;
    let Some(patch) = patch([&a.shape, &b.shape], pose, prediction) else {
        assert!(exact >= prediction - slack, "{what}: lost at {exact}");
        return;
    };
    assert!(exact <= prediction + slack, "{what}: found at {exact}");
    let deepest = patch.deepest.distance;
    assert!(
        (deepest - exact).abs() <= slack,
        "{what}: {deepest} for {exact}"
    );
    let worse = regret(&a.core, &b.core, pose, patch.normal, core);
    assert!(worse <= slack, "{what}: regret {worse:e}");
    let mut ids = HashSet::new();
    for vertex in patch.vertices.iter().chain([&patch.deepest]) {
        let on_1 = vertex.on_1 - patch.normal * a.border;
        let on_2 = vertex.on_1 + patch.normal * (vertex.distance + b.border);
        let off = a.core.distance_to_surface(on_1);
        assert!(off <= slack, "{what}: {vertex:?} is {off:e} off shape 1");
        let off = b.core.distance_to_surface(pose.inverse().apply(on_2));
        assert!(off <= slack, "{what}: {vertex:?} is {off:e} off shape 2");
        let range = exact - slack..=prediction.max(exact) + slack;
        assert!(
            range.contains(&vertex.distance),
            "{what}: {vertex:?} in {range:?}"
        );
    }
    assert!(!patch.vertices.is_empty(), "{what}: no corner");
    for vertex in &patch.vertices {
        assert!(ids.insert(vertex.id), "{what}: {:?} twice", vertex.id);
    }
    let corners = patch.vertices.iter().map(|vertex| vertex.on_1);
    let around: Vec<DVec3> = corners.collect();
    let count = around.len();
    for i in 0..if count > 2 { count } else { 0 } {
        let [p, q, r] = [0, 1, 2].map(|k| around[(i + k) % count]);
        let turn = patch.normal.dot((q - p).cross(r - q));
        assert!(turn >= -slack * scale, "{what}: not convex, {turn:e}");
    }
    if exact > -PRESSED * a.core.diameter().min(b.core.diameter()) {
        contacts_are_corners(shapes, pose, prediction, &patch, what);
    }
}

/// The contacts of the manifold are among the corners, by the same ids.
fn contacts_are_corners(
    [a, b]: [&Rounded; 2],
    pose: &ExactPose,
    prediction: f64,
    patch: &ContactPatch,
    what: &str,
) {
    let (dispatcher, mut memory) = (IsaGjkDispatcher::default(), Memory::default());
    let shapes = [&a.shape, &b.shape];
    let manifold = memory.update(&dispatcher, &pose.to_f32(), shapes, prediction as Real);
    let mut known: HashSet<ContactId> = patch.vertices.iter().map(|vertex| vertex.id).collect();
    known.insert(patch.deepest.id);
    for contact in &manifold.expect("ours").points {
        let id = ContactId::of(contact).expect("a contact of ours");
        let is_within = f64::from(contact.dist) < prediction * 0.99;
        assert!(
            !is_within || known.contains(&id),
            "{what}: {contact:?} is not in {patch:?}"
        );
    }
}

#[test]
fn patches_are_on_both_surfaces() {
    let mut rng = Rng::new(36);
    let mut count = 0;
    for size in [1.0, 0.05, 20.0] {
        let others = rounded::all(&mut rng, size);
        let hulls = rounded::all(&mut rng, 1.0);
        for hull in &hulls[..2] {
            for other in &others {
                for _ in 0..12 {
                    let turn = if rng.count(0, 1) == 0 {
                        rng.any_turn()
                    } else {
                        rng.rotation()
                    };
                    let reach = 0.5 * (hull.core.diameter() + other.core.diameter());
                    let pose = ExactPose {
                        rotation: turn,
                        translation: rng.any_place(reach + hull.border + other.border),
                    };
                    let prediction = 0.05 * f64::from(size.min(1.0));
                    let swapped = pose.inverse().rounded();
                    for (shapes, pose) in
                        [([hull, other], pose.rounded()), ([other, hull], swapped)]
                    {
                        let what = format!("{}, {} of {size}", shapes[0].name, shapes[1].name);
                        judge(shapes, &pose, prediction, &format!("{what} at {pose:?}"));
                        count += 1;
                    }
                }
            }
        }
    }
    assert!(count > 1000);
}

/// A prism along y whose ends are regular polygons, half a metre above and below the origin.
struct Prism {
    shape: SharedShape,
    /// One end, counter-clockwise seen from above: x and z.
    end: Vec<DVec2>,
}

fn prism(rng: &mut Rng) -> Prism {
    loop {
        let (sides, radius) = (rng.count(3, 9), rng.range(0.3, 1.0));
        let phase = rng.range(0.0, TAU);
        let corner = |i: usize| radius * DVec2::from_angle(phase - TAU * i as f64 / sides as f64);
        let end: Vec<DVec2> = (0..sides).map(|i| corner(i).as_vec2().as_dvec2()).collect();
        let corners = end
            .iter()
            .flat_map(|p| [-0.5, 0.5].map(|y| DVec3::new(p.x, y, p.y)));
        let corners: Vec<Vector> = corners.map(|p| p.as_vec3()).collect();
        if let Some(hull) = hull_of(&corners) {
            return Prism {
                shape: hull.shape,
                end,
            };
        }
    }
}

/// The part of a convex polygon for which a linear function is not positive.
fn clip(polygon: &[DVec2], height: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::new();
    for (i, &from) in polygon.iter().enumerate() {
        let to = polygon[(i + 1) % polygon.len()];
        let (h, k) = (height(from), height(to));
        if h <= 0.0 {
            kept.push(from);
        }
        if (h <= 0.0) != (k <= 0.0) {
            kept.push(from.lerp(to, h / (h - k)));
        }
    }
    kept
}

/// Area and centre of area.
fn moments(polygon: &[DVec2]) -> (f64, DVec2) {
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for (i, &from) in polygon.iter().enumerate() {
        let to = polygon[(i + 1) % polygon.len()];
        let triangle = 0.5 * from.perp_dot(to);
        area += triangle;
        moment += triangle * (from + to) / 3.0;
    }
    (area, moment / area)
}

/// A face with its plane, in the coordinates of a plane across `normal`.
struct Face {
    polygon: Vec<DVec2>,
    outward: DVec3,
    point: DVec3,
}

/// Where two faces are over each other along `normal`, and at most `prediction` apart.
fn region(faces: [Face; 2], [u, v, normal]: [DVec3; 3], prediction: f64) -> Vec<DVec2> {
    let [f1, f2] = faces;
    let mut region = f1.polygon;
    for (i, &from) in f2.polygon.iter().enumerate() {
        let to = f2.polygon[(i + 1) % f2.polygon.len()];
        let sense = moments(&f2.polygon).0.signum();
        region = clip(&region, |p| -sense * (to - from).perp_dot(p - from));
    }
    let height = |outward: DVec3, point: DVec3, p: DVec2| {
        let in_plane = u * p.x + v * p.y;
        outward.dot(point - in_plane) / outward.dot(normal)
    };
    clip(&region, |p| {
        height(f2.outward, f2.point, p) - height(f1.outward, f1.point, p) - prediction
    })
}

#[test]
fn faces_meet_where_clipping_in_f64_says() {
    let mut rng = Rng::new(37);
    let mut compared = 0;
    for round in 0..600 {
        let [lower, upper] = [prism(&mut rng), prism(&mut rng)];
        let tilt = [0.0, 1e-3, 0.03][round % 3];
        let place = rng.direction() * rng.range(0.0, 0.8);
        let pose = ExactPose {
            rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), tilt)
                * DQuat::from_rotation_y(rng.range(0.0, TAU)),
            translation: DVec3::new(place.x, 1.0 + rng.range(-0.01, 0.01), place.z),
        }
        .rounded();
        let prediction = 0.02;
        let Some(patch) = patch([&lower.shape, &upper.shape], &pose, prediction) else {
            continue;
        };
        // Else the sides of the prisms meet.
        let normal = patch.normal;
        let down = pose.rotation * -DVec3::Y;
        if normal.dot(DVec3::Y).max(-normal.dot(down)) < 1.0 - 1e-12 {
            continue;
        }
        let (u, v) = normal.any_orthonormal_pair();
        let flat = |p: DVec3| DVec2::new(u.dot(p), v.dot(p));
        let top = |p: &DVec2| DVec3::new(p.x, 0.5, p.y);
        let bottom = |p: &DVec2| pose.apply(DVec3::new(p.x, -0.5, p.y));
        let faces = [
            Face {
                polygon: lower.end.iter().map(|p| flat(top(p))).collect(),
                outward: DVec3::Y,
                point: top(&lower.end[0]),
            },
            Face {
                polygon: upper.end.iter().map(|p| flat(bottom(p))).collect(),
                outward: down,
                point: bottom(&upper.end[0]),
            },
        ];
        let expected = region(faces, [u, v, normal], prediction);
        let (area, center) = moments(&expected);
        let area = area.abs();
        // Where a sliver of the faces meets, other faces may.
        if expected.len() < 3 || area < 1e-4 {
            continue;
        }
        let at = format!("{round}, at {pose:?}");
        assert!(
            (patch.area - area).abs() < 1e-5,
            "{at}: area {} for {area}",
            patch.area
        );
        let off = flat(patch.center).distance(center);
        assert!(off * area < 1e-5, "{at}: the centre is {off} off");
        for vertex in &patch.vertices {
            let near = expected.iter().map(|p| p.distance(flat(vertex.on_1)));
            let off = near.fold(f64::INFINITY, f64::min);
            // The less the faces are tilted, the less a distance tells about a place.
            let slack = if tilt > 0.0 { 1e-6 / tilt } else { 0.0 } + 1e-5;
            assert!(off < slack, "{at}: a corner is {off} off");
        }
        compared += 1;
    }
    assert!(compared > 250, "only {compared} patches have been compared");
}

fn cuboid(half: [Real; 3]) -> SharedShape {
    hulls::cuboid(half.into()).expect("a box")
}

fn ids(patch: &ContactPatch) -> BTreeSet<ContactId> {
    patch.vertices.iter().map(|vertex| vertex.id).collect()
}

/// A box slides and turns a little on a larger one, sinking and tilting as solvers let them. As long as
/// the same corners are on the same face the ids are the same, cold or warm; when a corner goes over the
/// rim, the ids of the others stay.
#[test]
fn ids_stay_from_frame_to_frame() {
    let (ground, body) = (cuboid([2.0, 0.5, 2.0]), cuboid([0.4, 0.3, 0.2]));
    let (dispatcher, mut memory) = (IsaGjkDispatcher::default(), Memory::default());
    let mut before: Option<BTreeSet<ContactId>> = None;
    let mut changes = Vec::new();
    for frame in 0..200 {
        let t = f64::from(frame);
        let pose = ExactPose {
            rotation: DQuat::from_rotation_y(0.3 + 0.002 * t)
                * DQuat::from_rotation_x(2e-4 * (0.9 * t).sin()),
            translation: DVec3::new(0.3 + 0.01 * t, 0.8 + 1e-3 * (0.4 * t).sin() - 1e-3, 0.2),
        }
        .rounded();
        let patch = patch([&ground, &body], &pose, 0.02).expect("it stands there");
        let now = ids(&patch);
        let manifold = memory.update(&dispatcher, &pose.to_f32(), [&ground, &body], 0.02);
        for contact in &manifold.expect("ours").points {
            let id = ContactId::of(contact).expect("ours");
            // If it is no corner, it is the place where they overlap most.
            assert!(
                now.contains(&id) || id == patch.deepest.id,
                "frame {frame}: {id:?}"
            );
        }
        if let Some(before) = before.replace(now.clone())
            && before != now
        {
            changes.push((frame, before.intersection(&now).count()));
        }
    }
    // One after the other, its corners go over the rim.
    assert!((2..=6).contains(&changes.len()), "{changes:?}");
    assert!(
        changes.iter().all(|&(_, stayed)| stayed >= 2),
        "{changes:?}"
    );
}

/// A tilted prism on a half-space: the part of its end that is near enough.
#[test]
fn half_spaces_have_patches() {
    let mut rng = Rng::new(39);
    let ground = SharedShape::halfspace(Vector::Y);
    let prediction = 0.02;
    let mut cut = 0;
    for round in 0..300 {
        let prism = prism(&mut rng);
        let tilt = [0.0, 0.01, 0.05][round % 3];
        let pose = ExactPose {
            rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), tilt)
                * DQuat::from_rotation_y(rng.range(0.0, TAU)),
            translation: DVec3::new(0.3, 0.5 + rng.range(-0.02, 0.0), -0.2),
        }
        .rounded();
        let corners = prism
            .end
            .iter()
            .map(|p| pose.apply(DVec3::new(p.x, -0.5, p.y)));
        let corners: Vec<DVec3> = corners.collect();
        let down = pose.rotation * DVec3::NEG_Y;
        let height = |p: DVec2| {
            corners[0].y - (down.x * (p.x - corners[0].x) + down.z * (p.y - corners[0].z)) / down.y
        };
        let lowest = corners.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let whole: Vec<DVec2> = corners.iter().map(|p| DVec2::new(p.x, p.z)).collect();
        let region = clip(&whole, |p| height(p) - prediction);
        cut += usize::from(region.len() != whole.len());
        let (area, center) = moments(&region);

        let found = patch([&ground, &prism.shape], &pose, prediction).expect("it lies there");
        let what = format!("round {round}: {found:?}");
        assert!(
            (found.area - area.abs()).abs() < 1e-5,
            "{what}: area {area}"
        );
        let off = DVec2::new(found.center.x, found.center.z).distance(center);
        assert!(off < 1e-4, "{what}: centre {center}");
        assert!(
            (found.deepest.distance - lowest).abs() < 1e-6,
            "{what}: {lowest}"
        );
        assert!(
            found.vertices.iter().all(|v| v.on_1.y.abs() < 1e-6),
            "{what}"
        );
        let ids: HashSet<_> = found.vertices.iter().map(|v| v.id).collect();
        assert_eq!(ids.len(), region.len(), "{what}");

        let swapped = pose.inverse().rounded();
        let other = patch([&prism.shape, &ground], &swapped, prediction).expect("as before");
        assert!(
            (other.area - found.area).abs() < 1e-4,
            "{what} and {other:?}"
        );
        assert_eq!(other.vertices.len(), found.vertices.len());
    }
    assert!(cut > 20, "only {cut} reach out");
    let above = Pose::translation(0.0, 3.0, 0.0);
    let prism = prism(&mut rng).shape;
    let far = ContactPatch::between(&*ground, &*prism, &above, 0.02);
    assert!(far.expect("known shapes").is_none());
}

#[test]
fn ids_are_mirrored_with_the_shapes() {
    let (a, b) = (cuboid([1.0, 0.5, 1.0]), cuboid([0.4, 0.3, 0.9]));
    let pose = Pose::new(Vector::new(0.5, 0.79, 0.4), Vector::Y * 0.4);
    let [one, other] = [(&a, &b, pose), (&b, &a, pose.inverse())].map(|(a, b, pose)| {
        let patch = ContactPatch::between(&**a, &**b, &pose, 0.02).expect("known shapes");
        patch.expect("they overlap")
    });
    let mirrored = other
        .vertices
        .iter()
        .map(|v| ContactId::new([v.features[1], v.features[0]]));
    assert_eq!(ids(&one), mirrored.collect());
    assert!((one.area - other.area).abs() < 1e-6);
}

/// In a world the ids of a resting body are the same in each step, and its impulses go with them.
#[test]
fn ids_of_a_resting_body_stay() {
    let mut world = PhysicsWorld {
        narrow_phase: ours(),
        ..PhysicsWorld::default()
    };
    world.integration_parameters.contact_recycling = false;
    let ground = world.insert_collider(ColliderBuilder::new(cuboid([3.0, 0.5, 3.0])), None);
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.3, 0.81, 0.1))
        .can_sleep(false);
    let (_, body) = world.insert(body, ColliderBuilder::new(cuboid([0.4, 0.3, 0.2])));
    let mut seen = HashSet::new();
    for step in 0..180 {
        world.step();
        if step < 60 {
            continue;
        }
        let pair = world
            .narrow_phase
            .contact_pair(ground, body)
            .expect("it lies there");
        let contacts = pair
            .manifolds()
            .iter()
            .flat_map(|manifold| &manifold.points);
        let contacts: Vec<_> = contacts.collect();
        assert_eq!(contacts.len(), 4);
        assert!(
            contacts.iter().all(|contact| contact.data.impulse > 0.0),
            "in step {step}"
        );
        let ids = contacts
            .iter()
            .map(|contact| ContactId::of(contact).expect("ours"));
        seen.insert(ids.collect::<BTreeSet<_>>());
    }
    assert_eq!(seen.len(), 1, "{seen:?}");
}

#[test]
fn what_has_no_patch_says_why() {
    let (hull, ball) = (cuboid([0.5; 3]), SharedShape::ball(0.5));
    let near = Pose::translation(0.5, 0.0, 0.0);
    let asked = |a: &SharedShape, b: &SharedShape, pose: &Pose, prediction: Real| {
        ContactPatch::between(&**a, &**b, pose, prediction).map(|patch| patch.is_some())
    };
    assert_eq!(asked(&hull, &ball, &near, 0.1), Ok(true));
    assert_eq!(
        asked(&hull, &ball, &Pose::translation(9.0, 0.0, 0.0), 0.1),
        Ok(false)
    );
    assert_eq!(
        asked(
            &hull,
            &ball,
            &Pose::translation(9.0, 0.0, 0.0),
            Real::INFINITY
        ),
        Ok(true)
    );
    assert_eq!(asked(&ball, &ball, &near, 0.1), Err(QueryError::NoHull));
    let cone = SharedShape::cone(0.5, 0.5);
    assert_eq!(asked(&hull, &cone, &near, 0.1), Err(QueryError::OtherShape));
    assert_eq!(
        asked(&hull, &ball, &near, Real::NAN),
        Err(QueryError::NotFinite)
    );
    let nowhere = Pose::translation(Real::NAN, 0.0, 0.0);
    assert_eq!(
        asked(&ball, &hull, &nowhere, 0.1),
        Err(QueryError::NotFinite)
    );
}
