//! Four contacts in one plane that are far from each other.

use glam::Vec2;
use parry3d::math::Real;

use crate::manifold::MAX_POINTS;

/// A contact, by its manifold and its place there.
#[derive(Clone, Copy)]
pub(super) struct PartContact {
    pub manifold: usize,
    pub place: usize,
    /// In the plane.
    pub at: Vec2,
    pub distance: Real,
    /// How much deeper the deepest contact of its part is.
    pub above: Real,
}

/// The contacts for the solver.
#[derive(Default)]
pub(super) struct Spread {
    spots: [Option<PartContact>; MAX_POINTS],
    len: usize,
    /// How many parts have their deepest contact here.
    pub parts: usize,
    /// A contact is as deep as another if it is higher by no more than this.
    pub tie: Real,
}

impl Spread {
    pub fn new(tie: Real) -> Self {
        Self {
            tie,
            ..Self::default()
        }
    }

    pub fn push(&mut self, spot: PartContact) {
        self.parts += usize::from(self.would_serve(&spot));
        self.spots[self.len] = Some(spot);
        self.len += 1;
    }

    fn iter(&self) -> impl Iterator<Item = &PartContact> {
        self.spots.iter().flatten()
    }

    pub fn contains(&self, manifold: usize, place: usize) -> bool {
        self.iter()
            .any(|spot| (spot.manifold, spot.place) == (manifold, place))
    }

    /// Whether a part has its deepest contact here, or one as deep.
    pub fn serves(&self, manifold: usize) -> bool {
        self.iter()
            .any(|spot| spot.manifold == manifold && spot.above <= self.tie)
    }

    /// Whether it is the deepest contact, or one as deep, of a part that has none here.
    pub fn would_serve(&self, spot: &PartContact) -> bool {
        spot.above <= self.tie && !self.serves(spot.manifold)
    }

    /// How far a place is from the contact, from the line through both, or outside of the triangle of all three.
    pub fn room(&self, at: Vec2) -> Real {
        let beyond = |a: &PartContact, b: &PartContact| {
            let line = (b.at - a.at).normalize_or_zero();
            line.perp_dot(at - a.at)
        };
        match &self.spots {
            [Some(a), None, ..] => a.at.distance(at),
            [Some(a), Some(b), None, _] => beyond(a, b).abs(),
            [Some(a), Some(b), Some(c), _] => {
                let outwards = if (b.at - a.at).perp_dot(c.at - a.at) > 0.0 {
                    -1.0
                } else {
                    1.0
                };
                let edges = [(a, b), (b, c), (c, a)];
                let outside = edges.map(|(a, b)| outwards * beyond(a, b));
                outside.into_iter().fold(Real::MIN, Real::max)
            }
            _ => 0.0,
        }
    }
}
