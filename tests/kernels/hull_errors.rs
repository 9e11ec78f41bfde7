//! Input that is no hull is refused with its reason; hulls of extreme size or shape are built.

use std::collections::HashSet;
use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3, Vec3};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{Polytope, Support};
use isa_gjk::{Hull, HullError, HullShape};
use testkit::divided::divided_block;
use testkit::families::prism;
use testkit::generate::Rng;

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

fn corners() -> Vec<Vec3> {
    vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]
}

fn refusal(points: Vec<Vec3>, triangles: &[[u32; 3]]) -> HullError {
    Hull::from_triangles(points, triangles).expect_err("this is no hull")
}

#[test]
fn the_tetrahedron_that_is_broken_below_is_sound() {
    let hull = Hull::from_triangles(corners(), &TETRAHEDRON).expect("a tetrahedron");
    assert_eq!((hull.points().len(), hull.face_count()), (4, 4));
}

#[test]
fn too_few_points_are_refused() {
    let three = &corners()[..3];
    assert_eq!(
        Hull::from_points(three).unwrap_err(),
        HullError::TooFewPoints
    );
    assert_eq!(Hull::from_points(&[]).unwrap_err(), HullError::TooFewPoints);
    assert_eq!(
        refusal(three.into(), &[[0, 1, 2], [2, 1, 0]]),
        HullError::TooFewPoints
    );
}

#[test]
fn too_many_points_are_refused() {
    let mut points = corners();
    points.resize(32_769, Vec3::ZERO);
    assert_eq!(refusal(points, &TETRAHEDRON), HullError::TooManyPoints);
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (i, axis) in [(0, 0), (2, 1), (3, 2)] {
            let mut points = corners();
            points[i][axis] = bad;
            let error = Hull::from_points(&points).unwrap_err();
            assert_eq!(error, HullError::NotFinite(i));
            assert_eq!(refusal(points, &TETRAHEDRON), HullError::NotFinite(i));
        }
    }
}

#[test]
fn points_without_volume_are_refused() {
    let plane: Vec<Vec3> = (0..30)
        .map(|i| Vec3::new((i % 6) as f32, (i / 6) as f32, 0.0))
        .collect();
    let line: Vec<Vec3> = (0..9)
        .map(|i| Vec3::new(1.0, 2.0, 3.0) * i as f32)
        .collect();
    let slanted: Vec<Vec3> = plane
        .iter()
        .map(|p| Vec3::new(p.x, p.y, 0.3 * p.x + 0.7 * p.y))
        .collect();
    for points in [plane, line, slanted, vec![Vec3::ONE; 12]] {
        let error = Hull::from_points(&points).expect_err("no volume");
        assert_eq!(error, HullError::Flat, "{points:?}");
    }
    let mut flat = corners();
    flat[3] = Vec3::new(0.3, 0.3, 0.0);
    assert_eq!(refusal(flat.clone(), &TETRAHEDRON), HullError::Flat);
    flat[3].z = 1.0e-8;
    assert_eq!(refusal(flat, &TETRAHEDRON), HullError::Flat);
}

#[test]
fn triangles_of_vertices_that_are_not_three_are_refused() {
    for (i, bad) in [
        (0, [0, 2, 4]),
        (1, [0, 0, 3]),
        (2, [1, 2, u32::MAX]),
        (3, [0, 3, 0]),
    ] {
        let mut triangles = TETRAHEDRON;
        triangles[i] = bad;
        assert_eq!(refusal(corners(), &triangles), HullError::BadTriangle(i));
    }
}

#[test]
fn vertices_that_belong_to_no_triangle_are_refused() {
    let mut points = corners();
    points.push(Vec3::splat(0.1));
    assert_eq!(refusal(points, &TETRAHEDRON), HullError::LooseVertex(4));
}

#[test]
fn vertices_that_are_there_twice_are_refused() {
    // Each triangle with corners of its own, as mesh files have them.
    let soup: Vec<Vec3> = TETRAHEDRON
        .as_flattened()
        .iter()
        .map(|&v| corners()[v as usize])
        .collect();
    let apart = [[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]];
    assert_eq!(refusal(soup, &apart), HullError::DuplicateVertex(3));
    // An unused one, and one whose zeros have other signs.
    for again in [Vec3::X, Vec3::new(1.0, -0.0, -0.0)] {
        let mut points = corners();
        points.push(again);
        assert_eq!(refusal(points, &TETRAHEDRON), HullError::DuplicateVertex(4));
    }
    let same_point = refusal(vec![Vec3::ONE; 4], &TETRAHEDRON);
    assert_eq!(same_point, HullError::DuplicateVertex(1));
}

#[test]
fn surfaces_that_are_open_or_doubled_are_refused() {
    let open = &TETRAHEDRON[..3];
    let mut doubled = TETRAHEDRON.to_vec();
    doubled.push(TETRAHEDRON[0]);
    let mut one_turned = TETRAHEDRON;
    one_turned[0].reverse();
    let back_to_back = [
        TETRAHEDRON.to_vec(),
        TETRAHEDRON.map(|[a, b, c]| [c, b, a]).to_vec(),
    ];
    for triangles in [
        open.to_vec(),
        doubled,
        one_turned.to_vec(),
        back_to_back.concat(),
    ] {
        assert_eq!(
            refusal(corners(), &triangles),
            HullError::NotManifold,
            "{triangles:?}"
        );
    }
    // Two closed surfaces, apart and sharing one vertex.
    for shared in [0, 1] {
        let mut points = corners();
        points.extend(
            corners()[shared..]
                .iter()
                .map(|p| -*p - Vec3::ONE * (1 - shared) as f32),
        );
        let second = TETRAHEDRON.map(|t| {
            let [a, b, c] = t.map(|v| {
                if v < shared as u32 {
                    v
                } else {
                    v + 4 - shared as u32
                }
            });
            [a, c, b]
        });
        let both = [TETRAHEDRON, second].concat();
        assert_eq!(
            refusal(points, &both),
            HullError::NotManifold,
            "sharing {shared}"
        );
    }
}

#[test]
fn surfaces_turned_inside_out_are_refused() {
    let inverted = TETRAHEDRON.map(|[a, b, c]| [a, c, b]);
    assert_eq!(refusal(corners(), &inverted), HullError::InsideOut);
}

#[test]
fn surfaces_with_a_dent_are_refused() {
    // A fifth vertex over the face (1, 2, 3), pushed through it.
    let raised = |height: f32| {
        let mut points = corners();
        points.push(Vec3::splat(1.0 / 3.0) + Vec3::splat(height));
        let triangles = [
            [0, 2, 1],
            [0, 1, 3],
            [0, 3, 2],
            [1, 2, 4],
            [2, 3, 4],
            [3, 1, 4],
        ];
        Hull::from_triangles(points, &triangles)
    };
    assert!(raised(0.1).is_ok(), "a hat is convex");
    assert!(raised(0.0).is_ok(), "a vertex inside of a face is allowed");
    for depth in [-0.001, -0.1, -0.2] {
        let error = raised(depth).expect_err("a dent");
        assert!(
            matches!(error, HullError::NotConvex(_)),
            "{error:?} at {depth}"
        );
    }
}

/// All edges are convex, and all triangles face outwards.
#[test]
fn surfaces_that_go_round_twice() {
    let ring = |i: usize| {
        let angle = TAU * i as f64 / 5.0;
        Vec3::new(angle.cos() as f32, angle.sin() as f32, 0.0)
    };
    let bipyramid = |step: usize| {
        let points = (0..5).map(ring).chain([Vec3::Z, Vec3::NEG_Z]).collect();
        let triangles: Vec<[u32; 3]> = (0..5)
            .map(|i| [i, (i + step) % 5].map(|v| v as u32))
            .flat_map(|[a, b]| [[a, b, 5], [b, a, 6]])
            .collect();
        Hull::from_triangles(points, &triangles)
    };
    assert!(bipyramid(1).is_ok(), "around a pentagon");
    let error = bipyramid(2).expect_err("around a pentagram");
    assert!(matches!(error, HullError::NotConvex(_)), "{error:?}");
}

#[test]
fn duplicates_do_not_disturb_a_point_cloud() {
    let mut rng = Rng::new(3);
    let points: Vec<Vec3> = (0..40).map(|_| rng.direction().as_vec3()).collect();
    let once = Hull::from_points(&points).expect("points on a sphere");
    let thrice = Hull::from_points(&[&points[..]; 3].concat()).expect("the same points");
    for _ in 0..200 {
        let dir = rng.direction();
        assert_eq!(height(&once, dir), height(&thrice, dir), "{dir}");
    }
}

#[test]
fn every_error_says_what_is_wrong() {
    let errors = [
        HullError::TooFewPoints,
        HullError::TooManyPoints,
        HullError::NotFinite(7),
        HullError::Flat,
        HullError::BadTriangle(7),
        HullError::DuplicateVertex(7),
        HullError::LooseVertex(7),
        HullError::NotManifold,
        HullError::InsideOut,
        HullError::NotConvex(7),
        HullError::BuilderFailed,
    ];
    let texts: std::collections::HashSet<String> = errors.iter().map(|e| e.to_string()).collect();
    assert_eq!(texts.len(), errors.len(), "two errors read the same");
    for text in texts
        .iter()
        .filter(|t| t.contains("point") && t.contains('7'))
    {
        assert!(text.contains("point 7"), "{text}");
    }
}

fn height(hull: &Hull, dir: DVec3) -> f64 {
    dir.dot(
        hull.support(dir, hull.start_vertex(dir), &mut Cost::default())
            .0,
    )
}

/// Builds points on an ellipsoid, and checks supports against the points.
fn build_ellipsoid(count: usize, radii: DVec3, center: DVec3) -> Hull {
    let mut rng = Rng::new(8);
    let points: Vec<Vec3> = (0..count)
        .map(|_| (center + radii * rng.direction()).as_vec3())
        .collect();
    let hull =
        Hull::from_points(&points).unwrap_or_else(|e| panic!("{count} points, radii {radii}: {e}"));
    for _ in 0..200 {
        let dir = rng.direction();
        let best = points
            .iter()
            .map(|p| dir.dot(p.as_dvec3()))
            .fold(f64::NEG_INFINITY, f64::max);
        let lost = best - height(&hull, dir);
        assert!(lost <= 1.0e-6 * hull.radius(), "{radii}: lost {lost:e}");
    }
    hull
}

#[test]
fn pebbles_needles_and_cliffs_are_built() {
    for size in [1.0e-3, 1.0, 30.0, 1.0e4] {
        for shape in [
            DVec3::ONE,
            DVec3::new(1.0, 1.0 / 128.0, 1.0 / 128.0),
            DVec3::new(1.0, 1.0, 1.0 / 128.0),
        ] {
            let hull = build_ellipsoid(100, 0.5 * size * shape, DVec3::ZERO);
            let radius = hull.radius() / size;
            assert!((0.3..0.6).contains(&radius), "{size} {shape}: {radius}");
        }
    }
}

/// Turned plates and bars, whose corners parry's builder takes for points of one plane.
#[test]
fn thin_clouds_keep_their_corners() {
    let mut rng = Rng::new(8);
    let corner = |i: u32| DVec3::from([0, 1, 2].map(|k| f64::from(i >> k & 1) - 0.5));
    for extents in [
        [1.0, 1e-3, 1.0],
        [1.0, 1e-3, 0.1],
        [1.0, 1e-4, 1.0],
        [1e-3, 1.0, 1e-3],
    ] {
        for _ in 0..100 {
            let turn = rng.rotation();
            let place = |p: DVec3| (turn * (p * DVec3::from(extents))).as_vec3();
            let corners: Vec<Vec3> = (0..8).map(corner).map(place).collect();
            let hull = Hull::from_points(&corners).expect("a solid");
            assert_eq!(hull.points().len(), 8, "{extents:?}: {corners:?}");
            let cloud: Vec<Vec3> = (0..30).map(|_| place(rng.direction())).collect();
            let hull = Hull::from_points(&cloud).expect("a solid");
            for face in hull.face_ids() {
                let height = |p: &Vec3| hull.face_normal(face).dot(p.as_dvec3());
                let highest = cloud.iter().map(height).fold(f64::MIN, f64::max);
                let beyond = highest - hull.face_offset(face);
                assert!(beyond < 1e-6, "{extents:?}: {beyond} outside of {cloud:?}");
            }
        }
    }
}

#[test]
fn a_needle_of_boxes_edges_is_built() {
    for half in [Vec3::new(64.0, 0.5, 0.5), Vec3::new(5.0e-4, 4.0e-6, 4.0e-6)] {
        let corner =
            |i: u32| half * Vec3::from_array([0, 1, 2].map(|k| (i >> k & 1) as f32 * 2.0 - 1.0));
        let hull = Hull::from_points(&(0..8).map(corner).collect::<Vec<_>>()).expect("a box");
        assert_eq!((hull.points().len(), hull.face_count()), (8, 6), "{half}");
        for face in hull.face_ids() {
            assert_eq!(hull.face_len(face), 4);
        }
    }
}

#[test]
fn flat_bipyramids_are_built_however_they_lie() {
    let mut rng = Rng::new(64);
    for size in [1.0e-3, 1.0, 30.0] {
        for height in [1.0e-2, 1.0e-3, 1.0e-4] {
            for corners in [5, 64] {
                let turn = rng.rotation();
                let rim = (0..corners).map(|i| {
                    let (sin, cos) = (TAU * f64::from(i) / f64::from(corners)).sin_cos();
                    DVec3::new(cos, sin, 0.0)
                });
                let tips = [DVec3::Z * height, -DVec3::Z * height];
                let points: Vec<Vec3> = rim
                    .chain(tips)
                    .map(|p| (turn * p * size).as_vec3())
                    .collect();
                let what = format!("{corners} corners, {size} m, height {height}");
                let hull = Hull::from_points(&points).unwrap_or_else(|e| panic!("{what}: {e}"));
                assert_eq!(hull.points().len(), points.len(), "{what}");
            }
        }
    }
}

#[test]
fn hulls_far_from_their_origin_are_built() {
    let hull = build_ellipsoid(60, DVec3::splat(0.5), DVec3::new(100.0, -50.0, 20.0));
    assert!(hull.center().distance(DVec3::new(100.0, -50.0, 20.0)) < 0.2);
}

#[test]
fn all_of_a_thousand_vertices_are_kept() {
    let mut rng = Rng::new(1000);
    let points: Vec<Vec3> = (0..1000).map(|_| rng.direction().as_vec3()).collect();
    let hull = Hull::from_points(&points).expect("points on a sphere");
    assert_eq!(hull.points().len(), points.len());
    assert_eq!(hull.face_count(), 2 * points.len() - 4);
}

#[test]
fn a_polyhedron_of_too_many_points_is_refused() {
    let count = 200;
    let ring = |j: usize| (std::f64::consts::PI * (j as f64 + 0.5) / f64::from(count)).sin_cos();
    let mut points = Vec::new();
    for j in 0..count as usize {
        let (radius, z) = ring(j);
        for i in 0..count as usize {
            let (y, x) = (TAU * i as f64 / f64::from(count)).sin_cos();
            points.push(DVec3::new(radius * x, radius * y, z).as_vec3());
        }
    }
    let polyhedron = parry3d::shape::ConvexPolyhedron::from_convex_hull(&points);
    let polyhedron = polyhedron.expect("a sphere");
    assert!(polyhedron.points().len() > 32_768);
    let refused = Hull::try_from(&polyhedron);
    assert_eq!(refused.unwrap_err(), HullError::TooManyPoints);
}

/// Whatever the number of sides, while all of its vertices have names.
#[test]
fn triangulated_prisms_of_many_sides_are_prepared() {
    for sides in [1_000, 5_000, 16_384] {
        for half in [0.2, 0.01] {
            let (points, triangles) = prism(sides, half);
            let points = points.iter().map(|p| p.as_vec3()).collect();
            let built = Hull::from_triangles(points, &triangles).map(|hull| hull.points().len());
            assert_eq!(built, Ok(2 * sides as usize), "{sides} sides, {half}");
        }
    }
}

/// Whatever the number of sides: parry's builder gives up at some 1,000 of them.
#[test]
fn prisms_and_cones_of_many_sides_are_built_from_points() {
    for (round, sides) in [1_000_u32, 2_000, 4_000, 16_384].into_iter().enumerate() {
        let (points, _) = prism(sides, 0.3);
        let turned = Rng::new(round as u128).rotation();
        for turn in [DQuat::IDENTITY, turned] {
            let cone = points.iter().filter(|p| p.z > 0.0).copied();
            let cone = cone.chain([DVec3::Z]).collect();
            for cloud in [points.clone(), cone] {
                let cloud: Vec<Vec3> = cloud.iter().map(|p| (turn * *p).as_vec3()).collect();
                let shape = HullShape::from_points(&cloud).expect("a solid");
                check_encloses(shape.hull(), &cloud);
                let is_exact = turn == DQuat::IDENTITY && sides < 4_000;
                let corners = shape.hull().points().len();
                assert!(corners == cloud.len() || !is_exact, "{sides}: {corners}");
            }
        }
    }
}

/// No point of a cloud is outside of its hull, and all corners are points of it.
fn check_encloses(hull: &Hull, cloud: &[Vec3]) {
    let mut rng = Rng::new(cloud.len() as u128);
    let faces = hull.face_ids().step_by(1 + hull.face_count() / 50);
    let normals: Vec<DVec3> = faces.map(|f| hull.face_normal(f)).collect();
    let dirs = normals.into_iter().chain((0..50).map(|_| rng.direction()));
    for dir in dirs {
        let heights = cloud.iter().map(|p| dir.dot(p.as_dvec3()));
        let best = heights.fold(f64::NEG_INFINITY, f64::max);
        let lost = best - height(hull, dir);
        assert!(lost.abs() <= 2.0e-6 * hull.radius(), "{dir}: lost {lost:e}");
    }
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    let cloud: HashSet<_> = cloud.iter().map(bits).collect();
    assert!(hull.points().iter().all(|p| cloud.contains(&bits(p))));
}

/// Grids, doubled points, points on edges and in sides, clouds with all but a few points in a line: only
/// corners remain.
#[test]
fn only_corners_of_a_cloud_stay() {
    let mut rng = Rng::new(21);
    for round in 0..300 {
        let cells = rng.count(1, 6) as u32;
        let half = DVec3::from([(); 3].map(|()| rng.count(1, 64) as f64 / 64.0));
        // Shears keep coordinates exact and make sides askew.
        let shear = DMat3::from_cols_array(&[1.0, 0.5, 0.25, 0.75, 1.0, 0.5, 0.0, 0.25, 1.0]);
        let map = if round % 2 == 0 {
            DMat3::IDENTITY
        } else {
            shear
        };
        let mut points: Vec<DVec3> = divided_block(cells, half).0;
        points.retain(|p| cells.is_power_of_two() || p.abs().cmpeq(half).all());
        points.extend(points.clone());
        points.extend((0..20).map(|_| {
            let places = [(); 3].map(|()| rng.count(0, 8) as f64 / 4.0 - 1.0);
            half * DVec3::from(places)
        }));
        for i in (1..points.len()).rev() {
            points.swap(i, rng.count(0, i));
        }
        let cloud: Vec<Vec3> = points.iter().map(|p| (map * *p).as_vec3()).collect();
        let hull = Hull::from_points(&cloud).expect("a block");
        assert_eq!(hull.points().len(), 8, "{round}");
        assert_eq!(hull.face_count(), 6, "{round}");
    }
}

/// As soon as it is known that more of the points are corners than can be named: parry's builder took a
/// minute for this cloud.
#[test]
fn clouds_of_too_many_corners_are_refused() {
    let mut rng = Rng::new(400);
    let points: Vec<Vec3> = (0..100_000).map(|_| rng.direction().as_vec3()).collect();
    assert_eq!(
        Hull::from_points(&points).unwrap_err(),
        HullError::TooManyPoints
    );
    let inner = points.iter().map(|p| *p * 0.9);
    let few = points[..20_000]
        .iter()
        .copied()
        .chain(inner)
        .collect::<Vec<_>>();
    let hull = Hull::from_points(&few).expect("a ball");
    check_encloses(&hull, &few);
}
