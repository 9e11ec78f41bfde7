//! Worlds side by side as one animated picture, which plays wherever pictures are shown.

use std::cmp::Ordering;
use std::fmt::Write;

use rapier3d::prelude::{Collider, Real, RigidBody};

use crate::view::{HEIGHT, View, WIDTH};
use testkit::scenes::World;

/// Pixels above a world, for its title.
const TITLE: Real = 24.0;
/// Two tones of each body: the lighter one is for its large faces.
const AWAKE: [(&str, &str); 5] = [
    ("#7aad94", "#92c0aa"),
    ("#cf9d6c", "#dfb389"),
    ("#789fc2", "#93b5d3"),
    ("#b891aa", "#caa8be"),
    ("#c2ba74", "#d4cd90"),
];
const ASLEEP: (&str, &str) = ("#b3bac0", "#cfd5da");
const STYLE: &str = "text{font:600 13px sans-serif;fill:#22303a}path{stroke:#33404a;stroke-width:.5;stroke-linejoin:round}";

/// The frames of one world, as the inside of picture elements, beside its title.
pub struct Reel {
    title: String,
    view: View,
    frames: Vec<String>,
}

impl Reel {
    /// The film of a world, which is seen whole as it is at the start.
    pub fn new(title: String, world: &World) -> Self {
        Self {
            title,
            view: View::around(dynamic(world).map(|(_, collider, _)| collider)),
            frames: Vec::new(),
        }
    }

    /// Adds the present frame: the dynamic bodies, farthest first.
    pub fn record(&mut self, world: &World) {
        let mut drawn: Vec<_> = dynamic(world)
            .map(|(index, collider, body)| {
                let colours = match body.is_sleeping() {
                    true => ASLEEP,
                    false => AWAKE[index % AWAKE.len()],
                };
                let depth = self.view.depth(collider.position().translation);
                (depth, self.view.draw(collider, colours))
            })
            .collect();
        drawn.sort_by(|(a, _), (b, _)| b.partial_cmp(a).unwrap_or(Ordering::Equal));
        self.frames
            .push(drawn.into_iter().map(|(_, body)| body).collect());
    }
}

/// The colliders of bodies that move, each with its index among all.
fn dynamic(world: &World) -> impl Iterator<Item = (usize, &Collider, &RigidBody)> {
    let physics = &world.physics;
    let colliders = physics.colliders.iter().enumerate();
    colliders.filter_map(|(index, (_, collider))| {
        let body = physics.bodies.get(collider.parent()?)?;
        body.is_dynamic().then_some((index, collider, body))
    })
}

/// The picture, a line of worlds for each of `rows`. It takes `seconds` and then starts over.
pub fn picture(rows: &[Vec<Reel>], seconds: f64) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let (width, height) = (
        WIDTH * columns as Real,
        (HEIGHT + TITLE) * rows.len() as Real,
    );
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\"><style>{STYLE}</style>\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#edf2f6\"/>"
    );
    for (row, reels) in rows.iter().enumerate() {
        for (column, reel) in reels.iter().enumerate() {
            let top = (HEIGHT + TITLE) * row as Real + TITLE;
            let left = WIDTH * column as Real;
            let _ = write!(
                svg,
                "<svg x=\"{left}\" y=\"{top}\" width=\"{WIDTH}\" height=\"{HEIGHT}\">{}</svg>\
                 <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                animation(&reel.frames, seconds),
                left + 0.5 * WIDTH,
                top - 6.0,
                reel.title
            );
        }
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
