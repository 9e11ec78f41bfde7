use super::*;
use std::f32::consts::TAU;

use glam::{DVec3, EulerRot, Quat};
use parry3d::shape::ConvexPolyhedron;

use crate::hull::build::canonical::canonical_hull;
use crate::hull::build::face_loops::sorted;
use crate::hull::build::flat_sides::{FlatFaces, from_lowest};
use crate::hull::build::surface::Surface;
use crate::hull::surface_of_points;

fn ball(rng: &mut oorandom::Rand64, count: usize) -> Vec<Vec3> {
    let mut coordinate = || 2.0 * rng.rand_float() as f32 - 1.0;
    let mut point = |_| Vec3::from([(); 3].map(|()| coordinate()));
    let normalized = |p: Vec3| p.normalize_or(Vec3::X);
    (0..count).map(|i| normalized(point(i))).collect()
}

fn below(rng: &mut oorandom::Rand64, count: usize) -> usize {
    rng.rand_range(0..count as u64) as usize
}

fn shuffled(rng: &mut oorandom::Rand64, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut shuffled = triangles.to_vec();
    for i in 0..shuffled.len() {
        shuffled.swap(i, below(rng, i + 1));
        shuffled[i].rotate_left(below(rng, 3));
    }
    shuffled
}

/// All but the id, which no two hulls share.
fn parts(hull: &Hull) -> String {
    let Hull {
        center,
        radius,
        points,
        graph,
        faces,
        search,
        id: _,
        oriented_box,
    } = hull;
    format!("{center:?} {radius:?} {points:?} {graph:?} {faces:?} {search:?} {oriented_box:?}")
}

#[test]
fn hulls_are_the_same_as_by_all_passes() {
    let mut rng = oorandom::Rand64::new(11);
    let mut built = [0; 3];
    for round in 0..400 {
        let count = 4 + round % 61;
        let stretch = [Vec3::ONE, Vec3::new(1.0, 0.05, 0.3), Vec3::splat(1e-3)][round % 3];
        let points: Vec<Vec3> = ball(&mut rng, count).iter().map(|&p| p * stretch).collect();
        let surface = surface_of_points(&points).expect("a solid");
        let (points, mut triangles) = (surface.vertices, surface.triangles);
        let any_order = shuffled(&mut rng, &triangles);
        let Some(hull) = steep_hull(&points, &any_order, &Rows::default()) else {
            continue;
        };
        built[round % 3] += 1;
        triangles = triangles.into_iter().map(from_lowest).collect();
        triangles.sort_unstable();
        let other = Surface::new(points, &triangles).and_then(Surface::into_hull);
        assert_eq!(parts(&hull), parts(&other.expect("a hull")));
    }
    assert!(
        built.iter().sum::<i32>() >= 380,
        "only {built:?} of 400 were built"
    );
}

/// A surface with a wrong triangle, or with a vertex moved inwards, has no hull.
#[test]
fn surfaces_that_are_not_convex_are_left_alone() {
    let mut rng = oorandom::Rand64::new(12);
    for round in 0..200 {
        let points = ball(&mut rng, 8 + round % 50);
        let surface = surface_of_points(&points).expect("a solid");
        let (points, triangles) = (surface.vertices, surface.triangles);
        let mut wrong = triangles.clone();
        let some = below(&mut rng, wrong.len());
        let [a, b, c] = wrong[some];
        wrong[some] = [
            [a, c, b],
            [a, b, b],
            [a, b, 64],
            wrong[(some + 1) % wrong.len()],
        ][round % 4];
        assert!(steep_hull(&points, &wrong, &Rows::default()).is_none());
        let mut dented = points.clone();
        let vertex = below(&mut rng, points.len());
        dented[vertex] *= [0.2, -1.0, -30.0, f32::NAN][round % 4];
        let dented = steep_hull(&dented, &triangles, &Rows::default());
        assert!(dented.is_none(), "round {round}");
    }
}

/// Boxes, prisms and frusta, turned so that their corners are rounded.
fn with_flat_sides(rng: &mut oorandom::Rand64, round: usize) -> Vec<Vec3> {
    let mut number = || rng.rand_float() as f32;
    let sides = 3 + round % 28;
    let [top, height, x, y, z] = [(); 5].map(|()| 0.3 + number());
    let turn = if round.is_multiple_of(3) {
        Quat::from_euler(EulerRot::XYZ, x, y, z)
    } else {
        Quat::IDENTITY
    };
    let corner = |i: usize| {
        let (sin, cos) = (TAU * (i / 2) as f32 / sides as f32).sin_cos();
        let is_top = i.is_multiple_of(2);
        let scale = if is_top && round % 2 == 1 { top } else { 1.0 };
        turn * Vec3::new(
            scale * cos,
            if is_top { height } else { -height },
            scale * sin,
        )
    };
    (0..2 * sides).map(corner).collect()
}

#[test]
fn hulls_with_flat_sides_are_the_same_as_by_all_passes() {
    let mut rng = oorandom::Rand64::new(13);
    let mut built = 0;
    for round in 0..300 {
        let points = with_flat_sides(&mut rng, round);
        let Some(polyhedron) = ConvexPolyhedron::from_convex_hull(&points) else {
            continue;
        };
        let points = polyhedron.points().to_vec();
        let exact: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
        let Some(faces) = FlatFaces::of(&polyhedron, &exact, 2.0) else {
            continue;
        };
        let any_order = shuffled(&mut rng, &faces.triangles);
        let Some(hull) = steep_hull(&points, &any_order, &faces.polygons) else {
            continue;
        };
        built += 1;
        let triangles = sorted(&faces.triangles, points.len()).expect("corners");
        let other = Surface::new(points, &triangles).and_then(Surface::into_hull);
        assert_eq!(parts(&hull), parts(&other.expect("a hull")));
    }
    assert!(built >= 200, "only {built} of 300 were built");
}

/// A hull of points has a polyhedron whose hull it is. So a saved world goes on as it was.
#[test]
fn hulls_of_points_are_those_of_their_polyhedra() {
    let mut rng = oorandom::Rand64::new(14);
    let mut built = [0; 4];
    for round in 0..400 {
        let points = match round % 4 {
            0 => ball(&mut rng, 4 + round % 120),
            1 => with_flat_sides(&mut rng, round),
            2 => {
                let grid = |p: Vec3| (3.0 * p).round();
                ball(&mut rng, 30).into_iter().map(grid).collect()
            }
            _ => {
                let needle = Vec3::new(1.0, 0.01, 0.02);
                let points = ball(&mut rng, 4 + round % 60).into_iter();
                points.map(|p| p * needle).collect()
            }
        };
        let surface = surface_of_points(&points).expect("a solid");
        let hull = canonical_hull(&surface.vertices, &surface.triangles, surface.seem_flat);
        let Some(hull) = hull else {
            continue;
        };
        built[round % 4] += 1;
        let triangles = hull.triangles();
        let polyhedron = ConvexPolyhedron::from_convex_mesh(hull.points.to_vec(), &triangles);
        let other = Hull::try_from(&polyhedron.expect("a polyhedron"));
        assert_eq!(
            parts(&hull),
            parts(&other.expect("a hull")),
            "round {round}"
        );
    }
    assert!(
        built.iter().all(|&count| count >= 50),
        "{built:?} of 100 each"
    );
}
