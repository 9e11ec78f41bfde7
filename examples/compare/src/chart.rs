//! The figures as pictures.

use std::error::Error;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::measure::{BLOCK, Run, Side};
use crate::rest::{self, Rest};
use crate::sweep::{Row, Sweep};
use testkit::quality::quantile;

const SIZE: (u32, u32) = (800, 440);
const FONT: (&str, u32) = ("sans-serif", 15);
/// From the palette of Okabe and Ito, whose colours the colour-blind can tell apart.
const DEFAULT: RGBColor = RGBColor(0xD5, 0x5E, 0x00);
const OURS: RGBColor = RGBColor(0x00, 0x72, 0xB2);
const HULL_SHAPE: RGBColor = RGBColor(0x00, 0x9E, 0x73);
const GRID: RGBColor = RGBColor(0xE6, 0xE6, 0xE6);
/// Frames that took longer than this share of the others do not set the scale: they are the
/// machine's, not the narrow phase's.
const SHOWN: f64 = 0.99;
/// Opacity of single frames behind the medians.
const PALE: f64 = 0.35;
/// Room above the highest value that is shown.
const HEADROOM: f64 = 1.2;
/// Lengths of a dash and of the gap after it.
const DASH: (u32, u32) = (6, 4);
/// The same on a logarithmic axis, where the legend needs it.
const LEGEND: f64 = 3.0;
/// Length of a line in the legend.
const KEY: i32 = 30;

type Line = Vec<(f64, f64)>;
/// Name, colour and figure of a line in the sweep.
type Series = (&'static str, RGBColor, fn(&Row) -> f64);

/// Draws the narrow phase's time in every counted frame of both worlds, and over it the median of
/// each block of frames.
pub fn frames(path: &Path, title: &str, runs: &[Run]) -> Result<(), Box<dyn Error>> {
    let lines = [
        (
            "rapier's default",
            DEFAULT,
            over_frames(runs, |r| &r.default),
        ),
        ("isa-gjk", OURS, over_frames(runs, |r| &r.ours)),
    ];
    let tops = lines.iter().map(|(.., line)| {
        let times = line.iter().map(|(_, time)| *time);
        quantile(times.collect(), SHOWN)
    });
    let top = HEADROOM * tops.fold(f64::MIN_POSITIVE, f64::max);
    let last = lines[0].2.last().map_or(1.0, |(frame, _)| *frame);

    let area = blank(path, title)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .x_label_area_size(45)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..last, 0.0..top)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .label_style(FONT)
        .x_label_formatter(&|frame| format!("{frame:.0}"))
        .x_desc("frame")
        .y_desc("narrow phase [ms]")
        .draw()?;
    for (name, colour, line) in lines {
        let shown: Line = line.iter().map(|(x, y)| (*x, y.min(top))).collect();
        let blocks = block_medians(&shown);
        chart.draw_series(LineSeries::new(shown, colour.mix(PALE)))?;
        chart
            .draw_series(LineSeries::new(blocks, colour.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + KEY, y)], colour.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE)
        .border_style(GRID)
        .legend_area_size(KEY + 6)
        .label_font(FONT)
        .draw()?;
    Ok(area.present()?)
}

/// Draws how many bodies are awake in every frame, a line for each seed.
pub fn awake(path: &Path, rest: &Rest) -> Result<(), Box<dyn Error>> {
    type Worlds = fn(&rest::Run) -> &rest::Side;
    let lines: [(_, _, Worlds); 2] = [
        ("rapier's default", DEFAULT, |run| &run.default),
        ("isa-gjk", OURS, |run| &run.ours),
    ];
    let area = blank(path, &rest.title())?;
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .x_label_area_size(45)
        .y_label_area_size(60)
        .build_cartesian_2d(
            0.0..rest.frames as f64,
            0.0..HEADROOM * f64::from(rest.bodies),
        )?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .label_style(FONT)
        .x_label_formatter(&|frame| format!("{frame:.0}"))
        .y_label_formatter(&|bodies| format!("{bodies:.0}"))
        .x_desc("frame")
        .y_desc("bodies awake")
        .draw()?;
    for (name, colour, side) in lines {
        let style = colour.stroke_width(2);
        for (number, run) in rest.runs.iter().enumerate() {
            let frames = side(run).frames.iter().enumerate();
            let line: Line = frames
                .map(|(frame, seen)| (frame as f64, seen.awake as f64))
                .collect();
            let drawn = chart.draw_series(LineSeries::new(line, style))?;
            if number == 0 {
                drawn
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + KEY, y)], style));
            }
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE)
        .border_style(GRID)
        .legend_area_size(KEY + 6)
        .label_font(FONT)
        .draw()?;
    Ok(area.present()?)
}

/// Draws the time of a contact pair against the number of vertices, both on logarithmic axes.
pub fn sweep(path: &Path, sweep: &Sweep) -> Result<(), Box<dyn Error>> {
    let of: [Series; 3] = [
        ("rapier's default", DEFAULT, |row| row.default),
        ("isa-gjk", OURS, |row| row.ours),
        ("isa-gjk, HullShape", HULL_SHAPE, |row| row.hull_shape),
    ];
    let times = || {
        sweep
            .rows
            .iter()
            .flat_map(|row| of.map(|(.., time)| time(row)))
    };
    // A logarithmic axis has no zero.
    let low = times().fold(f64::INFINITY, f64::min).max(1e-3) / HEADROOM;
    let high = times().fold(2.0 * low, f64::max) * LEGEND;
    let vertices = || sweep.rows.iter().map(|row| f64::from(row.vertices));
    let most = vertices().fold(1.0, f64::max);
    let least = vertices().fold(most, f64::min);

    let title = format!(
        "{}, {} bodies; dashed: recycling off",
        sweep.scene, sweep.bodies
    );
    let area = blank(path, &title)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .x_label_area_size(45)
        .y_label_area_size(60)
        .build_cartesian_2d(
            (least..HEADROOM * most).log_scale().base(2.0),
            (low..high).log_scale().base(2.0),
        )?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .label_style(FONT)
        .x_label_formatter(&|vertices| vertices.to_string())
        .y_label_formatter(&|time| time.to_string())
        .x_desc("vertices of a hull")
        .y_desc("narrow phase per contact pair [µs]")
        .draw()?;
    for (name, colour, time) in of {
        for recycling in [true, false] {
            let rows = sweep.rows.iter().filter(|row| row.recycling == recycling);
            let line: Line = rows
                .map(|row| (f64::from(row.vertices), time(row).max(low)))
                .collect();
            let style = colour.stroke_width(2);
            if recycling {
                chart
                    .draw_series(LineSeries::new(line, style))?
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + KEY, y)], style));
            } else {
                chart.draw_series(DashedLineSeries::new(line, DASH.0, DASH.1, style))?;
            }
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE)
        .border_style(GRID)
        .legend_area_size(KEY + 6)
        .label_font(FONT)
        .draw()?;
    Ok(area.present()?)
}

/// An empty picture under its title.
fn blank<'a>(
    path: &'a Path,
    title: &str,
) -> Result<DrawingArea<SVGBackend<'a>, Shift>, Box<dyn Error>> {
    let area = SVGBackend::new(path, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    Ok(area.titled(title, FONT)?)
}

/// The narrow phase's time in milliseconds over the counted frames, each the median of all runs:
/// equal runs do equal work in a frame.
fn over_frames(runs: &[Run], side: fn(&Run) -> &Side) -> Line {
    let counted = side(&runs[0])
        .frames
        .iter()
        .enumerate()
        .filter(|(_, frame)| frame.counted);
    counted
        .map(|(index, _)| {
            let times = runs
                .iter()
                .map(|run| side(run).frames[index].times.narrow_phase);
            (index as f64, quantile(times.collect(), 0.5))
        })
        .collect()
}

/// Time and place of the middle of each block.
fn block_medians(line: &[(f64, f64)]) -> Line {
    let blocks = line.chunk_by(|a, b| a.0 as usize / BLOCK == b.0 as usize / BLOCK);
    blocks
        .map(|block| {
            let times = block.iter().map(|(_, time)| *time).collect();
            (block[block.len() / 2].0, quantile(times, 0.5))
        })
        .collect()
}
