//! Points in space as an SVG picture, with text beside it.

use std::fmt::Write;

use glam::{DVec2, DVec3};

const WIDTH: f64 = 980.0;
const HEIGHT: f64 = 560.0;
/// What there is to see is drawn to the left of this, and text written to the right.
const TEXT: f64 = 600.0;
const LINE_HEIGHT: f64 = 24.0;
const MARGIN: f64 = 24.0;
/// Radians by which the view is turned out of the contact plane, so that areas in it show.
pub const YAW: f64 = 0.35;
const PITCH: f64 = 0.3;

/// How something is drawn.
#[derive(Clone, Copy)]
pub struct Style {
    /// Of lines and areas.
    pub colour: &'static str,
    /// Of areas.
    pub opacity: f64,
    /// Of lines.
    pub width: f64,
}

impl Style {
    /// Thin lines and empty areas.
    pub fn new(colour: &'static str) -> Self {
        Self {
            colour,
            opacity: 0.0,
            width: 1.5,
        }
    }

    fn attributes(self) -> String {
        let Self {
            colour,
            opacity,
            width,
        } = self;
        format!(
            "stroke=\"{colour}\" stroke-width=\"{width}\" fill=\"{colour}\" \
             fill-opacity=\"{opacity}\""
        )
    }
}

/// A view, with all drawings and text so far.
pub struct Canvas {
    elements: String,
    right: DVec3,
    up: DVec3,
    toward: DVec3,
    /// Pixels per unit of length.
    scale: f64,
    middle: DVec2,
}

impl Canvas {
    /// A view that holds all `points`, with `axis` to the right, out of the page by `yaw`; magnified towards `focus`, if `zoom` is above one.
    pub fn new(
        axis: DVec3,
        yaw: f64,
        points: impl Iterator<Item = DVec3>,
        focus: DVec3,
        zoom: f64,
    ) -> Self {
        let up = axis.cross(DVec3::Y).cross(axis);
        let up = up.normalize_or(axis.any_orthonormal_vector());
        let aside = axis.cross(up);
        let level = axis * yaw.sin() + aside * yaw.cos();
        let mut canvas = Self {
            elements: String::new(),
            right: axis * yaw.cos() - aside * yaw.sin(),
            up: up * PITCH.cos() - level * PITCH.sin(),
            toward: up * PITCH.sin() + level * PITCH.cos(),
            scale: 1.0,
            middle: DVec2::ZERO,
        };
        let mut low = DVec2::INFINITY;
        let mut high = DVec2::NEG_INFINITY;
        for point in points {
            let place = canvas.flatten(point);
            low = low.min(place);
            high = high.max(place);
        }
        let room = DVec2::new(TEXT, HEIGHT) - 2.0 * MARGIN;
        canvas.scale = zoom * (room / (high - low)).min_element();
        canvas.middle = canvas.flatten(focus).lerp(low.midpoint(high), zoom.recip());
        canvas
    }

    /// Whether a face with this outward normal can be seen.
    pub fn faces_viewer(&self, normal: DVec3) -> bool {
        normal.dot(self.toward) > 0.0
    }

    /// Draws a polygon and its outline.
    pub fn polygon(&mut self, corners: &[DVec3], style: Style) {
        let places = corners.iter().map(|corner| {
            let place = self.place(*corner);
            format!("{:.1},{:.1}", place.x, place.y)
        });
        let places = places.collect::<Vec<_>>().join(" ");
        self.add(format_args!(
            "<polygon points=\"{places}\" {}/>",
            style.attributes()
        ));
    }

    /// Draws a line.
    pub fn line(&mut self, from: DVec3, to: DVec3, style: Style) {
        let [a, b] = [from, to].map(|end| self.place(end));
        self.add(format_args!(
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" {}/>",
            a.x,
            a.y,
            b.x,
            b.y,
            style.attributes()
        ));
    }

    /// Draws a dot of a radius in pixels.
    pub fn dot(&mut self, at: DVec3, radius: f64, colour: &str) {
        let DVec2 { x, y } = self.place(at);
        self.add(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\"/>"
        ));
    }

    /// Writes lines of text at the top, over any drawing that reaches too far to the right.
    pub fn note(&mut self, lines: &[String]) {
        self.add(format_args!(
            "<rect x=\"{}\" width=\"100%\" height=\"100%\" fill=\"white\"/>",
            TEXT - 0.5 * MARGIN
        ));
        for (i, line) in lines.iter().enumerate() {
            let y = 2.0 * MARGIN + LINE_HEIGHT * i as f64;
            self.add(format_args!("<text x=\"{TEXT}\" y=\"{y}\">{line}</text>"));
        }
    }

    /// Writes what the colours mean at the bottom.
    pub fn key(&mut self, colours: &[(&str, &str)]) {
        for (i, (colour, meaning)) in colours.iter().rev().enumerate() {
            let y = HEIGHT - MARGIN - LINE_HEIGHT * i as f64;
            self.add(format_args!(
                "<rect x=\"{TEXT}\" y=\"{}\" width=\"16\" height=\"12\" fill=\"{colour}\"/>\
                 <text x=\"{}\" y=\"{y}\">{meaning}</text>",
                y - 11.0,
                TEXT + 24.0
            ));
        }
    }

    /// The whole picture.
    pub fn finish(self) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
             width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"15\" \
             stroke-linejoin=\"round\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
             {}</svg>\n",
            self.elements
        )
    }

    fn add(&mut self, element: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.elements, "{element}");
    }

    /// In the picture's plane, in the points' unit.
    fn flatten(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), -point.dot(self.up))
    }

    /// In pixels.
    fn place(&self, point: DVec3) -> DVec2 {
        (self.flatten(point) - self.middle) * self.scale + 0.5 * DVec2::new(TEXT, HEIGHT)
    }
}
