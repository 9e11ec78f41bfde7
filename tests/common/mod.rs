//! What the integration tests share: the exact cases, an oracle in f64, and a report.
// Every test binary compiles this module whole and uses its own part of it.
#![allow(dead_code)]

pub mod bytes;
pub mod cases;
pub mod generate;
pub mod memory;
pub mod oracle;
pub mod pose;
pub mod report;
pub mod scene;
pub mod twins;
pub mod world;
pub mod zoo;
