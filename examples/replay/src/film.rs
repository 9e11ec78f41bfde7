//! Two worlds side by side as one animated picture, which plays wherever pictures are shown.

use std::cmp::Ordering;
use std::fmt::Write;

use rapier3d::prelude::{Collider, Pose, Real, Rotation, Shape, TypedShape, Vector};

use crate::mesh;
use testkit::scenes::World;

/// Pixels of one of the two halves.
const WIDTH: Real = 400.0;
const HEIGHT: Real = 340.0;
const TITLE: Real = 28.0;
/// The camera's turn about the vertical, and its height above the horizon, in radians.
const AZIMUTH: Real = 0.6;
const ELEVATION: Real = 0.3;
/// Faces with at least this many corners are drawn apart from the rest of a body.
const MANY_CORNERS: usize = 5;
const COLOURS: [(&str, &str); 5] = [
    ("#7aad94", "#92c0aa"),
    ("#cf9d6c", "#dfb389"),
    ("#789fc2", "#93b5d3"),
    ("#b891aa", "#caa8be"),
    ("#c2ba74", "#d4cd90"),
];
const STYLE: &str = "text{font:600 15px sans-serif;fill:#22303a}path{stroke:#33404a;stroke-width:.6;stroke-linejoin:round}";

/// The frames of one world, as the inside of picture elements, beside its title.
pub struct Reel {
    title: String,
    view: View,
    frames: Vec<String>,
}

impl Reel {
    /// The film of a world that starts as it is now; what is beyond `extent` metres from the
    /// middle is out of sight.
    pub fn new(title: impl Into<String>, extent: Real) -> Self {
        Self {
            title: title.into(),
            view: View::new(extent),
            frames: Vec::new(),
        }
    }

    /// Adds the present frame: the dynamic bodies, farthest first.
    pub fn record(&mut self, world: &World) {
        let physics = &world.physics;
        let mut drawn = Vec::new();
        for (index, (_, collider)) in physics.colliders.iter().enumerate() {
            let body = collider
                .parent()
                .and_then(|parent| physics.bodies.get(parent));
            if body.is_some_and(|body| body.is_dynamic()) {
                let depth = self.view.depth(collider.position().translation);
                drawn.push((
                    depth,
                    self.view.draw(collider, COLOURS[index % COLOURS.len()]),
                ));
            }
        }
        drawn.sort_by(|(a, _), (b, _)| b.partial_cmp(a).unwrap_or(Ordering::Equal));
        self.frames
            .push(drawn.into_iter().map(|(_, body)| body).collect());
    }
}

/// The picture, which takes `seconds` and then starts over.
pub fn picture(reels: &[Reel], seconds: f64) -> String {
    let (width, height) = (WIDTH * reels.len() as Real, HEIGHT + TITLE);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\"><style>{STYLE}</style>\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#edf2f6\"/>"
    );
    for (index, reel) in reels.iter().enumerate() {
        let left = WIDTH * index as Real;
        let _ = write!(
            svg,
            "<svg x=\"{left}\" y=\"{TITLE}\" width=\"{WIDTH}\" height=\"{HEIGHT}\">{}</svg>\
             <text x=\"{}\" y=\"20\" text-anchor=\"middle\">{}</text>",
            animation(&reel.frames, seconds),
            left + 0.5 * WIDTH,
            reel.title
        );
    }
    svg.push_str("</svg>\n");
    svg
}

/// Each frame in its time; frames that are alike are written once.
fn animation(frames: &[String], seconds: f64) -> String {
    let mut svg = String::new();
    let mut first = 0;
    while first < frames.len() {
        let alike = frames[first..]
            .iter()
            .take_while(|frame| **frame == frames[first]);
        let end = first + alike.count();
        let [from, to] = [first, end].map(|frame| frame as f64 / frames.len() as f64);
        // Viewers that do not play show the last frame.
        let still = if end == frames.len() {
            "visible"
        } else {
            "hidden"
        };
        let _ = write!(
            svg,
            "<g visibility=\"{still}\"><animate attributeName=\"visibility\" dur=\"{seconds}s\" \
             repeatCount=\"indefinite\" calcMode=\"discrete\" values=\"hidden;visible;hidden\" \
             keyTimes=\"0;{from:.4};{to:.4}\"/>{}</g>",
            frames[first]
        );
        first = end;
    }
    svg
}

/// A camera without perspective.
struct View {
    turn: Rotation,
    scale: Real,
}

impl View {
    fn new(extent: Real) -> Self {
        Self {
            turn: Rotation::from_rotation_x(ELEVATION) * Rotation::from_rotation_y(AZIMUTH),
            scale: WIDTH / extent,
        }
    }

    /// How far something is behind the picture.
    fn depth(&self, point: Vector) -> Real {
        -(self.turn * point).z
    }

    /// On the picture, in pixels; the origin is low in the middle.
    fn project(&self, point: Vector) -> [i32; 2] {
        let seen = self.turn * point * self.scale;
        [0.5 * WIDTH + seen.x, 0.86 * HEIGHT - seen.y].map(|x| x.round() as i32)
    }

    /// The outline of a body, and over it the outlines of faces with many corners.
    fn draw(&self, collider: &Collider, (dark, light): (&str, &str)) -> String {
        let pose = collider.position();
        let corners = mesh::triangles(collider.shape()).into_iter();
        let outline = convex_hull(
            corners
                .map(|p| self.project(pose.transform_point(p)))
                .collect(),
        );
        let mut body = format!("<path fill=\"{dark}\" d=\"{}\"/>", path(&outline));
        for face in large_faces(collider.shape()) {
            if let Some(polygon) = self.seen_face(pose, &face) {
                let _ = write!(body, "<path fill=\"{light}\" d=\"{}\"/>", path(&polygon));
            }
        }
        body
    }

    /// On the picture, if the face looks at it. Corners go round counter-clockwise, seen from
    /// outside.
    fn seen_face(&self, pose: &Pose, face: &[Vector]) -> Option<Vec<[i32; 2]>> {
        let seen = face.iter().map(|p| self.project(pose.transform_point(*p)));
        let polygon = convex_hull(seen.collect());
        let [a, b, c] = [0, 1, 2].map(|i| face[i * face.len() / 3]);
        let normal = self.turn * (pose.rotation * (b - a).cross(c - a));
        (normal.z > 0.0 && polygon.len() > 2).then_some(polygon)
    }
}

fn large_faces(shape: &dyn Shape) -> Vec<Vec<Vector>> {
    let TypedShape::ConvexPolyhedron(hull) = shape.as_typed_shape() else {
        return Vec::new();
    };
    let (points, names) = (hull.points(), hull.vertices_adj_to_face());
    let faces = hull.faces().iter().map(|face| {
        let first = face.first_vertex_or_edge as usize;
        let names = &names[first..first + face.num_vertices_or_edges as usize];
        names.iter().map(|name| points[*name as usize]).collect()
    });
    faces
        .filter(|face: &Vec<_>| face.len() >= MANY_CORNERS)
        .collect()
}

/// Corners of the convex hull of points in the plane (Andrew's monotone chain).
fn convex_hull(mut points: Vec<[i32; 2]>) -> Vec<[i32; 2]> {
    points.sort_unstable();
    points.dedup();
    let mut hull = half_hull(points.iter());
    hull.extend(half_hull(points.iter().rev()));
    hull
}

/// One side of it, without its last corner.
fn half_hull<'a>(points: impl Iterator<Item = &'a [i32; 2]>) -> Vec<[i32; 2]> {
    let mut chain: Vec<[i32; 2]> = Vec::new();
    for &point in points {
        while let [.., a, b] = chain[..]
            && cross(a, b, point) <= 0
        {
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}

fn cross(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> i32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// As differences from corner to corner, which are short.
fn path(polygon: &[[i32; 2]]) -> String {
    let mut d = String::new();
    let mut last = [0; 2];
    for (index, point) in polygon.iter().enumerate() {
        let command = if index == 0 { "M" } else { "l" };
        let [x, y] = [point[0] - last[0], point[1] - last[1]];
        let _ = write!(d, "{command}{x} {y}");
        last = *point;
    }
    d + "z"
}
