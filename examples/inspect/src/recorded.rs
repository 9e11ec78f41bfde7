//! What is to be seen of a pair in a recording.

use std::path::Path;

use glam::DVec3;
use isa_gjk::IsaGjkDispatcher;
use isa_gjk::query::{Certificate, ContactPatch, QueryError, SeparationBounds};
use isa_gjk::recording::{self, RecordedPair};
use parry3d::query::ContactManifold;
use parry3d::shape::{Shape, TypedShape};

use crate::picture::{ANSWER, HULLS, PATCH, REMEMBERED};
use crate::shape_faces;
use crate::svg::{Canvas, PITCH, Page, Style, View};

/// A pair of a recording, beside what is known of it now.
pub struct Recorded {
    pair: RecordedPair,
    now: ContactManifold<(), ()>,
    bounds: Result<SeparationBounds, QueryError>,
    patch: Option<ContactPatch>,
}

impl Recorded {
    /// The pair with this number, counted from 0, in a file.
    pub fn open(path: &Path, number: usize) -> Result<Self, String> {
        Ok(Self::new(testkit::recorded::pair(path, number)?))
    }

    fn new(pair: RecordedPair) -> Self {
        let [a, b] = pair.shapes.each_ref().map(|shape| &**shape);
        let patch = ContactPatch::between(a, b, &pair.pos12, pair.prediction);
        Self {
            now: pair.update(&IsaGjkDispatcher::default()),
            bounds: SeparationBounds::between(a, b, &pair.pos12),
            patch: patch.ok().flatten(),
            pair,
        }
    }

    /// The pair in words.
    pub fn summary(&self) -> Vec<String> {
        let pair = &self.pair;
        let suspicion = |found: Option<recording::Suspicion>| {
            found.map_or("nothing looks wrong", recording::Suspicion::name)
        };
        let now = RecordedPair {
            after: self.now.clone(),
            ..pair.clone()
        };
        let [a, b] = pair.shapes.each_ref().map(|shape| named(&**shape));
        let mut lines = vec![
            format!("{a}, {b}"),
            format!("within {:.3} mm", 1e3 * pair.prediction),
            format!("recorded: {}", contacts(&pair.after)),
            format!("  {}", suspicion(pair.judge())),
            format!("now: {}", contacts(&self.now)),
            format!("  {}", suspicion(now.judge())),
        ];
        if pair.has_corrected_normals {
            lines.push("normals were corrected, which is not repeated".to_owned());
        }
        lines.push(match &self.bounds {
            Ok(SeparationBounds { lower, upper, .. }) => {
                format!("proved: {:.5} to {:.5} mm", 1e3 * lower, 1e3 * upper)
            }
            Err(error) => format!("no bounds: {error}"),
        });
        if let Some(patch) = &self.patch {
            let corners = patch.vertices.len();
            lines.push(format!(
                "{corners} corners around {:.3} cm²",
                1e4 * patch.area
            ));
        }
        lines
    }

    /// A test of the pair for any project with this crate.
    pub fn test(&self) -> String {
        format!(
            "#[test]\nfn the_recorded_pair_looks_right() {{\n    \
             use isa_gjk::{{IsaGjkDispatcher, recording}};\n\n    \
             let pair = recording::read(PAIR).expect(\"a recording\").remove(0);\n    \
             let after = pair.update(&IsaGjkDispatcher::default());\n    \
             let now = recording::RecordedPair {{ after, ..pair }};\n    \
             assert_eq!(now.judge(), None);\n}}\n\n\
             const PAIR: &str = \"isa-gjk pairs 1\n{:?}\";",
            self.pair
        )
    }

    /// The picture, seen from the side of the normal, turned about the vertical by `yaw`.
    pub fn draw(&self, yaw: f64, zoom: f64) -> String {
        let size = self.size();
        let faces = [0, 1].map(|i| self.faces(i, size));
        let points = faces.iter().flatten().flatten().copied();
        let view = View {
            axis: self.normal(),
            yaw,
            pitch: PITCH,
            focus: self.focus(),
            zoom,
        };
        let mut canvas = Canvas::new(Page::WITH_TEXT, view, points);
        for is_front in [false, true] {
            for (i, faces) in faces.iter().enumerate() {
                let style = Style {
                    opacity: if is_front { 0.16 } else { 0.0 },
                    width: if is_front { 1.0 } else { 0.4 },
                    ..Style::new(HULLS[i])
                };
                let is_drawn = |face: &&Vec<DVec3>| {
                    canvas.faces_viewer(shape_faces::outward(face)) == is_front
                };
                let drawn: Vec<_> = faces.iter().filter(is_drawn).collect();
                drawn.iter().for_each(|face| canvas.polygon(face, style));
            }
        }
        self.draw_patch(&mut canvas);
        self.draw_bounds(&mut canvas, 0.5 * size);
        for (manifold, radius, colour) in [
            (&self.pair.after, 6.0, REMEMBERED),
            (&self.now, 3.5, ANSWER),
        ] {
            for contact in &manifold.points {
                let on_2 = self.pair.pos12.transform_point(contact.local_p2);
                [contact.local_p1, on_2]
                    .iter()
                    .for_each(|p| canvas.dot(p.as_dvec3(), radius, colour));
            }
        }
        canvas.note(&self.summary());
        canvas.key(&[
            (HULLS[0], "first shape, back faces lighter"),
            (HULLS[1], "second shape"),
            (REMEMBERED, "contacts as recorded"),
            (ANSWER, "contacts now, planes that prove the distance"),
            (PATCH, "the whole region of contact"),
        ]);
        canvas.finish()
    }

    fn draw_patch(&self, canvas: &mut Canvas) {
        let Some(patch) = &self.patch else {
            return;
        };
        let corners: Vec<DVec3> = patch.vertices.iter().map(|vertex| vertex.on_1).collect();
        let style = Style {
            opacity: 0.5,
            width: 2.5,
            ..Style::new(PATCH)
        };
        canvas.polygon(&corners, style);
        corners
            .iter()
            .for_each(|corner| canvas.dot(*corner, 3.0, PATCH));
        canvas.dot(patch.center, 5.0, PATCH);
    }

    /// The planes between which there is nothing, or in which the overlap is, and the points of the proof.
    fn draw_bounds(&self, canvas: &mut Canvas, half: f64) {
        let Ok(bounds) = &self.bounds else {
            return;
        };
        let style = Style {
            opacity: 0.1,
            width: 1.5,
            ..Style::new(ANSWER)
        };
        let (normal, focus) = (bounds.normal, self.focus());
        let (u, v) = normal.any_orthonormal_pair();
        for offset in bounds.planes {
            let foot = focus + normal * (offset - normal.dot(focus));
            let corners = [u + v, v - u, -u - v, u - v].map(|corner| foot + half * corner);
            canvas.polygon(&corners, style);
        }
        match &bounds.certificate {
            Certificate::Points([on_1, on_2]) => {
                canvas.line(*on_1, *on_2, style);
                [on_1, on_2]
                    .iter()
                    .for_each(|p| canvas.dot(**p, 3.5, ANSWER));
            }
            Certificate::Height(point) => canvas.dot(*point, 3.5, ANSWER),
            _ => {}
        }
    }

    fn normal(&self) -> DVec3 {
        let proved = self.bounds.as_ref().map(|bounds| bounds.normal);
        let recorded = self.pair.after.local_n1.as_dvec3();
        proved.unwrap_or(recorded.normalize_or(DVec3::X))
    }

    /// Where the shapes are nearest.
    fn focus(&self) -> DVec3 {
        if let Some(patch) = &self.patch {
            return patch.center;
        }
        match self.bounds.as_ref().map(|bounds| &bounds.certificate) {
            Ok(Certificate::Points([on_1, on_2])) => on_1.midpoint(*on_2),
            Ok(Certificate::Height(point)) => *point,
            _ => 0.5 * self.pair.pos12.translation.as_dvec3(),
        }
    }

    /// The diameter of the smaller shape, or of the only one that ends.
    fn size(&self) -> f64 {
        let ending = self
            .pair
            .shapes
            .iter()
            .filter(|shape| shape.as_halfspace().is_none());
        let radii = ending.map(|shape| f64::from(shape.compute_local_bounding_sphere().radius));
        2.0 * radii.fold(f64::INFINITY, f64::min)
    }

    /// The faces of a shape without its border, in the frame of the first.
    fn faces(&self, i: usize, size: f64) -> Vec<Vec<DVec3>> {
        let pose = &self.pair.pos12;
        let place = |p: DVec3| match i {
            0 => p,
            _ => pose.transform_point(p.as_vec3()).as_dvec3(),
        };
        let shape = &*self.pair.shapes[i];
        let faces = match shape.as_halfspace() {
            Some(half_space) => {
                let normal = half_space.normal.as_dvec3();
                let focus = if i == 0 {
                    self.focus()
                } else {
                    pose.inverse_transform_point(self.focus().as_vec3())
                        .as_dvec3()
                };
                let foot = focus - normal * normal.dot(focus);
                let (u, v) = normal.any_orthonormal_pair();
                vec![
                    [u + v, v - u, -u - v, u - v]
                        .map(|corner| foot + size * corner)
                        .to_vec(),
                ]
            }
            None => shape_faces::faces(shape),
        };
        let placed = |face: Vec<DVec3>| face.into_iter().map(place).collect();
        faces.into_iter().map(placed).collect()
    }
}

fn named(shape: &dyn Shape) -> String {
    let kind = format!("{:?}", shape.shape_type());
    match shape.as_typed_shape() {
        TypedShape::ConvexPolyhedron(hull) => format!("hull of {} points", hull.points().len()),
        _ => kind,
    }
}

fn contacts(manifold: &ContactManifold<(), ()>) -> String {
    let distances = manifold.points.iter().map(|contact| contact.dist);
    match distances.min_by(f32::total_cmp) {
        Some(deepest) => format!(
            "{} contacts, from {:.5} mm",
            manifold.points.len(),
            1e3 * deepest
        ),
        None => "no contact".to_owned(),
    }
}
