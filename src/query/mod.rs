//! The coherent query: from what the previous frame knew, the cheapest stage that can *prove*
//! its answer gives it.
//!
//! 1. [`Stage::Axis`]: one support pair along the previous axis still separates.
//! 2. [`Stage::Feature`]: the previous nearest features still prove distance or depth.
//! 3. [`Stage::WarmGjk`]: incremental GJK from the previous axis and vertices.
//! 4. [`Stage::WarmEpa`]: the depth, expanded from the previous features.
//!
//! Without a previous frame GJK and EPA start cold. A stale or wrong memory costs time, never
//! accuracy: nothing is believed that is not re-evaluated at the present poses.

mod feature;

pub use feature::{Feature, vertices};

use glam::DVec3;

use crate::epa::{self, Depth, EpaScratch, Penetration};
use crate::gjk::{self, Closest, Outcome, SeparatingAxis};
use crate::simplex::Voronoi;
use crate::stats::{Cost, Stage};
use crate::support::{Cso, CsoVertex, Polytope, VertexId};
use crate::tolerance::DEPTH_GAP;
use feature::{Seeds, Side, Verdict};

/// Tangent of the angle by which a direction is turned towards where the next facet is to be
/// expected. Hulls of a hundred vertices have dihedral angles around it; any value is correct.
const TILT: f64 = 0.2;

/// The stages of a query that goes on from a previous frame.
const WARM: [Stage; 2] = [Stage::WarmGjk, Stage::WarmEpa];

/// What is remembered of a pair from one frame to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Memory {
    /// Nothing: the pair is new.
    None,
    /// The shapes were apart along this unit axis (frame 1), at these vertices.
    Axis(DVec3, [VertexId; 2]),
    /// The shapes were in contact along this unit normal (frame 1), at these features.
    Contact(DVec3, [Feature; 2]),
}

/// Signed distance, normal and witness points of a pair. All in frame 1.
#[derive(Clone, Copy, Debug)]
pub struct Proximity {
    /// Distance of disjoint shapes; minus the penetration depth of overlapping ones.
    pub signed_distance: f64,
    /// Unit direction from shape 1 to shape 2 along which they are that far apart.
    pub normal: DVec3,
    /// The witness point on shape 1.
    pub on_1: DVec3,
    /// The witness point on shape 2.
    pub on_2: DVec3,
    /// The features that the witness points lie on.
    pub features: [Feature; 2],
}

/// The answer to a query.
#[derive(Clone, Copy, Debug)]
pub enum Answer {
    /// Farther apart than the query asked about.
    Apart(SeparatingAxis),
    /// This near, or overlapping.
    Near(Proximity),
}

/// A query between two shapes.
pub struct Query<'a, 'c, A, B> {
    /// The pair.
    pub cso: &'a Cso<'c, A, B>,
    /// Answers beyond this distance are [`Answer::Apart`].
    pub max_distance: f64,
    /// Memory for the expanding polytope.
    pub scratch: &'a mut EpaScratch,
    /// Filled in with what the query cost.
    pub cost: &'a mut Cost,
}

impl<A: Polytope, B: Polytope> Query<'_, '_, A, B> {
    /// Answers from `memory` where that is possible, cold otherwise. `None` only if the shapes
    /// have no volume between them or are not finite.
    pub fn run(&mut self, memory: &Memory) -> Option<(Answer, Stage)> {
        match *memory {
            Memory::None => {
                let axis = self.center_line();
                let start = self.cso.start(axis);
                let vertex = self.cso.support(axis, start, self.cost);
                self.run_gjk(&[vertex], [Stage::ColdGjk, Stage::ColdEpa])
            }
            Memory::Axis(axis, ids) => {
                match gjk::test_axis(
                    self.cso,
                    axis,
                    self.valid_start(ids),
                    self.max_distance,
                    self.cost,
                ) {
                    Ok(apart) => Some((Answer::Apart(apart), Stage::Axis)),
                    Err(vertex) => self.tilt_axis(axis, vertex),
                }
            }
            Memory::Contact(normal, features) => self.check_contact(normal, features),
        }
    }

    /// From the centre of shape 1 to that of shape 2; some direction where they coincide.
    fn center_line(&self) -> DVec3 {
        (-self.cso.center()).normalize_or(DVec3::X)
    }

    fn valid_start(&self, ids: [VertexId; 2]) -> [VertexId; 2] {
        [
            self.cso.shape_1.valid_start(ids[0]),
            self.cso.shape_2.valid_start(ids[1]),
        ]
    }

    /// The axis separates no more, but mostly because the shapes turned a little: tilted away from
    /// where `vertex` comes too near, it often does.
    fn tilt_axis(&mut self, axis: DVec3, vertex: CsoVertex) -> Option<(Answer, Stage)> {
        let sideways = vertex.w - axis * axis.dot(vertex.w);
        let tilted = axis - sideways.normalize_or_zero() * TILT;
        let tilted = tilted.normalize();
        match gjk::test_axis(self.cso, tilted, vertex.ids, self.max_distance, self.cost) {
            Ok(apart) => Some((Answer::Apart(apart), Stage::Axis)),
            Err(second) => self.run_gjk(&[vertex, second], WARM),
        }
    }

    /// From the facet beyond a side of the previous one. From the side alone GJK's first direction
    /// would be sideways, far from where the shapes are near.
    fn cross_side(&mut self, side: &Side) -> Option<(Answer, Stage)> {
        let [from, to] = side.ends;
        let tilted = (side.normal + side.outward * TILT).normalize();
        match gjk::test_axis(self.cso, tilted, from.ids, self.max_distance, self.cost) {
            Ok(apart) => Some((Answer::Apart(apart), Stage::Axis)),
            Err(beyond) => self.run_gjk(&[from, to, beyond], WARM),
        }
    }

    /// GJK from vertices of the Minkowski difference, and EPA if the shapes overlap.
    fn run_gjk(&mut self, start: &[CsoVertex], stages: [Stage; 2]) -> Option<(Answer, Stage)> {
        match gjk::distance::<Voronoi, _, _>(self.cso, start, self.max_distance, self.cost) {
            Outcome::Apart(apart) => Some((Answer::Apart(apart), stages[0])),
            Outcome::Near(closest) => Some((self.near(&closest), stages[0])),
            Outcome::Overlap(simplex) => {
                let mut seeds = Seeds::default();
                simplex.vertices().for_each(|vertex| seeds.push(*vertex));
                let seeds = seeds.as_slice();
                let depth = epa::penetration(self.cso, seeds, self.scratch, self.cost)?;
                Some((self.overlapping(&depth), stages[1]))
            }
        }
    }

    fn check_contact(&mut self, normal: DVec3, features: [Feature; 2]) -> Option<(Answer, Stage)> {
        let tolerance = DEPTH_GAP * self.cso.smaller_radius();
        match feature::certify(self.cso, features, self.max_distance, tolerance, self.cost) {
            Verdict::Apart(apart) => Some((Answer::Apart(apart), Stage::Axis)),
            Verdict::Certified(proximity) => Some((Answer::Near(proximity), Stage::Feature)),
            Verdict::Beyond(side) => self.cross_side(&side),
            Verdict::Unproved(seeds, candidate) => self.run_epa(seeds.as_slice(), candidate),
            Verdict::NoPlane => {
                let start = feature::vertices(self.cso, features);
                let vertex = self.cso.support(normal, start, self.cost);
                self.run_gjk(&[vertex], WARM)
            }
        }
    }

    /// The depth, grown from points near the previous contact, if it is not that of the
    /// `candidate`; where it finds the shapes separate, GJK finds how far.
    fn run_epa(&mut self, seeds: &[CsoVertex], candidate: Proximity) -> Option<(Answer, Stage)> {
        let known = -candidate.signed_distance;
        let depth = match epa::penetration_below(self.cso, seeds, known, self.scratch, self.cost)? {
            Depth::Found(depth) => depth,
            Depth::Known => return Some((Answer::Near(candidate), Stage::WarmEpa)),
        };
        let separation = -depth.depth;
        let ids = depth.face[0].ids;
        if separation > self.max_distance {
            let axis = SeparatingAxis {
                axis: depth.normal,
                separation,
                ids,
            };
            return Some((Answer::Apart(axis), Stage::WarmEpa));
        }
        if separation > 0.0 {
            return self.run_gjk(&depth.face, WARM);
        }
        Some((self.overlapping(&depth), Stage::WarmEpa))
    }

    fn near(&self, closest: &Closest) -> Answer {
        Answer::Near(Proximity {
            signed_distance: closest.distance,
            normal: closest.normal,
            on_1: closest.on_1,
            on_2: closest.on_2,
            features: feature::of_simplex(self.cso, closest.simplex.vertices(), closest.normal),
        })
    }

    fn overlapping(&self, depth: &Penetration) -> Answer {
        let features = feature::of_simplex(self.cso, depth.face.iter(), depth.normal);
        let [on_1, on_2] = feature::witnesses(self.cso, features, depth);
        Answer::Near(Proximity {
            signed_distance: -depth.depth,
            normal: depth.normal,
            on_1,
            on_2,
            features,
        })
    }
}
