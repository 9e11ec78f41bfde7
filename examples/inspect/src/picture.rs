//! The picture of a pair of hulls at one frame.

use glam::DVec3;
use isa_gjk::internals::manifold::ContactPoint;
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::query::{Answer, PairMemory};
use isa_gjk::internals::stats::Cost;
use isa_gjk::internals::support::{FaceId, Polytope, Support, VertexId};
use isa_gjk::query::Feature;
use isa_gjk::{Hull, Stage};

use crate::svg::{Canvas, PITCH, Page, Style, View, YAW};

/// Half the side of the squares that stand for planes, in radii.
const PLANE: f64 = 0.5;
/// From the palette of Okabe and Ito, whose colours the colour-blind can tell apart.
pub const HULLS: [&str; 2] = ["#0072B2", "#D55E00"];
pub const REMEMBERED: &str = "#E69F00";
pub const ANSWER: &str = "#009E73";
pub const PATCH: &str = "#CC79A7";

/// One frame of a pair, in the frame of the first hull.
pub struct Snapshot<'a> {
    pub hulls: [&'a Hull; 2],
    pub pose: RelativePose,
    pub frame: u32,
    /// What the previous frame left.
    pub memory: PairMemory,
    pub answer: Answer,
    pub stage: Stage,
    pub cost: Cost,
    pub contacts: Vec<ContactPoint>,
}

impl Snapshot<'_> {
    /// What the next frame finds.
    pub fn learned(&self) -> PairMemory {
        match &self.answer {
            Answer::Separated(apart) => PairMemory::Axis(apart.axis, apart.ids),
            // The first contact need not be the query's witness: it is what manifolds store.
            Answer::Near(near) => PairMemory::Contact(near.normal, self.contacts[0].features),
        }
    }

    /// The frame in words.
    pub fn summary(&self) -> Vec<String> {
        let cost = &self.cost;
        let mut lines = vec![
            format!("frame {}", self.frame),
            format!("answered by {}", self.stage.name()),
            format!(
                "{} iterations, {} supports, {} climb moves",
                cost.iterations, cost.supports, cost.climb_moves
            ),
            match &self.memory {
                PairMemory::None => "remembered: nothing".to_owned(),
                PairMemory::Axis(_, [a, b]) => format!("remembered: axis, vertices {a} and {b}"),
                PairMemory::Contact(_, features) => format!("remembered: {}", named(features)),
            },
        ];
        match &self.answer {
            Answer::Separated(apart) => lines.push(format!(
                "apart by more than {:.2} mm",
                1e3 * apart.separation
            )),
            Answer::Near(near) => {
                let distance = 1e3 * near.signed_distance;
                let word = if distance > 0.0 { "distance" } else { "depth" };
                lines.push(format!("{word} {:.3} mm", distance.abs()));
                lines.push(format!("between {}", named(&near.features)));
                lines.push(format!("{} contact points", self.contacts.len()));
            }
        }
        lines
    }

    /// The picture, magnified around the contact or the gap.
    pub fn draw(&self, zoom: f64) -> String {
        let points = [0, 1].map(|i| {
            let vertices = self.hulls[i].vertex_ids();
            vertices.map(move |vertex| self.vertex(i, vertex))
        });
        let view = View {
            axis: self.axis(),
            yaw: YAW,
            pitch: PITCH,
            focus: self.middle(),
            zoom,
        };
        let mut canvas = Canvas::new(Page::WITH_TEXT, view, points.into_iter().flatten());
        for front in [false, true] {
            (0..2).for_each(|i| self.draw_hull(&mut canvas, i, front));
        }
        self.draw_memory(&mut canvas);
        self.draw_answer(&mut canvas);
        canvas.note(&self.summary());
        canvas.key(&[
            (HULLS[0], "first hull, back faces lighter"),
            (HULLS[1], "second hull"),
            (REMEMBERED, "remembered: axis with its planes, or features"),
            (ANSWER, "answer: axis or normal, witness points, features"),
            (PATCH, "contact patch"),
        ]);
        canvas.finish()
    }

    fn draw_hull(&self, canvas: &mut Canvas, i: usize, front: bool) {
        let style = Style {
            opacity: if front { 0.16 } else { 0.0 },
            width: if front { 1.0 } else { 0.4 },
            ..Style::new(HULLS[i])
        };
        for face in self.hulls[i].face_ids() {
            if canvas.faces_viewer(self.face_normal(i, face)) == front {
                canvas.polygon(&self.face(i, face), style);
            }
        }
    }

    /// The memory at the present poses. The query must prove whether it still holds.
    fn draw_memory(&self, canvas: &mut Canvas) {
        let style = Style {
            opacity: 0.45,
            width: 5.0,
            ..Style::new(REMEMBERED)
        };
        match &self.memory {
            PairMemory::None => {}
            PairMemory::Axis(axis, ids) => {
                let ends = [0, 1].map(|i| self.vertex(i, ids[i]));
                self.draw_axis(canvas, *axis, ends, style);
                ends.iter()
                    .for_each(|end| canvas.dot(*end, 5.0, REMEMBERED));
            }
            PairMemory::Contact(_, features) => {
                (0..2).for_each(|i| self.draw_feature(canvas, i, features[i], style));
            }
        }
    }

    fn draw_answer(&self, canvas: &mut Canvas) {
        let style = Style {
            width: 2.0,
            ..Style::new(ANSWER)
        };
        match &self.answer {
            Answer::Separated(apart) => {
                let ends = [0, 1].map(|i| self.vertex(i, apart.ids[i]));
                self.draw_axis(canvas, apart.axis, ends, style);
                ends.iter().for_each(|end| canvas.dot(*end, 3.0, ANSWER));
            }
            Answer::Near(near) => {
                (0..2).for_each(|i| self.draw_feature(canvas, i, near.features[i], style));
                self.draw_patch(canvas, near.normal);
                let tip = near.on_1 + 0.6 * self.radius() * near.normal;
                canvas.line(near.on_1, tip, style);
                canvas.line(near.on_1, near.on_2, style);
                [near.on_1, near.on_2]
                    .iter()
                    .for_each(|p| canvas.dot(*p, 3.0, ANSWER));
            }
        }
    }

    /// The line of an axis between the two extreme vertices, and the planes there.
    fn draw_axis(&self, canvas: &mut Canvas, axis: DVec3, ends: [DVec3; 2], style: Style) {
        let middle = ends[0].midpoint(ends[1]);
        let foot = |end: DVec3| middle + axis * axis.dot(end - middle);
        let beyond = 0.35 * self.radius() * axis;
        canvas.line(foot(ends[0]) - beyond, foot(ends[1]) + beyond, style);
        let (u, v) = axis.any_orthonormal_pair();
        let half = PLANE * self.radius();
        for end in ends {
            let corners = [u + v, v - u, -u - v, u - v].map(|corner| foot(end) + half * corner);
            canvas.polygon(
                &corners,
                Style {
                    opacity: 0.12,
                    ..style
                },
            );
        }
    }

    fn draw_feature(&self, canvas: &mut Canvas, i: usize, feature: Feature, style: Style) {
        match feature {
            Feature::Vertex(v) => canvas.dot(self.vertex(i, v), style.width + 2.0, style.colour),
            Feature::Edge(e) => {
                if let Some([from, to]) = self.hulls[i].edge_ends(e) {
                    canvas.line(self.vertex(i, from), self.vertex(i, to), style);
                }
            }
            Feature::Face(f) => canvas.polygon(&self.face(i, f), style),
        }
    }

    /// The contact points, on both hulls, and what they span.
    fn draw_patch(&self, canvas: &mut Canvas, normal: DVec3) {
        let ends: Vec<[DVec3; 2]> = self.contacts.iter().map(|c| self.ends(c)).collect();
        let middles = ends.iter().map(|[on_1, on_2]| on_1.midpoint(*on_2));
        let mut corners: Vec<DVec3> = middles.collect();
        let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let (u, v) = normal.any_orthonormal_pair();
        let around = |p: &DVec3| (*p - centre).dot(v).atan2((*p - centre).dot(u));
        corners.sort_by(|a, b| around(a).total_cmp(&around(b)));
        let style = Style {
            opacity: 0.5,
            ..Style::new(PATCH)
        };
        canvas.polygon(&corners, style);
        for [on_1, on_2] in ends {
            canvas.line(on_1, on_2, style);
            canvas.dot(on_1, 4.0, PATCH);
            canvas.dot(on_2, 4.0, PATCH);
        }
    }

    /// A contact's points on both hulls, in the frame of the first.
    fn ends(&self, contact: &ContactPoint) -> [DVec3; 2] {
        let on_2 = self.pose.point_to_1(contact.on_2.as_dvec3());
        [contact.on_1.as_dvec3(), on_2]
    }

    /// From the first hull to the second.
    fn axis(&self) -> DVec3 {
        match &self.answer {
            Answer::Separated(apart) => apart.axis,
            Answer::Near(near) => near.normal,
        }
    }

    /// Between the witness points or the extreme vertices.
    fn middle(&self) -> DVec3 {
        match &self.answer {
            Answer::Separated(apart) => self
                .vertex(0, apart.ids[0])
                .midpoint(self.vertex(1, apart.ids[1])),
            Answer::Near(near) => near.on_1.midpoint(near.on_2),
        }
    }

    fn radius(&self) -> f64 {
        self.hulls[0].radius().min(self.hulls[1].radius())
    }

    fn vertex(&self, i: usize, vertex: VertexId) -> DVec3 {
        let local = self.hulls[i].vertex(vertex);
        if i == 0 {
            local
        } else {
            self.pose.point_to_1(local)
        }
    }

    fn face(&self, i: usize, face: FaceId) -> Vec<DVec3> {
        let corners = 0..self.hulls[i].face_len(face);
        corners
            .map(|k| self.vertex(i, self.hulls[i].face_vertex(face, k)))
            .collect()
    }

    fn face_normal(&self, i: usize, face: FaceId) -> DVec3 {
        let local = self.hulls[i].face_normal(face);
        if i == 0 {
            local
        } else {
            self.pose.direction_to_1(local)
        }
    }
}

fn named(features: &[Feature; 2]) -> String {
    let name = |feature: &Feature| match feature {
        Feature::Vertex(v) => format!("vertex {v}"),
        Feature::Edge(e) => format!("edge {e}"),
        Feature::Face(f) => format!("face {f}"),
    };
    format!("{} and {}", name(&features[0]), name(&features[1]))
}
