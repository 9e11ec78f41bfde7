//! Normals beside a seam of a compound, with the flag that corrects them and without.

use std::error::Error;

use glam::{DVec3, Vec3};
use isa_gjk::{HullShape, IsaGjkDispatcher};
use parry3d::shape::{Compound, CompoundFlags, Cuboid, SharedShape};
use rapier3d::prelude::Pose;
use testkit::pair::{Manifolds, update};

use crate::picture::ANSWER;
use crate::rule::{BEFORE, PAGE, draw_bodies, faces};
use crate::svg::{Canvas, Style, View};

/// A compound of two blocks, with corrected normals and without, under a box that is deeper in one of them than
/// it reaches over their seam.
pub fn seam() -> Result<String, Box<dyn Error>> {
    let block = brick(Vec3::new(0.4, 0.15, 0.3))?;
    let parts = [-0.4, 0.4].map(|x| (Pose::translation(x, -0.15, 0.0), block.clone()));
    let body = brick(Vec3::new(0.2, 0.15, 0.2))?;
    let pose = Pose::translation(0.17, 0.1, 0.0);
    let bodies = [
        parts
            .iter()
            .flat_map(|(at, part)| faces(part, at))
            .collect(),
        faces(&body, &pose),
    ];
    let view = View {
        axis: DVec3::X,
        yaw: 0.2,
        pitch: 0.2,
        focus: DVec3::ZERO,
        zoom: 1.0,
    };
    let points: Vec<DVec3> = bodies.iter().flatten().flatten().copied().collect();
    let mut canvas = Canvas::new(PAGE, view, points.into_iter());
    draw_bodies(&mut canvas, &bodies);
    for (flags, colour) in [
        (CompoundFlags::empty(), BEFORE),
        (CompoundFlags::FIX_INTERNAL_EDGES, ANSWER),
    ] {
        let compound = Compound::with_flags(parts.to_vec(), flags, None);
        let shapes = [SharedShape::new(compound), body.clone()];
        draw_normals(&mut canvas, &shapes, &pose, colour);
    }
    Ok(canvas.finish())
}

/// Draws an arrow along the normal of each contact.
fn draw_normals(canvas: &mut Canvas, shapes: &[SharedShape; 2], pose: &Pose, colour: &'static str) {
    let mut manifolds = Manifolds::default();
    update(&IsaGjkDispatcher::default(), shapes, pose, &mut manifolds);
    let style = Style {
        width: 2.5,
        ..Style::new(colour)
    };
    for found in &manifolds.list {
        let at = found.subshape_pos1().copied().unwrap_or(Pose::IDENTITY);
        let normal = at.transform_vector(found.local_n1).as_dvec3();
        for contact in &found.points {
            let from = at.transform_point(contact.local_p1).as_dvec3();
            canvas.arrow(from, from + 0.16 * normal, style);
            canvas.dot(from, 4.0, colour);
        }
    }
}

fn brick(half: Vec3) -> Result<SharedShape, Box<dyn Error>> {
    let (corners, _) = Cuboid::new(half).to_trimesh();
    Ok(SharedShape::new(HullShape::from_points(&corners)?))
}
