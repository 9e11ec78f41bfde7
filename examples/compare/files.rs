//! The figures as files, for other programs.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::measure::{Frame, Run};
use crate::report::Report;

/// Writes the figures of the table.
pub fn write_json(path: &Path, report: &Report) -> Result<(), String> {
    write_file(path, |file| {
        serde_json::to_writer_pretty(&mut *file, report)?;
        writeln!(file)
    })
}

/// Writes the times of every frame, of both worlds side by side.
pub fn write_csv(path: &Path, runs: &[Run]) -> Result<(), String> {
    write_file(path, |file| {
        writeln!(
            file,
            "run,frame,counted,default_step_ms,default_broad_ms,default_narrow_ms,\
             default_solver_ms,default_pairs,default_touching,ours_step_ms,ours_broad_ms,\
             ours_narrow_ms,ours_solver_ms,ours_pairs,ours_touching"
        )?;
        for (number, run) in runs.iter().enumerate() {
            let frames = run.default.frames.iter().zip(&run.ours.frames);
            for (index, (default, ours)) in frames.enumerate() {
                let counted = u8::from(default.counted);
                let (default, ours) = (columns(default), columns(ours));
                writeln!(file, "{number},{index},{counted},{default},{ours}")?;
            }
        }
        Ok(())
    })
}

fn columns(frame: &Frame) -> String {
    let times = &frame.times;
    format!(
        "{:.6},{:.6},{:.6},{:.6},{},{}",
        times.step,
        times.broad_phase,
        times.narrow_phase,
        times.solver,
        frame.pairs,
        frame.touching
    )
}

fn write_file(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), String> {
    let written = File::create(path).and_then(|file| {
        let mut file = BufWriter::new(file);
        write(&mut file)?;
        file.flush()
    });
    written.map_err(|error| format!("cannot write {}: {error}", path.display()))
}
