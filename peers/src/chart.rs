//! Time and error against the number of vertices, a line for each engine.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

use crate::Row;
use crate::cases::{self, VERTICES};

const SIZE: (u32, u32) = (960, 420);
const FONT: (&str, u32) = ("sans-serif", 15);
const GRID: RGBColor = RGBColor(0xE6, 0xE6, 0xE6);
/// From the palette of Okabe and Ito, whose colours the colour-blind can tell apart.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0x56, 0xB4, 0xE9),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
];
/// How the hulls lie whose times are drawn: overlapping a little, as in most contacts.
const GAP: &str = "shallow";
/// Errors below this are drawn here: they are no longer those of the engine.
const LEAST_ERROR: f64 = 1e-9;
/// Length of a line in the legend.
const KEY: i32 = 24;

/// One of the two figures.
struct Panel {
    title: &'static str,
    range: std::ops::Range<f64>,
    of: fn(&Row) -> f64,
    label: fn(&f64) -> String,
    legend: bool,
}

pub fn draw(path: &Path, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let panels = [
        Panel {
            title: "1 % deep: time of an update [ns]",
            range: 200.0..60_000.0,
            of: |row| row.nanoseconds,
            label: |nanoseconds| format!("{nanoseconds:.0}"),
            legend: true,
        },
        Panel {
            title: "worst error of a depth [diameters]",
            range: LEAST_ERROR..1.0,
            of: |row| row.verdict.worst.max(LEAST_ERROR),
            label: |error| format!("{error:.0e}"),
            legend: false,
        },
    ];
    let area = SVGBackend::new(path, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    for (half, panel) in area.split_evenly((1, 2)).iter().zip(&panels) {
        draw_panel(half, panel, rows)?;
    }
    Ok(area.present()?)
}

fn draw_panel(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    panel: &Panel,
    rows: &[Row],
) -> Result<(), Box<dyn Error>> {
    let [first, .., last] = VERTICES.map(|n| n as f64);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .caption(panel.title, FONT)
        .x_label_area_size(45)
        .y_label_area_size(60)
        .build_cartesian_2d((first..last).log_scale(), panel.range.clone().log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .label_style(FONT)
        .x_desc("vertices of each hull")
        .x_labels(4)
        .x_label_formatter(&|vertices| format!("{vertices:.0}"))
        .y_label_formatter(&panel.label)
        .draw()?;
    for (engine, colour) in engines(rows).into_iter().zip(COLOURS) {
        let style = colour.stroke_width(2);
        let line = VERTICES.iter().filter_map(|&vertices| {
            let row = rows.iter().find(|row| {
                row.engine == engine && row.gap == GAP && row.hulls == cases::random(vertices)
            })?;
            Some((vertices as f64, (panel.of)(row)))
        });
        chart
            .draw_series(LineSeries::new(line, style).point_size(3))?
            .label(engine)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + KEY, y)], style));
    }
    if !panel.legend {
        return Ok(());
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(GRID)
        .legend_area_size(KEY + 6)
        .label_font(FONT)
        .draw()?;
    Ok(())
}

/// In the order in which they were measured.
fn engines(rows: &[Row]) -> Vec<&'static str> {
    let mut names = Vec::new();
    for row in rows {
        if !names.contains(&row.engine) {
            names.push(row.engine);
        }
    }
    names
}
