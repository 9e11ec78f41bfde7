//! What happened in a world, small enough for a web page: whole numbers, as differences from
//! frame to frame, compressed.

use std::collections::HashMap;
use std::io::{self, Write};

use base64::prelude::{BASE64_STANDARD, Engine};
use flate2::Compression;
use flate2::write::GzEncoder;
use rapier3d::prelude::{Collider, ColliderHandle, ContactPair, Pose, Real, Vector};
use serde_json::{Value, json};

use crate::mesh;
use testkit::scenes::World;

/// Steps of a place from one end of all to the other: below a pixel, and no finer, since noise
/// does not compress.
const PLACES: Real = 16383.0;
/// Steps of a quaternion's part from 0 to 1.
const TURNS: Real = 4095.0;
/// Numbers of a pose.
const POSE: usize = 7;

/// A recording that grows frame by frame.
pub struct Tape {
    colliders: Vec<ColliderHandle>,
    /// Corners of each distinct shape.
    meshes: Vec<Vec<Vector>>,
    /// The mesh of each collider, and whether it belongs to a dynamic body.
    looks: Vec<(usize, bool)>,
    frames: Vec<Frame>,
}

struct Frame {
    poses: Vec<Pose>,
    contacts: Vec<Vector>,
}

impl Tape {
    /// An empty recording of the colliders in `world`.
    pub fn new(world: &World) -> Self {
        let mut tape = Self {
            colliders: Vec::new(),
            meshes: Vec::new(),
            looks: Vec::new(),
            frames: Vec::new(),
        };
        // Colliders share their shapes.
        let mut known = HashMap::new();
        for (handle, collider) in world.physics.colliders.iter() {
            let address = std::ptr::from_ref(collider.shape()).cast::<u8>();
            let mesh = *known.entry(address).or_insert_with(|| {
                tape.meshes.push(mesh::triangles(collider.shape()));
                tape.meshes.len() - 1
            });
            tape.colliders.push(handle);
            tape.looks.push((mesh, is_dynamic(world, collider)));
        }
        tape
    }

    /// Adds the present frame.
    pub fn record(&mut self, world: &World) {
        let colliders = &world.physics.colliders;
        let poses = self
            .colliders
            .iter()
            .map(|handle| *colliders[*handle].position());
        let pairs = world.physics.narrow_phase.contact_pairs();
        let touching = pairs.filter(|pair| pair.has_any_active_contact());
        self.frames.push(Frame {
            poses: poses.collect(),
            contacts: touching.flat_map(|pair| contacts(world, pair)).collect(),
        });
    }

    /// Frames so far.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// What the player must know to read the tape.
    pub fn header(&self) -> Value {
        let (low, size) = self.bounds();
        let (focus, extent) = self.focus();
        json!({
            "frames": self.frames.len(),
            "corners": self.meshes.iter().map(Vec::len).collect::<Vec<_>>(),
            "bodies": self.looks,
            "low": low.to_array(),
            "step": (size / PLACES).to_array(),
            "focus": focus.to_array(),
            "extent": extent,
        })
    }

    /// The meshes as f32; the number of contacts of each frame as u32; the low bytes of poses and
    /// contacts, then the high bytes of both. Little-endian, gzip, base64.
    pub fn encode(&self) -> io::Result<String> {
        let mut file = GzEncoder::new(Vec::new(), Compression::best());
        for corner in self.meshes.iter().flatten() {
            for coordinate in corner.to_array() {
                file.write_all(&coordinate.to_le_bytes())?;
            }
        }
        for frame in &self.frames {
            file.write_all(&(frame.contacts.len() as u32).to_le_bytes())?;
        }
        // The high bytes are nearly all alike, and vanish when they come together.
        let numbers = self.numbers();
        for byte in [0, 1] {
            let bytes: Vec<u8> = numbers.iter().map(|n| n.to_le_bytes()[byte]).collect();
            file.write_all(&bytes)?;
        }
        Ok(BASE64_STANDARD.encode(file.finish()?))
    }

    /// All poses, as differences from the frame before, and then all contacts.
    fn numbers(&self) -> Vec<u16> {
        let (low, size) = self.bounds();
        let place = |p: Vector| {
            ((p - low) / size * PLACES)
                .to_array()
                .map(|x| x.round() as u16)
        };
        let mut numbers = Vec::new();
        let mut before = vec![[0_u16; POSE]; self.colliders.len()];
        for frame in &self.frames {
            for (pose, before) in frame.poses.iter().zip(&mut before) {
                let [x, y, z] = place(pose.translation);
                // A negative number wraps around, as differences do.
                let turn = pose
                    .rotation
                    .to_array()
                    .map(|q| (q * TURNS).round() as i16 as u16);
                let now = [x, y, z, turn[0], turn[1], turn[2], turn[3]];
                numbers.extend(
                    now.iter()
                        .zip(*before)
                        .map(|(now, before)| now.wrapping_sub(before)),
                );
                *before = now;
            }
        }
        let contacts = self.frames.iter().flat_map(|frame| &frame.contacts);
        numbers.extend(contacts.flat_map(|contact| place(*contact)));
        numbers
    }

    /// The box of all places, as its lowest corner and its size.
    fn bounds(&self) -> (Vector, Vector) {
        let frames = self.frames.iter();
        let places = frames.flat_map(|frame| {
            let places = frame.poses.iter().map(|pose| pose.translation);
            places.chain(frame.contacts.iter().copied())
        });
        extremes(places)
    }

    /// Where to look: the middle of all dynamic bodies' ways, and how far they spread.
    fn focus(&self) -> (Vector, Real) {
        let dynamic = self.frames.iter().flat_map(|frame| {
            let looks = frame.poses.iter().zip(&self.looks);
            looks
                .filter(|(_, (_, dynamic))| *dynamic)
                .map(|(pose, _)| pose.translation)
        });
        let (low, size) = extremes(dynamic);
        (low + 0.5 * size, size.max_element())
    }
}

/// Lowest corner and size of the box around `places`; no side of it is zero.
fn extremes(places: impl Iterator<Item = Vector>) -> (Vector, Vector) {
    let (mut low, mut high) = (Vector::MAX, Vector::MIN);
    for place in places {
        low = low.min(place);
        high = high.max(place);
    }
    (low, (high - low).max(Vector::splat(1e-3)))
}

fn is_dynamic(world: &World, collider: &Collider) -> bool {
    let parent = collider
        .parent()
        .and_then(|parent| world.physics.bodies.get(parent));
    parent.is_some_and(|body| body.is_dynamic())
}

/// The points where a pair pushes, in the world, on its first collider.
fn contacts<'a>(world: &'a World, pair: &'a ContactPair) -> impl Iterator<Item = Vector> + 'a {
    let pose = world.physics.colliders[pair.collider1].position();
    pair.manifolds().iter().flat_map(move |manifold| {
        let part = manifold.subshape_pos1().copied().unwrap_or(Pose::IDENTITY);
        let pushing = manifold
            .points
            .iter()
            .filter(|point| point.data.impulse > 0.0);
        pushing.map(move |point| pose.transform_point(part.transform_point(point.local_p1)))
    })
}
