//! What tests, benches and examples share: exact cases, an oracle in f64, generators of hulls, scenes
//! of whole worlds, and reports. Not published.

pub mod budget;
pub mod bytes;
pub mod cases;
pub mod console;
pub mod curved;
pub mod divided;
pub mod families;
pub mod generate;
pub mod kinds;
pub mod memory;
pub mod numbers;
pub mod oracle;
pub mod own_shape;
pub mod pair;
pub mod pose;
pub mod quality;
pub mod recorded;
pub mod report;
pub mod rounded;
pub mod scanned;
pub mod scene;
pub mod scenes;
pub mod shape_samples;
pub mod silent;
pub mod twins;
pub mod world;
