//! Families of pairs on which contacts were once lost or invented.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use isa_gjk::HullShape;
use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::{SharedShape, TriMeshFlags};

use super::cases::Hull;
use super::divided::{Mesh, divided_block, divided_icosahedron};
use super::generate::{Rng, prepared};
use super::oracle::Solid;
use super::pose::ExactPose;

/// A pair at one time. The shapes may change from one frame to the next.
pub struct Frame {
    pub shapes: [SharedShape; 2],
    pub solids: [Solid; 2],
    pub pose: ExactPose,
    pub prediction: f64,
}

/// Makes the frames of a pair.
type Family = fn(&mut Rng) -> Vec<Frame>;

/// All families by name.
pub const FAMILIES: [(&str, Family); 6] = [
    ("divided sides", divided_sides),
    ("thin hulls", thin_hulls),
    ("exact touches", exact_touches),
    ("shapes that come and go", come_and_go),
    ("many sides", many_sides),
    ("unequal sizes", unequal_sizes),
];

/// A body that is built anew for each use, so that its address changes, too.
struct Body {
    solid: Solid,
    is_prepared: bool,
}

impl Body {
    fn of(hull: Hull, rng: &mut Rng) -> Self {
        Self {
            solid: hull.solid,
            is_prepared: rng.count(0, 1) == 0,
        }
    }

    /// `None` where rounding has made it no hull.
    fn of_mesh(mesh: &Mesh, rng: &mut Rng) -> Option<Self> {
        let rounded = mesh.0.iter().map(|p| p.as_vec3().as_dvec3()).collect();
        let body = Self {
            solid: Solid::new(rounded, &mesh.1),
            is_prepared: rng.count(0, 1) == 0,
        };
        HullShape::from_triangles(body.points(), body.solid.faces()).ok()?;
        Some(body)
    }

    fn points(&self) -> Vec<Vector> {
        self.solid.points.iter().map(|p| p.as_vec3()).collect()
    }

    fn shape(&self) -> SharedShape {
        let plain = SharedShape::convex_mesh(self.points(), self.solid.faces()).expect("a surface");
        if self.is_prepared {
            prepared(&plain)
        } else {
            plain
        }
    }

    fn solid(&self) -> Solid {
        self.solid.with_points(self.solid.points.iter().copied())
    }
}

/// Frames of two bodies that stay.
fn frames(bodies: &[Body; 2], poses: &[ExactPose], prediction: f64) -> Vec<Frame> {
    let shapes = bodies.each_ref().map(Body::shape);
    let frame = |pose: &ExactPose| Frame {
        shapes: shapes.clone(),
        solids: bodies.each_ref().map(Body::solid),
        pose: pose.rounded(),
        prediction,
    };
    poses.iter().map(frame).collect()
}

/// A pose in which the second body, turned by `rotation`, is `gap` away along `normal`, which need not
/// be how far they are apart.
fn beside(solids: [&Solid; 2], rotation: DQuat, normal: DVec3, gap: f64) -> ExactPose {
    let reach = solids[0].support(normal) + solids[1].support(-(rotation.inverse() * normal));
    ExactPose {
        rotation,
        translation: normal * (reach + gap),
    }
    .rounded()
}

/// A slab or a facetted ball whose sides hold inner vertices, turned before it was rounded, perhaps with
/// noise. It lies on a box, turns over and back, and creeps.
fn divided_sides(rng: &mut Rng) -> Vec<Frame> {
    loop {
        let half = DVec3::new(
            1.0,
            rng.range(0.1, 1.0),
            [0.5, 0.1, 0.02, 0.003][rng.count(0, 3)],
        );
        let mesh = match rng.count(0, 3) {
            0 => divided_icosahedron(rng.count(1, 2), rng.count(0, 1) == 0),
            _ => divided_block(rng.count(2, 12) as u32, half),
        };
        let (turn, noise) = (rng.rotation(), [0.0, 0.0, 1e-7, 3e-7][rng.count(0, 3)]);
        let points = mesh.0.iter().map(|&p| turn * p + rng.direction() * noise);
        let mesh = (points.collect(), mesh.1);
        let Some(slab) = Body::of_mesh(&mesh, rng) else {
            continue;
        };
        let Some(ground) = Body::of_mesh(&divided_block(1, DVec3::new(3.0, 3.0, 0.5)), rng) else {
            continue;
        };
        let lying = turn.inverse();
        let gap = rng.range(-0.02, 0.02);
        let mut poses = Vec::new();
        for _ in 0..4 {
            let axis = DVec3::new(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0), 0.0).normalize();
            let over = DQuat::from_axis_angle(axis, [0.0, PI][rng.count(0, 1)]);
            let tilt =
                DQuat::from_scaled_axis(rng.direction() * [0.0, 1e-4, 1e-2][rng.count(0, 2)]);
            let rotation = tilt * over * lying;
            poses.push(beside(
                [&ground.solid, &slab.solid],
                rotation,
                DVec3::Z,
                gap,
            ));
        }
        return frames(&[ground, slab], &poses, [0.0, 0.02, 0.5][rng.count(0, 2)]);
    }
}

/// Blades, needles, wedges and plates beside, on and in each other; the prediction may be far larger than
/// they are thick.
fn thin_hulls(rng: &mut Rng) -> Vec<Frame> {
    let bodies = [(); 2].map(|()| {
        let size = rng.range(0.5, 2.0);
        let hull = rng.any_hull(size);
        Body::of(hull, rng)
    });
    let solids = bodies.each_ref().map(|body| &body.solid);
    let mut poses = Vec::new();
    for _ in 0..3 {
        let pose = match rng.count(0, 1) {
            0 => beside(
                solids,
                rng.any_turn(),
                rng.direction(),
                rng.range(-0.3, 0.1),
            ),
            _ => ExactPose {
                rotation: rng.any_turn(),
                translation: rng.any_place(1.0),
            },
        };
        let creep = rng.direction() * 1e-3;
        poses.extend([0.0, 1.0].map(|steps| ExactPose {
            translation: pose.translation + creep * steps,
            ..pose
        }));
    }
    let prediction = [0.0, 0.002, 0.2, 5.0][rng.count(0, 3)];
    frames(&bodies, &poses, prediction)
}

/// Solids of small whole coordinates that touch exactly: at a corner, along an edge or over a face.
fn exact_touches(rng: &mut Rng) -> Vec<Frame> {
    let bodies = [(); 2].map(|()| {
        let half = DVec3::from([(); 3].map(|()| rng.count(1, 4) as f64 / 4.0));
        let block = divided_block([1, 1, 2, 4][rng.count(0, 3)], half);
        Body::of_mesh(&block, rng).expect("exact coordinates")
    });
    let corner = |body: &Body, rng: &mut Rng| {
        let points = &body.solid.points;
        points[rng.count(0, points.len() - 1)]
    };
    let mut poses = Vec::new();
    for _ in 0..4 {
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][rng.count(0, 2)];
        let rotation = DQuat::from_axis_angle(axis, [0.0, 0.5 * PI, PI][rng.count(0, 2)]);
        let place = corner(&bodies[0], rng) - rotation * corner(&bodies[1], rng);
        poses.push(ExactPose {
            rotation,
            translation: (place * 64.0).round() / 64.0,
        });
    }
    frames(&bodies, &poses, [0.0, 0.02][rng.count(0, 1)])
}

/// One of the bodies is another one in each frame, or the same somewhere else in memory.
fn come_and_go(rng: &mut Rng) -> Vec<Frame> {
    let vertices = rng.count(4, 60);
    let mut bodies = [(); 2].map(|()| Body::of(rng.hull(vertices, 1.0), rng));
    let normal = rng.direction();
    let mut all = Vec::new();
    for _ in 0..6 {
        let solids = bodies.each_ref().map(|body| &body.solid);
        let gap = rng.range(-0.2, 0.05);
        let pose = beside(solids, rng.rotation(), normal, gap);
        all.extend(frames(&bodies, &[pose], 0.05));
        if rng.count(0, 2) > 0 {
            let vertices = [vertices, rng.count(4, 200)][rng.count(0, 1)];
            let size = [1.0, 0.1, 4.0][rng.count(0, 2)];
            bodies[rng.count(0, 1)] = Body::of(rng.hull(vertices, size), rng);
        }
    }
    all
}

/// The surface of a prism along z.
pub fn prism(sides: u32, half: f64) -> Mesh {
    let corner = |i: u32| {
        let (y, x) = (TAU * f64::from(i) / f64::from(sides)).sin_cos();
        [-half, half].map(|z| DVec3::new(x, y, z))
    };
    let mut triangles = Vec::new();
    for i in 0..sides {
        let (a, b) = (2 * i, 2 * ((i + 1) % sides));
        triangles.extend([[a, b, a + 1], [b, b + 1, a + 1]]);
        if a > 0 && b > 0 {
            triangles.extend([[1, a + 1, b + 1], [0, b, a]]);
        }
    }
    ((0..sides).flat_map(corner).collect(), triangles)
}

/// Discs and drums of many sides on each other, as they are or turned before they were rounded.
fn many_sides(rng: &mut Rng) -> Vec<Frame> {
    loop {
        let turns = [(); 2].map(|()| [DQuat::IDENTITY, rng.rotation()][rng.count(0, 1)]);
        let bodies = turns.map(|turn| {
            let sides = [20, 60, 100, 150][rng.count(0, 3)];
            let (points, triangles) = prism(sides, [0.3, 0.01][rng.count(0, 1)]);
            let turned = points.iter().map(|&p| turn * p).collect();
            Body::of_mesh(&(turned, triangles), rng)
        });
        let [Some(a), Some(b)] = bodies else { continue };
        let up = turns[0] * DVec3::Z;
        let mut poses = Vec::new();
        for step in 0..3 {
            let spin = DQuat::from_axis_angle(up, 0.01 * f64::from(step));
            let tilt = DQuat::from_scaled_axis(rng.direction() * [0.0, 1e-3, 1.5][rng.count(0, 2)]);
            let rotation = tilt * spin * turns[0] * turns[1].inverse();
            let mut pose = beside([&a.solid, &b.solid], rotation, up, rng.range(-0.02, 0.02));
            pose.translation += (turns[0] * DVec3::X) * rng.range(-0.9, 0.9);
            poses.push(pose);
        }
        return frames(&[a, b], &poses, 0.02);
    }
}

/// A small body in or beside a large one.
fn unequal_sizes(rng: &mut Rng) -> Vec<Frame> {
    let ratio = 10_f64.powf(rng.range(-4.0, -1.0));
    let large = rng.any_hull(1.0);
    let small = rng.any_hull(ratio);
    let bodies = [large, small].map(|hull| Body::of(hull, rng));
    let solids = bodies.each_ref().map(|body| &body.solid);
    let mut poses = Vec::new();
    for _ in 0..4 {
        let gap = rng.range(-3.0, 1.0) * ratio;
        poses.push(beside(solids, rng.rotation(), rng.direction(), gap));
    }
    let mut all = frames(&bodies, &poses, [0.0, ratio, 0.2][rng.count(0, 2)]);
    if rng.count(0, 1) == 0 {
        for frame in &mut all {
            frame.shapes.swap(0, 1);
            frame.solids.swap(0, 1);
            frame.pose = frame.pose.inverse().rounded();
        }
    }
    all
}

/// The side of a cell of [`flat_mesh`].
const CELL: Real = 0.25;

/// A flat square in y = 0 of 8 x 8 cells of two triangles, with its inner edges corrected.
pub fn flat_mesh() -> SharedShape {
    let point = |i: u32| Vector::new((i % 9) as Real - 4.0, 0.0, (i / 9) as Real - 4.0) * CELL;
    let cell = |i: u32| {
        let v = i / 8 * 9 + i % 8;
        [[v, v + 9, v + 1], [v + 1, v + 9, v + 10]]
    };
    let points = (0..81).map(point).collect();
    let triangles = (0..64).flat_map(cell).collect();
    SharedShape::trimesh_with_flags(points, triangles, TriMeshFlags::FIX_INTERNAL_EDGES)
        .expect("a mesh")
}

/// A standing plate that has sunk into [`flat_mesh`] by up to some of its thicknesses.
pub fn sunk_plate(rng: &mut Rng) -> (SharedShape, Pose) {
    let thickness = 0.5_f64.powi(rng.count(3, 6) as i32);
    let half = DVec3::new(0.25, rng.range(0.1, 0.25), thickness);
    let corner = |i: u32| {
        let side = |bit: u32| f64::from(i >> bit & 1) * 2.0 - 1.0;
        (half * DVec3::new(side(0), side(1), side(2))).as_vec3()
    };
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    let plate = SharedShape::convex_hull(&corners).expect("a plate");
    let turn = DQuat::from_rotation_y(rng.range(0.0, 3.0));
    let depth = half.z * [0.25, 0.5, 1.0, 2.0, 4.0][rng.count(0, 4)];
    let place = DVec3::new(rng.range(-0.6, 0.6), half.y - depth, rng.range(-0.6, 0.6));
    (plate, Pose::from_parts(place.as_vec3(), turn.as_quat()))
}
