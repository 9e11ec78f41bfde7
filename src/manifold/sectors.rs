//! Intersection of two convex polygons of many corners, in time linear in them.
//!
//! Around a point inside a polygon, each side has a sector. On the way around the other polygon, the sectors
//! follow each other, forwards or backwards. So a corner need only be compared with the side of its sector,
//! and a side only with the sides of the sectors between its ends. Where rounding decides between
//! neighbouring sectors, the adjacent sides are compared as well.

use glam::Vec2;

use super::clip_vertices::ClipVertices;
use super::polygon::{Line, PolygonRows};
use crate::tolerance::CLEARLY_BESIDE;

/// The sectors of a polygon, and the current one.
struct Sectors<'p> {
    polygon: &'p PolygonRows,
    center: Vec2,
    /// 1 if the polygon is counter-clockwise, -1 if it is clockwise.
    turn: f32,
    at: usize,
    /// From the centre to both ends of the current sector's side.
    ends: [Vec2; 2],
}

/// The location of a point relative to a polygon.
#[derive(Clone, Copy, PartialEq)]
enum Inclusion {
    Inside,
    /// Outside the side of its sector.
    Outside,
    /// Nearer to the border than rounding.
    OnBorder,
}

impl<'p> Sectors<'p> {
    /// `None` for a polygon that is too thin.
    fn new(polygon: &'p PolygonRows, turn: f32) -> Option<Self> {
        let center = center(polygon)?;
        let mut sides = (0..polygon.count).map(|i| polygon.side(i));
        let is_inside = sides.all(|side| side.height(center) * turn > side.slack);
        is_inside.then_some(Self {
            polygon,
            center,
            turn,
            at: 0,
            ends: [Vec2::ZERO; 2],
        })
    }

    fn after(&self, sector: usize, steps: usize) -> usize {
        let sector = sector + steps;
        let count = self.polygon.count;
        if sector < count {
            sector
        } else {
            sector - count
        }
    }

    /// From the centre to a corner.
    fn spoke(&self, corner: usize) -> Vec2 {
        self.polygon.corner(corner) - self.center
    }

    /// Goes to a sector.
    fn set(&mut self, sector: usize) {
        self.at = sector;
        self.ends = [sector, self.after(sector, 1)].map(|corner| self.spoke(corner));
    }

    /// Whether the current sector contains a point.
    fn contains(&self, p: Vec2) -> bool {
        let dir = p - self.center;
        let [from, to] = self.ends;
        from.perp_dot(dir) * self.turn >= 0.0 && dir.perp_dot(to) * self.turn > 0.0
    }

    /// Goes to the sector of a point. For the centre, any sector will do.
    fn enter(&mut self, p: Vec2) {
        for sector in (0..self.polygon.count).rev() {
            self.set(sector);
            if self.contains(p) {
                return;
            }
        }
    }

    /// Goes to the sector of `q` on the straight way from `p`, which is in the current sector. Returns the
    /// first sector on the way and their number, with one more at both ends.
    fn follow(&mut self, p: Vec2, q: Vec2) -> (usize, usize) {
        let count = self.polygon.count;
        let start = self.at;
        let forth = (p - self.center).perp_dot(q - self.center) * self.turn >= 0.0;
        let mut steps = 0;
        while steps < count && !self.contains(q) {
            let [from, to] = self.ends;
            if forth {
                self.at = self.after(self.at, 1);
                self.ends = [to, self.spoke(self.after(self.at, 1))];
            } else {
                self.at = self.after(self.at, count - 1);
                self.ends = [self.spoke(self.at), from];
            }
            steps += 1;
        }
        let first = if forth { start } else { self.at };
        (self.after(first, count - 1), (steps + 3).min(count))
    }

    /// The location of a point in the current sector.
    fn place(&self, p: Vec2) -> Inclusion {
        let side = self.polygon.side(self.at);
        let height = side.height(p) * self.turn;
        if height > CLEARLY_BESIDE * side.slack {
            Inclusion::Inside
        } else if height < -CLEARLY_BESIDE * side.slack {
            Inclusion::Outside
        } else {
            Inclusion::OnBorder
        }
    }

    /// Whether a point in the current sector with this location counts as inside.
    fn is_inside(&self, p: Vec2, place: Inclusion) -> bool {
        let beside = [self.polygon.count - 1, 0, 1];
        let mut sides = beside
            .into_iter()
            .map(|steps| self.polygon.side(self.after(self.at, steps)));
        match place {
            Inclusion::Inside => true,
            Inclusion::Outside => false,
            Inclusion::OnBorder => sides.all(|side| side.height(p) * self.turn >= -side.slack),
        }
    }
}

/// Adds the corners of the intersection to `corners`. Returns `false` if a polygon is too thin for sectors.
/// Sources are numbered as in [`Clipper`](super::clip::Clipper).
pub(super) fn intersect(
    window: &PolygonRows,
    subject: &PolygonRows,
    corners: &mut ClipVertices,
) -> bool {
    let sectors = [Sectors::new(window, 1.0), Sectors::new(subject, -1.0)];
    let [Some(mut of_window), Some(mut of_subject)] = sectors else {
        return false;
    };
    let width = subject.width();
    let subject_source = window.width() * width;
    let window_source = subject_source + width;
    of_window.enter(subject.side(0).at);
    let mut place = of_window.place(subject.side(0).at);
    for j in 0..subject.count {
        let side = subject.side(j);
        if of_window.is_inside(side.at, place) {
            corners.push(side.at, subject_source + j);
        }
        let end = side.at + side.along;
        let beyond = window.side(of_window.at);
        let start = place;
        let (first, count) = of_window.follow(side.at, end);
        place = of_window.place(end);
        // A side that begins and ends inside is inside, and a side that stays outside one side is outside.
        let is_inside = start == Inclusion::Inside && place == Inclusion::Inside;
        let is_outside =
            start == Inclusion::Outside && beyond.height(end) < -CLEARLY_BESIDE * beyond.slack;
        if is_inside || is_outside {
            continue;
        }
        for steps in 0..count {
            let i = of_window.after(first, steps);
            if let Some(at) = window.side(i).crossing(&side) {
                corners.push(at, i * width + j);
            }
        }
    }
    of_subject.enter(window.side(0).at);
    for i in 0..window.count {
        let side = window.side(i);
        let place = of_subject.place(side.at);
        if of_subject.is_inside(side.at, place) {
            corners.push(side.at, window_source + i);
        }
        of_subject.follow(side.at, side.at + side.along);
    }
    true
}

/// The centroid of a polygon.
fn center(polygon: &PolygonRows) -> Option<Vec2> {
    let origin: Line = polygon.side(0);
    let (mut area, mut moment) = (0.0, Vec2::ZERO);
    for i in 1..polygon.count - 1 {
        let side = polygon.side(i);
        let from = side.at - origin.at;
        let doubled = from.perp_dot(side.along);
        area += doubled;
        moment += (from + from + side.along) * doubled;
    }
    let center = origin.at + moment / (3.0 * area);
    center.is_finite().then_some(center)
}
