//! Surfaces whose flat sides are divided into many triangles.

use std::collections::HashMap;

use glam::DVec3;

/// A surface: points and triangles.
pub type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// A block whose upper and lower sides are divided into `cells` by `cells`, each of two triangles.
pub fn divided_block(cells: u32, half: DVec3) -> Mesh {
    let row = cells + 1;
    let count = row * row;
    let corner = |v: u32| {
        let place = |i: u32| 2.0 * f64::from(i) / f64::from(cells) - 1.0;
        let side = if v < count { -1.0 } else { 1.0 };
        DVec3::new(place(v % count % row), place(v % count / row), side) * half
    };
    let mut triangles = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let v = j * row + i;
            let cell = [[v, v + row, v + 1], [v + 1, v + row, v + row + 1]];
            triangles.extend(cell);
            triangles.extend(
                cell.map(|t| t.map(|v| v + count))
                    .map(|[a, b, c]| [a, c, b]),
            );
        }
    }
    let south = 0..cells;
    let east = (0..cells).map(|j| j * row + cells);
    let north = (1..row).rev().map(|i| cells * row + i);
    let west = (1..row).rev().map(|j| j * row);
    let rim: Vec<u32> = south.chain(east).chain(north).chain(west).collect();
    for (i, &a) in rim.iter().enumerate() {
        let b = rim[(i + 1) % rim.len()];
        triangles.extend([[a, b, a + count], [b, b + count, a + count]]);
    }
    ((0..2 * count).map(corner).collect(), triangles)
}

/// An icosahedron, each facet of which is divided `times` times into four in its plane, or on the
/// sphere.
pub fn divided_icosahedron(times: usize, on_sphere: bool) -> Mesh {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut points = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        points.extend([
            DVec3::new(0.0, a, b),
            DVec3::new(a, b, 0.0),
            DVec3::new(b, 0.0, a),
        ]);
    }
    let mut triangles = Vec::new();
    let near = |a: usize, b: usize, p: &[DVec3]| p[a].distance(p[b]) < 2.1;
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b, &points) && near(b, c, &points) && near(a, c, &points) {
                    let out = (points[b] - points[a])
                        .cross(points[c] - points[a])
                        .dot(points[a]);
                    let [b, c] = if out > 0.0 { [b, c] } else { [c, b] };
                    triangles.push([a, b, c].map(|v| v as u32));
                }
            }
        }
    }
    for _ in 0..times {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]) / 2.0);
                points.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
        if on_sphere {
            for p in &mut points {
                *p = p.normalize() * 2.0;
            }
        }
    }
    (points, triangles)
}
