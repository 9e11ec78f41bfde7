//! The contacts of one pair as a small picture.

use std::error::Error;

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use isa_gjk::query::ContactPatch;
use parry3d::query::ContactManifold;
use parry3d::shape::SharedShape;
use rapier3d::prelude::Pose;
use testkit::pair::{Manifolds, PREDICTION, update};

use crate::picture::{ANSWER, HULLS, PATCH};
use crate::shape_faces;
use crate::svg::{Canvas, Page, Style, View};

pub const PAGE: Page = Page {
    width: 420.0,
    height: 280.0,
    text: 420.0,
};
/// Bodies of more faces look round.
const FEW_FACES: usize = 20;
/// The colour of what is shown to compare with.
pub const BEFORE: &str = "#888888";

/// Two shapes, and where the second one is in one update after the other.
pub struct Rule {
    pub name: &'static str,
    pub shapes: [SharedShape; 2],
    pub poses: Vec<Pose>,
    /// The direction to the right, and the angles from which one looks.
    pub axis: DVec3,
    pub pitch: f64,
    pub yaw: f64,
    pub zoom: f64,
}

impl Rule {
    /// At one pose, seen from above and aside.
    pub fn new(name: &'static str, shapes: [SharedShape; 2], pose: Pose) -> Self {
        Self {
            name,
            shapes,
            poses: vec![pose],
            axis: DVec3::X,
            pitch: 0.5,
            yaw: 0.5,
            zoom: 1.0,
        }
    }

    /// The last update, with the contacts of the one before.
    pub fn picture(&self) -> Result<String, Box<dyn Error>> {
        let mut manifolds = Manifolds::default();
        let mut before = None;
        for pose in &self.poses {
            before = manifolds.list.first().cloned();
            update(
                &IsaGjkDispatcher::default(),
                &self.shapes,
                pose,
                &mut manifolds,
            );
        }
        let found = &manifolds.list[0];
        let pose = self.poses.last().ok_or("no pose")?;
        let [a, b] = &self.shapes;
        let patch = ContactPatch::between(&**a, &**b, pose, PREDICTION);

        let placed = [Pose::IDENTITY, *pose];
        let bodies = [0, 1].map(|i| faces(&self.shapes[i], &placed[i]));
        let first = found.points.first().ok_or("no contact")?;
        let view = View {
            axis: self.axis,
            yaw: self.yaw,
            pitch: self.pitch,
            focus: first.local_p1.as_dvec3(),
            zoom: self.zoom,
        };
        let mut canvas = Canvas::new(PAGE, view, bodies.iter().flatten().flatten().copied());
        draw_bodies(&mut canvas, &bodies);
        if before.is_some() {
            let style = Style::new(BEFORE);
            let faces = faces(&self.shapes[1], &self.poses[0]);
            faces.iter().for_each(|face| canvas.polygon(face, style));
        }
        if let Ok(Some(patch)) = &patch {
            draw_patch(&mut canvas, patch, before.is_some());
        }
        draw_contacts(&mut canvas, found, pose);
        Ok(canvas.finish())
    }
}

/// Draws the faces of both bodies.
pub fn draw_bodies(canvas: &mut Canvas, bodies: &[Vec<Vec<DVec3>>; 2]) {
    for (faces, colour) in bodies.iter().zip(HULLS) {
        for is_front in [false, true] {
            let style = Style {
                opacity: if is_front { 0.12 } else { 0.0 },
                width: match (is_front, faces.len() > FEW_FACES) {
                    (true, false) => 0.8,
                    (true, true) => 0.3,
                    (false, _) => 0.2,
                },
                ..Style::new(colour)
            };
            let is_drawn =
                |face: &&Vec<DVec3>| canvas.faces_viewer(shape_faces::outward(face)) == is_front;
            let drawn: Vec<_> = faces.iter().filter(is_drawn).collect();
            drawn.iter().for_each(|face| canvas.polygon(face, style));
        }
    }
}

/// The whole region of contact, and those of its corners that are no contacts.
fn draw_patch(canvas: &mut Canvas, patch: &ContactPatch, is_close: bool) {
    let corners: Vec<DVec3> = patch.vertices.iter().map(|vertex| vertex.on_1).collect();
    let style = Style {
        opacity: if is_close { 0.15 } else { 0.35 },
        width: 1.0,
        ..Style::new(PATCH)
    };
    canvas.polygon(&corners, style);
    if !is_close {
        corners.iter().for_each(|at| canvas.circle(*at, 4.0, PATCH));
    }
}

/// The points of each contact on both bodies, and its distance in millimetres. The deepest one has a ring.
fn draw_contacts(canvas: &mut Canvas, found: &ContactManifold<(), ()>, pose: &Pose) {
    for (i, contact) in found.points.iter().enumerate() {
        let on_1 = contact.local_p1.as_dvec3();
        let on_2 = pose.transform_point(contact.local_p2).as_dvec3();
        let style = Style {
            width: 2.0,
            ..Style::new(ANSWER)
        };
        if i == 0 {
            canvas.circle(on_1, 8.0, ANSWER);
        }
        canvas.line(on_1, on_2, style);
        let across = (on_2 - on_1).reject_from(found.local_n1.as_dvec3());
        let has_slid = across.length() > 1e-4;
        for (point, colour) in [on_1, on_2].into_iter().zip(HULLS) {
            canvas.dot(point, 4.5, if has_slid { colour } else { ANSWER });
        }
        let millimetres = format!("{:.1}", 1e3 * contact.dist).replace('-', "\u{2212}");
        canvas.label(on_1, &millimetres);
    }
}

/// The faces of a shape at a pose.
pub fn faces(shape: &SharedShape, pose: &Pose) -> Vec<Vec<DVec3>> {
    let place = |p: DVec3| pose.transform_point(p.as_vec3()).as_dvec3();
    let faces = shape_faces::faces(&**shape).into_iter();
    faces
        .map(|face| face.into_iter().map(place).collect())
        .collect()
}
