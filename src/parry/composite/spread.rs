//! Four contacts in one plane that are far from each other.
//!
//! They are chosen one at a time, since a contact that is the deepest of its part may go first. So this is not the
//! choice of `manifold/reduce.rs`, which takes the two sides of the longest line at once.

use glam::Vec2;
use parry3d::math::Real;

use crate::manifold::MAX_POINTS;

/// A contact, by its manifold and its place there.
#[derive(Clone, Copy, Default)]
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
    contacts: [Option<PartContact>; MAX_POINTS],
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

    pub fn push(&mut self, contact: &PartContact) {
        self.parts += usize::from(self.would_serve(contact));
        self.contacts[self.len] = Some(*contact);
        self.len += 1;
    }

    fn iter(&self) -> impl Iterator<Item = &PartContact> {
        self.contacts.iter().flatten()
    }

    pub fn contains(&self, contact: &PartContact) -> bool {
        let mut contacts = self.iter();
        contacts.any(|other| other.manifold == contact.manifold && other.place == contact.place)
    }

    /// Whether a part has its deepest contact here, or one as deep.
    fn serves(&self, manifold: usize) -> bool {
        self.iter()
            .any(|contact| contact.manifold == manifold && contact.above <= self.tie)
    }

    /// Whether it is the deepest contact, or one as deep, of a part that has none here.
    pub fn would_serve(&self, contact: &PartContact) -> bool {
        contact.above <= self.tie && !self.serves(contact.manifold)
    }

    /// Whether the first three are not above `level` and at least so wide apart that a body may lie on them.
    pub fn bears(&self, level: Real, width: Real) -> bool {
        let [Some(a), Some(b), Some(c), _] = &self.contacts else {
            return false;
        };
        [a, b, c].iter().all(|contact| contact.distance <= level)
            && Side::new(a.at, b.at).right_of(c.at).abs() >= width
    }

    /// Whether it is the deepest contact of a part that has none here, and the first such after those `before` it.
    pub fn lacks(&self, contact: &PartContact, before: &[PartContact]) -> bool {
        let mut of_part = before
            .iter()
            .filter(|other| other.manifold == contact.manifold);
        contact.above <= 0.0
            && !self.serves(contact.manifold)
            && of_part.all(|other| other.above > 0.0)
    }

    /// The room that they leave.
    pub fn room(&self) -> Room {
        let places = self.contacts.map(|contact| Some(contact?.at));
        let [a, b, c, _] = places;
        match (a, b, c) {
            (Some(a), None, _) => Room::Around(a),
            (Some(a), Some(b), None) => Room::Beside(Side::new(a, b)),
            (Some(a), Some(b), Some(c)) => {
                // Counter-clockwise, so that all sides look outwards.
                let [b, c] = if (b - a).perp_dot(c - a) < 0.0 {
                    [c, b]
                } else {
                    [b, c]
                };
                Room::Outside([Side::new(a, b), Side::new(b, c), Side::new(c, a)])
            }
            (None, ..) => Room::Around(Vec2::ZERO),
        }
    }
}

/// The places that are not yet held.
pub(super) enum Room {
    Around(Vec2),
    /// On both sides of a line.
    Beside(Side),
    /// Beyond the sides of a triangle.
    Outside([Side; 3]),
}

impl Room {
    /// How far a place is from the contact, from the line through two, or outside of the triangle of three.
    pub fn at(&self, place: Vec2) -> Real {
        match self {
            Self::Around(contact) => contact.distance(place),
            Self::Beside(line) => line.right_of(place).abs(),
            Self::Outside(sides) => {
                let [a, b, c] = sides.each_ref().map(|side| side.right_of(place));
                a.max(b).max(c)
            }
        }
    }
}

/// A directed line through two contacts.
pub(super) struct Side {
    start: Vec2,
    right: Vec2,
}

impl Side {
    fn new(start: Vec2, end: Vec2) -> Self {
        let line = (end - start).normalize_or_zero();
        Self {
            start,
            right: -line.perp(),
        }
    }

    /// How far a place is to the right.
    fn right_of(&self, place: Vec2) -> Real {
        self.right.dot(place - self.start)
    }
}
