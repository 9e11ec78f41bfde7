//! What a manifold keeps: contacts spread over the whole flat side, though it is made of many
//! facets, at their true distances; and the solver's data when contacts change.

use std::f32::consts::TAU;

use glam::{DQuat, DVec3, EulerRot};
use isa_gjk::{HullShape, IsaGjkDispatcher};
use oorandom::Rand32;
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::query::TrackedContact;
use parry3d::shape::{ConvexPolyhedron, PackedFeatureId, SharedShape};

use testkit::generate::hull_of;
use testkit::memory::{Manifold, UpdateManifolds, cold_manifold};
use testkit::scanned::noisy_box;

const HALF_HEIGHT: Real = 0.4;

/// An upright prism of radius 1 whose corners are off their height by up to `noise`.
fn prism(sides: u32, noise: Real) -> SharedShape {
    let mut random = Rand32::new(7);
    let points: Vec<Vector> = (0..sides)
        .flat_map(|side| {
            let (sin, cos) = (TAU * side as Real / sides as Real).sin_cos();
            [-HALF_HEIGHT, HALF_HEIGHT].map(|y| Vector::new(cos, y, sin))
        })
        .map(|p| p + Vector::Y * (noise * (2.0 * random.rand_float() - 1.0)))
        .collect();
    SharedShape::convex_hull(&points).expect("a solid")
}

/// Brings the manifold of a large slab, whose upper side is at height zero, and of `shape` up to
/// date.
fn update(manifolds: &mut Vec<Manifold>, shape: &SharedShape, pose: Pose) {
    let slab = SharedShape::cuboid(10.0, 1.0, 10.0);
    let pos12 = Pose::translation(0.0, 1.0, 0.0) * pose;
    update_pair(manifolds, [&slab, shape], pos12, 0.02);
}

fn update_pair(
    manifolds: &mut Vec<Manifold>,
    [a, b]: [&SharedShape; 2],
    pos12: Pose,
    prediction: Real,
) {
    IsaGjkDispatcher::default()
        .update_manifolds(&pos12, [&**a, &**b], prediction, manifolds, &mut None)
        .expect("supported");
}

fn standing(tilt: Vector) -> Pose {
    let place = Vector::new(0.3, HALF_HEIGHT + 1e-3, -0.2);
    Pose::from_parts(place, Rotation::from_scaled_axis(tilt))
}

/// The area that four points span, seen from above: half the product of the diagonals.
fn area(points: &[TrackedContact<u32>]) -> Real {
    let at = |i: usize| points[i].local_p1;
    let product = |a: usize, b: usize, c: usize, d: usize| {
        let cross = (at(b) - at(a)).cross(at(d) - at(c));
        0.5 * cross.y.abs()
    };
    product(0, 1, 2, 3)
        .max(product(0, 2, 1, 3))
        .max(product(0, 3, 1, 2))
}

/// The corners of a flat side are a tenth of a millimetre off, as scanned ones are, so that it
/// falls into facets. It used to rest on one of them.
#[test]
fn a_dented_side_is_one_face_with_its_true_distances() {
    for sides in [8, 16, 48] {
        let shape = prism(sides, 1e-4);
        let hull: &ConvexPolyhedron = shape.as_convex_polyhedron().expect("a hull");
        let mut manifolds = Vec::new();
        let pose = standing(Vector::new(2e-4, 0.5, -1e-4));
        update(&mut manifolds, &shape, pose);
        let points = &manifolds[0].points;
        assert_eq!(points.len(), 4, "{sides} sides");
        // A square in the unit circle has area 2.
        assert!(area(points) > 1.6, "{sides} sides: {}", area(points));
        let lowest = hull.points().iter().map(|p| (pose * *p).y);
        let deepest = lowest.fold(Real::INFINITY, Real::min);
        assert!((points[0].dist - deepest).abs() < 2e-6, "{sides} sides");
        for point in points {
            let height = (pose * point.local_p2).y;
            assert!((point.dist - height).abs() < 2e-6, "{sides} sides");
            let nearest = hull.points().iter().map(|p| p.distance(point.local_p2));
            let away = nearest.fold(Real::INFINITY, Real::min);
            assert!(away < 2e-5, "{sides} sides: {away} from a corner");
        }
    }
}

/// The facets of a flat lens are nearly coplanar, and some of those around its rim are seen edge-on there.
#[test]
fn the_rim_of_a_lens_touches_in_points_on_it() {
    let wall = SharedShape::cuboid(1.0, 3.0, 3.0);
    let mut rng = Rand32::new(5);
    let mut within = |most: Real| most * (2.0 * rng.rand_float() - 1.0);
    for corners in (8..68).cycle().take(2000) {
        let mut points: Vec<Vector> = (0..corners)
            .map(|i| {
                let (sin, cos) = (TAU * i as f32 / corners as f32).sin_cos();
                Vector::new(cos, within(2e-3), sin)
            })
            .collect();
        let height = 0.05 + within(0.02);
        points.extend([Vector::Y * height, Vector::Y * -height]);
        let lens = SharedShape::new(HullShape::from_points(&points).expect("a lens"));
        let [tilt_x, turn, tilt_z] = [0.05, 3.0, 0.05].map(&mut within);
        let turn = Rotation::from_scaled_axis(Vector::new(tilt_x, 0.0, tilt_z))
            * Rotation::from_scaled_axis(Vector::Y * turn);
        let depth = 0.01 + within(0.01);
        let mut manifolds = Vec::new();
        let pose = Pose::from_parts(Vector::X * (2.0 - depth), turn);
        update_pair(&mut manifolds, [&wall, &lens], pose, 0.05);
        for point in &manifolds[0].points {
            let off = lens.distance_to_local_point(point.local_p2, false).abs();
            let off_wall = (point.local_p1.x - 1.0).abs();
            assert!(off.max(off_wall) < 1e-5, "{off} and {off_wall}: {point:?}");
        }
    }
}

/// A slab of half extents (1, 0.05, 1), each side of so many cells squared. It was turned before it was
/// rounded, so its sides are flat only up to rounding. With it, the rotation back.
fn turned_slab(cells: u32, euler: [f64; 2]) -> (SharedShape, Rotation) {
    let turn = DQuat::from_euler(EulerRot::XYZ, euler[0], euler[1], 0.0);
    let corner = |x: u32, y: f64, z: u32| {
        let along = |i: u32| 2.0 * f64::from(i) / f64::from(cells) - 1.0;
        (turn * DVec3::new(along(x), y, along(z))).as_vec3()
    };
    let across = cells + 1;
    let below = across * across;
    let grid = (0..below).map(|i| [i % across, i / across]);
    let sides = [-0.05, 0.05].map(|y| grid.clone().map(move |[x, z]| corner(x, y, z)));
    let points: Vec<Vector> = sides.into_iter().flatten().collect();
    let mut triangles = Vec::new();
    for [x, z] in grid.filter(|&[x, z]| x < cells && z < cells) {
        let v = x + z * across;
        let [a, b, c, d] = [v, v + 1, v + across, v + across + 1];
        let [above_a, above_b, above_c, above_d] = [a, b, c, d].map(|v| v + below);
        triangles.extend([[a, b, c], [b, d, c]]);
        triangles.extend([[above_a, above_c, above_b], [above_b, above_c, above_d]]);
    }
    for i in 0..cells {
        let last = cells * across;
        let rims = [
            [i + 1, i],
            [last + i, last + i + 1],
            [i * across, (i + 1) * across],
            [(i + 2) * across - 1, (i + 1) * across - 1],
        ];
        for [a, b] in rims {
            triangles.extend([[a, b, a + below], [b, b + below, a + below]]);
        }
    }
    let hull = HullShape::from_triangles(points, &triangles).expect("a slab");
    let [x, y, z, w] = turn.inverse().as_quat().to_array();
    (SharedShape::new(hull), Rotation::from_xyzw(x, y, z, w))
}

/// By rounding, the plane of one small cell leaves the side at its far end. So the side was not joined
/// to one face, and met the ground with a single triangle.
#[test]
fn a_side_of_many_cells_is_met_as_a_whole() {
    for cells in [7, 10, 11, 15, 19] {
        for (i, j) in (0..20).flat_map(|i| [7, 10, 14, 18].map(|j| (i, j))) {
            let euler = [0.05 * f64::from(i), 0.05 * f64::from(j)];
            let (slab, back) = turned_slab(cells, euler);
            let mut manifolds = Vec::new();
            let pose = Pose::from_parts(Vector::Y * 0.049, back);
            update(&mut manifolds, &slab, pose);
            let points = &manifolds[0].points;
            assert_eq!(points.len(), 4, "{cells} cells, {euler:?}");
            let area = area(points);
            assert!(area > 2.9, "{cells} cells, {euler:?}: {area} m²");
        }
    }
}

/// The walls beside it are edge-on, and reach under its outline by rounding. For one such wall the
/// side was reduced to a single facet.
#[test]
fn a_noisy_side_is_met_as_a_whole_in_points_on_it() {
    let mut rng = Rand32::new(3);
    for i in 0..400 {
        let (count, noise) = ([10, 30, 100][i % 3], [1e-5, 1e-4, 1e-3][i / 3 % 3]);
        let points = noisy_box(count, noise, &mut rng);
        let shape = SharedShape::new(HullShape::from_points(&points).expect("a box"));
        let mut within = |most: Real| most * (2.0 * rng.rand_float() - 1.0);
        let tilt = Rotation::from_rotation_x(within(0.01));
        let turn = tilt * Rotation::from_rotation_y(within(3.0));
        // On the ground as a whole, and in part beyond its edge.
        for x in [0.0, 9.8] {
            let mut manifolds = Vec::new();
            let pose = Pose::from_parts(Vector::new(x + within(0.2), 0.199, 0.0), turn);
            update(&mut manifolds, &shape, pose);
            let points = &manifolds[0].points;
            let least = if x == 0.0 { 0.5 } else { 0.1 };
            assert!(area(points) > least, "box {i} at {x}: {} m²", area(points));
            for point in points {
                let off = shape.distance_to_local_point(point.local_p2, false).abs();
                // Between corners at different heights the outline passes the rim a little.
                let most = 2e-6 + 0.05 * noise;
                assert!(off < most, "box {i} at {x}: {off} m off");
            }
        }
    }
}

/// A stone that is pressed into the ground has four corners beneath it, on two faces with a common edge.
/// The corners of one face alone had contacts, so it rocked over that edge.
#[test]
fn a_pressed_stone_is_met_at_all_corners_beneath_the_ground() {
    let below = [
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.1, 1.0],
        [0.0, 0.1, -1.0],
    ];
    let points: Vec<Vector> = below
        .into_iter()
        .chain([[0.0, 1.0, 0.0]])
        .map(Vector::from)
        .collect();
    let stone = SharedShape::new(HullShape::from_points(&points).expect("a stone"));
    let slab = SharedShape::cuboid(10.0, 1.0, 10.0);
    for tilt in [-0.02, -1e-3, 1e-3, 0.02] {
        let pose = Pose::from_parts(Vector::Y * 0.85, Rotation::from_rotation_x(tilt));
        for swapped in [false, true] {
            let mut manifolds = Vec::new();
            if swapped {
                update_pair(&mut manifolds, [&stone, &slab], pose.inverse(), 0.02);
            } else {
                update_pair(&mut manifolds, [&slab, &stone], pose, 0.02);
            }
            for corner in &points[..4] {
                let at = |point: &&TrackedContact<u32>| {
                    let on_stone = if swapped {
                        point.local_p1
                    } else {
                        point.local_p2
                    };
                    on_stone.distance(*corner) < 1e-5
                };
                let found = manifolds[0].points.iter().find(at);
                let found = found.unwrap_or_else(|| panic!("{tilt}: {corner} is missing"));
                let depth = 1.0 - (pose * *corner).y;
                assert!(
                    (found.dist + depth).abs() < 2e-6,
                    "{tilt}: {corner}: {depth}"
                );
            }
        }
    }
}

/// A coin that begins to lean the other way has other deepest corners. Its weight must not be
/// borne by fewer contacts for that.
#[test]
fn no_impulse_is_lost_when_contacts_change() {
    let shape = prism(64, 0.0);
    let mut manifolds = Vec::new();
    update(
        &mut manifolds,
        &shape,
        standing(Vector::new(1e-3, 0.0, 0.0)),
    );
    for (i, point) in manifolds[0].points.iter_mut().enumerate() {
        point.data = i as u32 + 1;
    }
    let before = manifolds[0].points.clone();
    update(
        &mut manifolds,
        &shape,
        standing(Vector::new(1e-3, 0.0, 6e-4)),
    );
    let after = &manifolds[0].points;
    let changed = after.iter().all(|new| {
        let same = |old: &TrackedContact<u32>| (old.fid1, old.fid2) == (new.fid1, new.fid2);
        !before.iter().any(same)
    });
    assert!(changed, "the coin leans on the same corners");
    let mut data: Vec<u32> = after.iter().map(|point| point.data).collect();
    data.sort_unstable();
    assert_eq!(data, [1, 2, 3, 4]);
}

/// The features of another dispatcher's points may be unknown, and contacts fewer than there is room for.
#[test]
fn no_impulse_is_lost_to_contacts_that_are_not_there() {
    let shapes = [flat_box(), SharedShape::ball(0.5)];
    let pose = Pose::translation(0.2, HALF_HEIGHT + 0.5, 0.1);
    let unknown = PackedFeatureId::UNKNOWN;
    let mut foreign = TrackedContact::new(Vector::ZERO, Vector::ZERO, unknown, unknown, 0.0);
    foreign.data = 7;
    let mut manifold = Manifold::new();
    manifold.points = vec![foreign];
    let mut manifolds = vec![manifold];
    update_pair(&mut manifolds, shapes.each_ref(), pose, 0.02);
    let data: Vec<u32> = manifolds[0].points.iter().map(|p| p.data).collect();
    assert_eq!(data, [7]);
}

fn flat_box() -> SharedShape {
    let corners = [-1.0, 1.0]
        .map(|x| [-1.0, 1.0].map(|z| [-HALF_HEIGHT, HALF_HEIGHT].map(|y| Vector::new(x, y, z))));
    SharedShape::convex_hull(corners.as_flattened().as_flattened()).expect("a solid")
}

/// A box that slides on keeps the data of each corner with that corner.
#[test]
fn impulses_stay_with_their_corners() {
    let shape = flat_box();
    let mut manifolds = Vec::new();
    update(&mut manifolds, &shape, standing(Vector::new(0.0, 0.3, 0.0)));
    let corner = |p: Vector| u32::from(p.x > 0.0) * 2 + u32::from(p.z > 0.0) + 1;
    for point in &mut manifolds[0].points {
        point.data = corner(point.local_p2);
    }
    update(
        &mut manifolds,
        &shape,
        Pose::translation(0.05, 0.0, 0.02) * standing(Vector::new(0.0, 0.35, 1e-4)),
    );
    assert_eq!(manifolds[0].points.len(), 4);
    for point in &manifolds[0].points {
        assert_eq!(point.data, corner(point.local_p2));
    }
}

/// Two contacts in one place push twice as hard as one, and a heap rattles when it is another corner's
/// turn. When the box falls on its side, the contact at the corner keeps its data.
#[test]
fn a_corner_is_one_contact() {
    let shape = flat_box();
    let corner = Vector::new(1.0, -HALF_HEIGHT, 1.0);
    let on_its_corner = |tilt: Real| {
        let turn = Rotation::from_scaled_axis(Vector::new(tilt, 0.0, -tilt));
        Pose::from_parts(Vector::new(0.0, -(turn * corner).y - 1e-3, 0.0), turn)
    };
    let mut manifolds = Vec::new();
    update(&mut manifolds, &shape, on_its_corner(0.2));
    for (i, point) in manifolds[0].points.iter_mut().enumerate() {
        let is_corner = point.local_p2.distance(corner) < 1e-6;
        assert_eq!(is_corner, i == 0, "{point:?}");
        assert_eq!(is_corner, point.dist < 0.02, "{point:?}");
        point.data = i as u32 + 1;
    }
    for tilt in [0.21, 0.2, 0.0] {
        update(&mut manifolds, &shape, on_its_corner(tilt));
        let at_corner = |p: &&TrackedContact<u32>| p.local_p2.distance(corner) < 1e-6;
        let data = manifolds[0].points.iter().filter(at_corner).map(|p| p.data);
        assert_eq!(data.collect::<Vec<_>>(), [1], "tilt {tilt}");
    }
}

/// Lengths have no unit: the same scene a billion times as large or as small has the same contacts.
#[test]
fn contacts_scale_with_the_shapes() {
    let points = |scale: Real| {
        let slab = SharedShape::cuboid(10.0 * scale, scale, 10.0 * scale);
        let corners = flat_box();
        let corners = corners.as_convex_polyhedron().expect("a hull").points();
        let corners: Vec<Vector> = corners.iter().map(|&p| p * scale).collect();
        let shape = SharedShape::convex_hull(&corners).expect("a solid");
        let pose = Pose::translation(0.0, 1.0, 0.0) * standing(Vector::new(1e-3, 0.4, 2e-3));
        let pos12 = Pose::from_parts(pose.translation * scale, pose.rotation);
        let mut manifolds: Vec<Manifold> = Vec::new();
        update_pair(&mut manifolds, [&slab, &shape], pos12, 0.02 * scale);
        let points = manifolds[0]
            .points
            .iter()
            .map(|p| (p.local_p1 / scale, p.fid1, p.fid2));
        points.collect::<Vec<_>>()
    };
    let usual = points(1.0);
    assert_eq!(usual.len(), 4);
    for exponent in [-30, -20, -10, 10, 20, 30] {
        assert_eq!(points(2.0_f32.powi(exponent)), usual, "2^{exponent}");
    }
}

/// A box on a floor a kilometre wide, at its rim: contacts are as exact as positions there are, and end
/// where the floor ends.
#[test]
fn contacts_far_from_the_middle_of_a_large_shape_are_exact() {
    let half = 500.0;
    let floor = SharedShape::cuboid(half, 1.0, half);
    let shape = flat_box();
    let at = Vector::new(half - 0.25, 1.0 + HALF_HEIGHT - 1e-3, 300.5);
    let mut manifolds: Vec<Manifold> = Vec::new();
    let pos12 = Pose::from_translation(at);
    update_pair(&mut manifolds, [&floor, &shape], pos12, 0.02);
    let points = &manifolds[0].points;
    assert_eq!(points.len(), 4);
    // One rounding of coordinates of 500.
    let rounding = half * Real::EPSILON;
    for point in points {
        let p2 = at + point.local_p2;
        assert!((p2.x - half).abs() < 2.0 * rounding || (point.local_p2.x + 1.0).abs() < 1e-6);
        assert!((point.local_p2.z.abs() - 1.0).abs() < 1e-6, "{point:?}");
        assert!((point.dist + 1e-3).abs() < 1e-6, "{point:?}");
        assert!(
            point.local_p1.distance(p2) < 1e-3 + 4.0 * rounding,
            "{point:?}"
        );
    }
}

/// Stones of few corners that are pressed into each other have contacts on both surfaces, one over the
/// other along the normal.
#[test]
fn contacts_of_pressed_stones_lie_on_both() {
    let mut rng = Rand32::new(9);
    let mut with_four = 0;
    for i in 0..3000 {
        let mut within = |most: Real| most * (2.0 * rng.rand_float() - 1.0);
        let mut vector = |most: Real| Vector::new(within(most), within(most), within(most));
        let [a, b] = [(); 2].map(|()| {
            let points: Vec<Vector> = (0..8 + i % 13).map(|_| vector(1.0)).collect();
            SharedShape::new(HullShape::from_points(&points).expect("a stone"))
        });
        let pose = Pose::from_parts(vector(1.6), Rotation::from_scaled_axis(vector(3.0)));
        let mut manifolds = Vec::new();
        update_pair(&mut manifolds, [&a, &b], pose, 0.02);
        let Some(manifold) = manifolds.first() else {
            continue;
        };
        for point in &manifold.points {
            let [off_1, off_2] = [(&a, point.local_p1), (&b, point.local_p2)]
                .map(|(shape, p)| shape.distance_to_local_point(p, false).abs());
            assert!(off_1.max(off_2) < 1e-5, "{i}: off by {off_1} and {off_2}");
            let along = (pose * point.local_p2 - point.local_p1).dot(manifold.local_n1);
            assert!((along - point.dist).abs() < 1e-5, "{i}: {along}, {point:?}");
        }
        with_four += usize::from(manifold.points.len() == 4);
    }
    assert!(with_four > 300, "only {with_four}");
}

/// A prism leans on an edge of its flat side. Whichever end of the edge is deeper, both ends bear it: other corners
/// are far above.
#[test]
fn both_ends_of_the_edge_that_bears_a_leaning_prism_are_contacts() {
    for sides in [5, 6, 8, 12] {
        let prism = prism(sides, 0.0);
        let half_side = TAU / (2 * sides) as Real;
        for lean in [0.2, 0.25, 0.3] {
            for tip in [-4e-3, 4e-3] {
                // The edge between the corners 0 and 1 is lowest.
                let to_edge = Vector::new(half_side.cos(), 0.0, half_side.sin());
                let axis = to_edge.cross(Vector::Y);
                let rotation = Rotation::from_axis_angle(to_edge, tip)
                    * Rotation::from_axis_angle(axis, -lean);
                let corner = |i: u32| {
                    let (sin, cos) = (TAU * i as Real / sides as Real).sin_cos();
                    rotation * Vector::new(cos, -HALF_HEIGHT, sin)
                };
                let ends = [corner(0), corner(1)];
                let lowest = ends[0].y.min(ends[1].y);
                let place = Vector::new(0.0, -1e-3 - lowest, 0.0);
                let mut manifolds = Vec::new();
                let slab = SharedShape::cuboid(10.0, 1.0, 10.0);
                let pose = Pose::translation(0.0, 1.0, 0.0) * Pose::from_parts(place, rotation);
                update_pair(&mut manifolds, [&slab, &prism], pose, 2.0);
                for end in ends {
                    let at = Pose::translation(0.0, 1.0, 0.0) * (place + end);
                    let is_there =
                        |p: &TrackedContact<u32>| (pose * p.local_p2).distance(at) < 1e-3;
                    assert!(
                        manifolds[0].points.iter().any(is_there),
                        "{sides} sides, leaning by {lean}, tipped by {tip}: no contact at {at} in {:?}",
                        manifolds[0].points
                    );
                }
            }
        }
    }
}

/// The top of a hull is an arrowhead of two triangles that bend by less than one degree. The outline of both cuts across
/// the bay of the arrowhead, where four other faces are: two at its notch, and two beyond these that do not touch it.
#[test]
fn contacts_in_the_bay_of_nearly_coplanar_faces_lie_on_the_faces_there() {
    let top = [
        Vector::new(-1.0, 0.0, 0.0),
        Vector::new(1.0, 0.0, 0.0),
        Vector::new(0.0, 1.0, 0.0),
        Vector::new(0.0, 0.1, 0.0072),
        Vector::new(0.0, 0.05, 0.0062),
        Vector::new(0.0, -1.0, -0.1),
    ];
    let low = [(-1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
    let low = low.map(|(x, y)| Vector::new(x, y, -1.0));
    let corners: Vec<Vector> = top.into_iter().chain(low).collect();
    let hull = hull_of(&corners).expect("a hull with all of these corners");
    let above = SharedShape::cuboid(0.5, 0.5, 0.1);
    let pose = Pose::translation(0.48, 0.0, 0.1072 + 0.001);
    let dispatcher = IsaGjkDispatcher::default();
    let manifold = cold_manifold(&dispatcher, &pose, [&hull.shape, &above], 0.1).expect("a hull");
    assert_eq!(manifold.points.len(), 4);
    for point in &manifold.points {
        let off = hull.solid.distance_to_surface(point.local_p1.as_dvec3());
        assert!(off < 1e-6, "{} is {off} off", point.local_p1);
    }
}
