//! The record of each world: one line of JSON.

use std::fs;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// One world's run.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Record {
    /// Its number, from zero.
    pub world: u32,
    /// Worlds of all shards together.
    pub worlds: u32,
    /// The seed of world zero.
    pub seed: u64,
    /// Steps that were made.
    pub steps: u32,
    /// The time that they took on their thread.
    pub seconds: f64,
    /// Bodies asleep at the end.
    pub asleep: u32,
    /// Bodies in the world.
    pub bodies: u32,
    /// Bodies that left the bin.
    pub lost: u32,
}

impl Record {
    /// What all worlds of a run have in common.
    pub fn run(&self) -> String {
        let Self {
            worlds,
            bodies,
            steps,
            seed,
            ..
        } = self;
        format!("{worlds} worlds of {bodies} bodies, {steps} steps, from seed {seed}")
    }
}

/// The records of all files.
pub fn read_all(files: &[PathBuf]) -> Result<Vec<Record>, String> {
    let mut records = Vec::new();
    for path in files {
        let name = path.display();
        let text =
            fs::read_to_string(path).map_err(|error| format!("cannot read {name}: {error}"))?;
        for (index, line) in text.lines().enumerate() {
            let record = serde_json::from_str(line)
                .map_err(|error| format!("{name}, line {}: {error}", index + 1))?;
            records.push(record);
        }
    }
    Ok(records)
}
