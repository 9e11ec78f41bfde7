//! The published hulls and poses with their exact signed distances (see `tests/data/hulls/README.md`).

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::OnceLock;

use glam::{DQuat, DVec3};
use parry3d::math::Vector;
use parry3d::shape::SharedShape;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::oracle::Solid;
use super::pose::ExactPose;

/// One published pose of shape B in the frame of shape A, with the exact answer.
#[derive(Clone, Debug, Deserialize)]
pub struct Case {
    pub id: String,
    pub shape_a: String,
    pub shape_b: String,
    translation: [f64; 3],
    rotation: [f64; 4],
    pub signed_distance: f64,
    pub scale: f64,
    pose_f32_exact: bool,
    traj: Option<u32>,
}

impl Case {
    /// The pose as published, in f64.
    pub fn pose(&self) -> ExactPose {
        ExactPose {
            rotation: DQuat::from_array(self.rotation).normalize(),
            translation: DVec3::from_array(self.translation),
        }
    }

    /// How far rounding the pose to f32 may move the answer by itself, relative to the scale.
    pub fn pose_slack(&self) -> f64 {
        if self.pose_f32_exact { 0.0 } else { 2.0e-6 }
    }
}

/// A published convex hull, for the oracle and for parry.
pub struct Hull {
    pub solid: Solid,
    pub shape: SharedShape,
}

#[derive(Deserialize)]
struct HullFile {
    points: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
}

impl From<HullFile> for Hull {
    fn from(file: HullFile) -> Self {
        let points: Vec<DVec3> = file.points.into_iter().map(DVec3::from_array).collect();
        Self {
            shape: shape_with_all_points(&points, &file.faces),
            solid: Solid::new(points, &file.faces),
        }
    }
}

/// `convex_mesh` keeps every vertex; `convex_hull` may weld some, so it is the second choice.
fn shape_with_all_points(points: &[DVec3], faces: &[[u32; 3]]) -> SharedShape {
    let points: Vec<Vector> = points.iter().map(|p| p.as_vec3()).collect();
    SharedShape::convex_mesh(points.clone(), faces)
        .or_else(|| SharedShape::convex_hull(&points))
        .expect("a published hull is a solid")
}

/// All published hulls by name, read once.
pub fn hulls() -> &'static HashMap<String, Hull> {
    static HULLS: OnceLock<HashMap<String, Hull>> = OnceLock::new();
    HULLS.get_or_init(|| {
        std::fs::read_dir(data("shapes"))
            .expect("the shapes are part of the repository")
            .map(|entry| entry.expect("a readable directory").path())
            .filter(|path| !path.ends_with("INDEX.json"))
            .map(|path| {
                let name = path.file_stem().expect("a file name").to_string_lossy();
                let text = std::fs::read_to_string(&path).expect("a readable file");
                (name.into_owned(), parse::<HullFile>(&text).into())
            })
            .collect()
    })
}

/// The published points as `convex_hull` makes a shape of them, with triangles and a numbering
/// of its own; only where it keeps every point.
pub fn built_by_parry() -> &'static HashMap<String, SharedShape> {
    static BUILT: OnceLock<HashMap<String, SharedShape>> = OnceLock::new();
    BUILT.get_or_init(|| {
        let build = |hull: &Hull| {
            let points: Vec<Vector> = hull.solid.points.iter().map(|p| p.as_vec3()).collect();
            let shape = SharedShape::convex_hull(&points)?;
            let kept = shape.as_convex_polyhedron()?.points();
            points.iter().all(|p| kept.contains(p)).then_some(shape)
        };
        hulls()
            .iter()
            .filter_map(|(name, hull)| Some((name.clone(), build(hull)?)))
            .collect()
    })
}

/// All cases of one regime.
pub fn cases(regime: &str) -> Vec<Case> {
    let path = data("cases").join(format!("{regime}.jsonl"));
    let text = std::fs::read_to_string(path).expect("the cases are part of the repository");
    text.lines().map(parse).collect()
}

/// The published trajectories, frame after frame.
pub fn trajectories() -> Vec<Vec<Case>> {
    let frames = cases("trajectories");
    frames
        .chunk_by(|a, b| a.traj == b.traj)
        .map(<[Case]>::to_vec)
        .collect()
}

fn data(folder: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../tests/data/hulls", folder]
        .iter()
        .collect()
}

fn parse<T: DeserializeOwned>(text: &str) -> T {
    serde_json::from_str(text).expect("well-formed data")
}
