//! The figures as files, for other programs.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use serde::Serialize;

use crate::measure::{Frame, Run};

/// Creates the file at `path`, if there is to be one.
pub fn create(path: Option<&Path>) -> Result<Option<BufWriter<File>>, String> {
    path.map(|path| {
        File::create(path)
            .map(BufWriter::new)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))
    })
    .transpose()
}

/// Writes the figures of the table.
pub fn write_json(mut file: BufWriter<File>, figures: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut file, figures)?;
    writeln!(file)?;
    file.flush()
}

/// Writes the times of every frame, of both worlds side by side.
pub fn write_csv(mut file: BufWriter<File>, runs: &[Run]) -> io::Result<()> {
    writeln!(
        file,
        "run,frame,counted,{},{}",
        header("default"),
        header("ours")
    )?;
    for (number, run) in runs.iter().enumerate() {
        let frames = run.default.frames.iter().zip(&run.ours.frames);
        for (index, (default, ours)) in frames.enumerate() {
            let counted = u8::from(default.counted);
            let (default, ours) = (columns(default), columns(ours));
            writeln!(file, "{number},{index},{counted},{default},{ours}")?;
        }
    }
    file.flush()
}

fn header(side: &str) -> String {
    [
        "step_ms",
        "broad_ms",
        "narrow_ms",
        "solver_ms",
        "ccd_ms",
        "pairs",
        "touching",
    ]
    .map(|column| format!("{side}_{column}"))
    .join(",")
}

fn columns(frame: &Frame) -> String {
    let times = &frame.times;
    format!(
        "{:.6},{:.6},{:.6},{:.6},{:.6},{},{}",
        times.step,
        times.broad_phase,
        times.narrow_phase,
        times.solver,
        times.ccd,
        frame.pairs,
        frame.touching
    )
}
