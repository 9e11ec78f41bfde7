//! Points in space as an SVG picture, with text beside it.

use std::fmt::Write;

use glam::{DVec2, DVec3};

const LINE_HEIGHT: f64 = 24.0;
const MARGIN: f64 = 24.0;
/// Radians by which the view is turned out of the contact plane, so that areas in it show.
pub const YAW: f64 = 0.35;
/// Radians by which one looks down.
pub const PITCH: f64 = 0.3;

/// A page, in pixels. What there is to see is drawn to the left of `text`, and text written to the right.
#[derive(Clone, Copy)]
pub struct Page {
    pub width: f64,
    pub height: f64,
    pub text: f64,
}

impl Page {
    pub const WITH_TEXT: Self = Self {
        width: 980.0,
        height: 560.0,
        text: 600.0,
    };
}

/// From where one looks.
#[derive(Clone, Copy)]
pub struct View {
    /// The direction that points to the right, out of the page by `yaw`.
    pub axis: DVec3,
    pub yaw: f64,
    pub pitch: f64,
    /// What is magnified by `zoom`.
    pub focus: DVec3,
    pub zoom: f64,
}

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
    page: Page,
    elements: String,
    right: DVec3,
    up: DVec3,
    toward: DVec3,
    /// Pixels per unit of length.
    scale: f64,
    middle: DVec2,
}

impl Canvas {
    /// A view that holds all `points`, unless it is magnified.
    pub fn new(page: Page, view: View, points: impl Iterator<Item = DVec3>) -> Self {
        let View { axis, yaw, .. } = view;
        let up = axis.cross(DVec3::Y).cross(axis);
        let up = up.normalize_or(axis.any_orthonormal_vector());
        let aside = axis.cross(up);
        let level = axis * yaw.sin() + aside * yaw.cos();
        let (sin, cos) = view.pitch.sin_cos();
        let mut canvas = Self {
            page,
            elements: String::new(),
            right: axis * yaw.cos() - aside * yaw.sin(),
            up: up * cos - level * sin,
            toward: up * sin + level * cos,
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
        let room = DVec2::new(page.text, page.height) - 2.0 * MARGIN;
        canvas.scale = view.zoom * (room / (high - low)).min_element();
        let focus = canvas.flatten(view.focus);
        canvas.middle = focus.lerp(low.midpoint(high), view.zoom.recip());
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

    /// Draws an arrow.
    pub fn arrow(&mut self, from: DVec3, to: DVec3, style: Style) {
        let [a, b] = [from, to].map(|end| self.place(end));
        let along = (b - a).normalize_or_zero() * 4.0 * style.width;
        let across = along.perp() * 0.5;
        let head = [b, b - along + across, b - along - across];
        let head = head.map(|corner| format!("{:.1},{:.1}", corner.x, corner.y));
        self.line(from, to, style);
        let style = Style {
            opacity: 1.0,
            ..style
        };
        self.add(format_args!(
            "<polygon points=\"{}\" {}/>",
            head.join(" "),
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

    /// Draws a circle of a radius in pixels.
    pub fn circle(&mut self, at: DVec3, radius: f64, colour: &str) {
        let DVec2 { x, y } = self.place(at);
        self.add(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"white\" stroke=\"{colour}\" \
             stroke-width=\"1.5\"/>"
        ));
    }

    /// Writes a few words beside a point, to its right.
    pub fn label(&mut self, at: DVec3, words: &str) {
        let DVec2 { x, y } = self.place(at);
        let (x, y) = (x + 8.0, y + 5.0);
        for halo in ["stroke=\"white\" stroke-width=\"4\"", ""] {
            self.add(format_args!(
                "<text x=\"{x:.1}\" y=\"{y:.1}\" {halo}>{words}</text>"
            ));
        }
    }

    /// Writes lines of text at the top, over any drawing that reaches too far to the right.
    pub fn note(&mut self, lines: &[String]) {
        self.add(format_args!(
            "<rect x=\"{}\" width=\"100%\" height=\"100%\" fill=\"white\"/>",
            self.page.text - 0.5 * MARGIN
        ));
        for (i, line) in lines.iter().enumerate() {
            let y = 2.0 * MARGIN + LINE_HEIGHT * i as f64;
            let x = self.page.text;
            self.add(format_args!("<text x=\"{x}\" y=\"{y}\">{line}</text>"));
        }
    }

    /// Writes what the colours mean at the bottom.
    pub fn key(&mut self, colours: &[(&str, &str)]) {
        for (i, (colour, meaning)) in colours.iter().rev().enumerate() {
            let y = self.page.height - MARGIN - LINE_HEIGHT * i as f64;
            let x = self.page.text;
            self.add(format_args!(
                "<rect x=\"{x}\" y=\"{}\" width=\"16\" height=\"12\" fill=\"{colour}\"/>\
                 <text x=\"{}\" y=\"{y}\">{meaning}</text>",
                y - 11.0,
                x + 24.0
            ));
        }
    }

    /// The whole picture.
    pub fn finish(self) -> String {
        let Page { width, height, .. } = self.page;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" font-size=\"15\" \
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
        (self.flatten(point) - self.middle) * self.scale
            + 0.5 * DVec2::new(self.page.text, self.page.height)
    }
}
