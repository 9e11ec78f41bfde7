//! Tests of clipping, against brute force in f64.

use glam::{DVec2, Vec2};

use super::*;

const SQUARE: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

fn polygon(corners: &[Vec2]) -> PolygonRows {
    let mut polygon = PolygonRows::default();
    polygon.set(corners.len(), |numbers| {
        let corners = numbers.map(|i| corners[i]);
        [corners.map(|p| p.x).into(), corners.map(|p| p.y).into()]
    });
    polygon
}

fn intersection(window: &[Vec2], subject: &[Vec2]) -> Vec<(Vec2, VertexOrigin)> {
    let mut clipper = Clipper {
        window: polygon(window),
        subject: polygon(subject),
        ..Clipper::default()
    };
    clipper.intersect();
    let corners = 0..clipper.corners.count;
    corners
        .map(|i| (clipper.corners.at(i), clipper.origin(i)))
        .collect()
}

/// Both polygons counter-clockwise.
fn clip(window: &[Vec2], polygon: &[Vec2]) -> Vec<(Vec2, VertexOrigin)> {
    let clockwise: Vec<Vec2> = polygon.iter().rev().copied().collect();
    intersection(window, &clockwise)
}

fn clip_square(polygon: [[f32; 2]; 4]) -> Vec<(Vec2, VertexOrigin)> {
    let mut corners = clip(&SQUARE.map(Vec2::from), &polygon.map(Vec2::from));
    corners.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.0.y.total_cmp(&b.0.y)));
    corners
}

#[test]
fn shifted_squares_meet_in_a_corner_of_each_and_two_crossings() {
    assert_eq!(
        clip_square(SQUARE.map(|[x, y]| [x + 0.5, y + 0.5])),
        [
            (Vec2::new(0.5, 0.5), VertexOrigin::Subject(3)),
            (Vec2::new(0.5, 1.0), VertexOrigin::Crossing(2, 3)),
            (Vec2::new(1.0, 0.5), VertexOrigin::Crossing(1, 2)),
            (Vec2::new(1.0, 1.0), VertexOrigin::Window(2)),
        ]
    );
}

#[test]
fn a_window_inside_of_the_polygon_is_the_intersection() {
    let corners = clip_square(SQUARE.map(|[x, y]| [4.0 * x - 2.0, 4.0 * y - 2.0]));
    let tags: Vec<VertexOrigin> = corners.iter().map(|corner| corner.1).collect();
    assert_eq!(tags, [0, 3, 1, 2].map(VertexOrigin::Window));
}

#[test]
fn disjoint_polygons_do_not_meet() {
    assert!(clip_square(SQUARE.map(|[x, y]| [x + 3.0, y])).is_empty());
}

#[test]
fn a_line_keeps_its_inner_part() {
    let clip_line =
        |line: [[f32; 2]; 2]| intersection(&SQUARE.map(Vec2::from), &line.map(Vec2::from));
    assert_eq!(
        clip_line([[-0.5, 0.5], [0.5, 0.5]]),
        [
            (Vec2::new(0.0, 0.5), VertexOrigin::Crossing(3, 0)),
            (Vec2::new(0.5, 0.5), VertexOrigin::Subject(1))
        ]
    );
    assert_eq!(
        clip_line([[0.25, 2.0], [0.25, -2.0]]),
        [
            (Vec2::new(0.25, 0.0), VertexOrigin::Crossing(0, 0)),
            (Vec2::new(0.25, 1.0), VertexOrigin::Crossing(2, 0))
        ]
    );
    assert!(clip_line([[-1.0, 2.0], [2.0, 2.0]]).is_empty());
    assert!(clip_line([[-1.0, 0.5], [0.5, 2.0]]).is_empty());
}

fn ellipse(count: usize, rng: &mut oorandom::Rand64) -> Vec<Vec2> {
    let [x, y, a, b, turn] = [(); 5].map(|()| rng.rand_float() as f32);
    (0..count)
        .map(|i| {
            let angle = std::f32::consts::TAU * (i as f32 / count as f32 + turn);
            let (sin, cos) = angle.sin_cos();
            Vec2::new(x + (0.2 + a) * cos, y + (0.2 + b) * sin)
        })
        .collect()
}

fn is_inside(p: DVec2, polygon: &[Vec2], slack: f64) -> bool {
    let corners = polygon.iter().map(|corner| corner.as_dvec2());
    let ends = corners.clone().cycle().skip(1);
    let mut sides = corners.zip(ends);
    sides.all(|(a, b)| (b - a).perp_dot(p - a) >= -slack * (b - a).length())
}

/// All possible corners of the intersection, from every pair of sides.
fn candidates(a: &[Vec2], b: &[Vec2]) -> Vec<DVec2> {
    let side = |p: &[Vec2], i: usize| [p[i], p[(i + 1) % p.len()]].map(|v| v.as_dvec2());
    let mut found: Vec<DVec2> = a.iter().chain(b).map(|v| v.as_dvec2()).collect();
    for i in 0..a.len() {
        for j in 0..b.len() {
            let ([p, p2], [q, q2]) = (side(a, i), side(b, j));
            let (d, e) = (p2 - p, q2 - q);
            // Nearly parallel sides may cross anywhere.
            if d.perp_dot(e).abs() > 1e-4 * d.length() * e.length() {
                found.push(p + d * ((q - p).perp_dot(e) / d.perp_dot(e)));
            }
        }
    }
    found.retain(|&p| is_inside(p, a, 1e-12) && is_inside(p, b, 1e-12));
    found
}

/// Divides each side of an outline into `times` parts, like a divided flat end.
fn divided(outline: &[Vec2], times: usize) -> Vec<Vec2> {
    let ends = outline.iter().cycle().skip(1);
    let along = |(a, b): (&Vec2, &Vec2)| {
        let (a, b) = (*a, *b);
        (0..times).map(move |i| a.lerp(b, i as f32 / times as f32))
    };
    outline.iter().zip(ends).flat_map(along).collect()
}

/// Ellipses; in some rounds one of them is equal, divided or thin.
fn many_corners(round: u32, rng: &mut oorandom::Rand64) -> [Vec<Vec2>; 2] {
    let counts = [(); 2].map(|()| rng.rand_range(3..90) as usize);
    let [mut window, mut subject] = counts.map(|count| ellipse(count, rng));
    let tiny = Vec2::splat(6e-8 * (round % 7) as f32);
    match round % 6 {
        0 => subject = window.iter().map(|&p| p + tiny).collect(),
        1 => window = divided(&SQUARE.map(Vec2::from), 20),
        2 => {
            window = divided(&window[..3], 30);
            subject = divided(&subject[..3], 25);
        }
        3 => subject.iter_mut().for_each(|p| p.y = 0.3 + 1e-3 * p.y),
        4 => {
            let turn = Vec2::from_angle(rng.rand_float() as f32);
            window = divided(&SQUARE.map(Vec2::from), 20);
            window.iter_mut().for_each(|p| *p = p.rotate(turn));
            subject = window.iter().map(|p| *p + tiny).collect();
        }
        _ => {}
    }
    [window, subject]
}

/// Polygons of many corners, of which only near sides are compared: also thin and equal ones, and such
/// with straight runs. No corner is missing that is found by comparing all sides.
#[test]
fn near_sides_are_enough() {
    let mut rng = oorandom::Rand64::new(3);
    let mut by_sectors = 0;
    for round in 0..600 {
        let [window, mut subject] = many_corners(round, &mut rng);
        subject.reverse();
        let mut clipper = Clipper {
            window: polygon(&window),
            subject: polygon(&subject),
            ..Clipper::default()
        };
        let found = |clipper: &Clipper| -> Vec<(Vec2, VertexOrigin)> {
            let corners = 0..clipper.corners.count;
            let corner = |i| (clipper.corners.at(i), clipper.origin(i));
            corners.map(corner).collect()
        };
        if !clipper.intersect_sectors() {
            continue;
        }
        by_sectors += 1;
        let near = found(&clipper);
        clipper.corners.count = 0;
        clipper.intersect_many();
        let all = found(&clipper);
        let is_found = |at: Vec2| near.iter().any(|other| other.0.distance(at) < 2e-6);
        let missing = all.iter().find(|corner| !is_found(corner.0));
        assert_eq!(missing, None, "round {round}");
        // Far sides in a straight run may reject a corner by rounding.
        subject.reverse();
        for (at, tag) in near {
            let inside = |polygon| is_inside(at.as_dvec2(), polygon, 4e-6);
            assert!(
                inside(&window) && inside(&subject),
                "round {round}: {at} of {tag:?}"
            );
        }
    }
    assert!(by_sectors > 500, "only {by_sectors}");
}

/// Against brute force in f64. Includes equal polygons, and polygons that are turned or shifted by a
/// rounding, with few corners (one row) and with more.
#[test]
fn the_corners_are_those_of_the_intersection() {
    let mut rng = oorandom::Rand64::new(2);
    for round in 0..4000 {
        let most = if round % 8 < 4 { 5 } else { 14 };
        let counts = [(); 2].map(|()| rng.rand_range(3..most) as usize);
        let window = ellipse(counts[0], &mut rng);
        let tiny = Vec2::splat(6e-8 * (round % 7) as f32);
        let polygon = match round % 4 {
            0 => window.iter().map(|&p| p + tiny).collect(),
            1 => window
                .iter()
                .map(|p| p.rotate(Vec2::from_angle(tiny.x)))
                .collect(),
            _ => ellipse(counts[1], &mut rng),
        };
        let corners = clip(&window, &polygon);
        for (at, tag) in &corners {
            for polygon in [&window, &polygon] {
                let inside = is_inside(at.as_dvec2(), polygon, 4e-6);
                assert!(inside, "round {round}: {at} of {tag:?} is outside");
            }
        }
        for p in candidates(&window, &polygon) {
            let near = |(at, _): &(Vec2, VertexOrigin)| at.as_dvec2().distance(p) < 1e-4;
            assert!(corners.iter().any(near), "round {round}: {p} is missing");
        }
    }
}
