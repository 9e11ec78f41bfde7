//! Intersection of two convex polygons in the plane, edge by edge (Sutherland, Hodgman,
//! *Reentrant polygon clipping*, CACM 17(1), 1974), keeping track of what each corner is made of.

use glam::DVec2;

/// Where a corner of the intersection comes from. Indices are into the polygons as given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tag {
    /// A corner of the clipped polygon.
    Corner(u16),
    /// A corner of the window.
    Window(u16),
    /// An edge of the window crossing an edge of the clipped polygon.
    Crossing(u16, u16),
}

/// A corner while clipping: its place in the contact plane and the edge that leaves it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipVertex {
    pub at: DVec2,
    /// From the first face to the second, along the contact normal.
    pub distance: f64,
    pub tag: Tag,
    edge: Edge,
}

/// A side of the growing intersection, named by the corner where it starts in its polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edge {
    Polygon(u16),
    Window(u16),
}

impl ClipVertex {
    /// The `i`-th corner of the polygon to be clipped.
    pub fn corner(at: DVec2, i: usize) -> Self {
        Self {
            at,
            distance: 0.0,
            tag: Tag::Corner(i as u16),
            edge: Edge::Polygon(i as u16),
        }
    }
}

/// The two polygons, and memory for clipping one by the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Polygons {
    pub window: Vec<DVec2>,
    pub subject: Vec<ClipVertex>,
    clipped: Vec<ClipVertex>,
    heights: Vec<f64>,
}

/// Clips the subject by the window, which turns counter-clockwise, and leaves the intersection in
/// the place of the subject.
pub(super) fn intersect(polygons: &mut Polygons) {
    let count = polygons.window.len();
    let mut to = polygons.window[0];
    for i in (0..count).rev() {
        let from = polygons.window[i];
        let along = to - from;
        to = from;
        // Height over the window's edge: positive inside.
        let mut lowest = f64::INFINITY;
        polygons.heights.clear();
        polygons.heights.extend(polygons.subject.iter().map(|v| {
            let height = along.perp_dot(v.at - from);
            lowest = lowest.min(height);
            height
        }));
        if lowest < 0.0 {
            polygons.clip_by_edge(i as u16, count as u16);
        }
    }
}

impl Polygons {
    /// Takes two polygons, of which the window turns counter-clockwise.
    pub fn fill(
        &mut self,
        window: impl Iterator<Item = DVec2>,
        subject: impl Iterator<Item = DVec2>,
    ) {
        self.window.clear();
        self.window.extend(window);
        self.subject.clear();
        let corners = subject.enumerate();
        self.subject
            .extend(corners.map(|(i, at)| ClipVertex::corner(at, i)));
    }

    /// Keeps what lies inside of the `i`-th of `count` window edges; `heights` are those above
    /// it.
    fn clip_by_edge(&mut self, i: u16, count: u16) {
        self.clipped.clear();
        let (Some(mut vertex), Some(mut height)) = (self.subject.last(), self.heights.last())
        else {
            return;
        };
        for (next, next_height) in self.subject.iter().zip(&self.heights) {
            if *height >= 0.0 {
                self.clipped.push(*vertex);
            }
            if (*height < 0.0) != (*next_height < 0.0) {
                let entering = *height < 0.0;
                self.clipped.push(ClipVertex {
                    at: vertex.at.lerp(next.at, height / (height - next_height)),
                    distance: 0.0,
                    tag: crossing(vertex.edge, i, count),
                    edge: if entering {
                        vertex.edge
                    } else {
                        Edge::Window(i)
                    },
                });
            }
            (vertex, height) = (next, next_height);
        }
        std::mem::swap(&mut self.subject, &mut self.clipped);
    }
}

/// What the crossing of a side with the `i`-th window edge is.
fn crossing(side: Edge, i: u16, count: u16) -> Tag {
    match side {
        Edge::Polygon(j) => Tag::Crossing(i, j),
        // Two window edges meet where the later one starts; the first and the last are
        // neighbours, too.
        Edge::Window(j) if i.abs_diff(j) + 1 == count => Tag::Window(0),
        Edge::Window(j) => Tag::Window(i.max(j)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(window: &[[f64; 2]], polygon: &[[f64; 2]]) -> Vec<ClipVertex> {
        let mut polygons = Polygons {
            window: window.iter().copied().map(DVec2::from).collect(),
            subject: polygon
                .iter()
                .enumerate()
                .map(|(i, &p)| ClipVertex::corner(p.into(), i))
                .collect(),
            ..Default::default()
        };
        intersect(&mut polygons);
        polygons.subject
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    #[test]
    fn shifted_squares_meet_in_a_corner_of_each_and_two_crossings() {
        let shifted = SQUARE.map(|[x, y]| [x + 0.5, y + 0.5]);
        // The clipped polygon turns the other way, as that of the second shape does.
        let reversed = [shifted[3], shifted[2], shifted[1], shifted[0]];
        let mut corners: Vec<_> = clip(&SQUARE, &reversed)
            .iter()
            .map(|v| (v.at, v.tag))
            .collect();
        corners.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.0.y.total_cmp(&b.0.y)));
        assert_eq!(
            corners,
            [
                (DVec2::new(0.5, 0.5), Tag::Corner(3)),
                (DVec2::new(0.5, 1.0), Tag::Crossing(2, 3)),
                (DVec2::new(1.0, 0.5), Tag::Crossing(1, 2)),
                (DVec2::new(1.0, 1.0), Tag::Window(2)),
            ]
        );
    }

    #[test]
    fn a_window_inside_of_the_polygon_is_the_intersection() {
        let around = SQUARE.map(|[x, y]| [4.0 * x - 2.0, 4.0 * y - 2.0]);
        let corners = clip(&SQUARE, &around);
        let mut tags: Vec<_> = corners.iter().map(|v| v.tag).collect();
        tags.sort_by_key(|tag| match tag {
            Tag::Window(i) => *i,
            _ => u16::MAX,
        });
        assert_eq!(tags, [0, 1, 2, 3].map(Tag::Window));
        for corner in corners {
            let Tag::Window(i) = corner.tag else {
                unreachable!()
            };
            assert!(corner.at.distance(SQUARE[i as usize].into()) < 1e-15);
        }
    }

    #[test]
    fn disjoint_polygons_do_not_meet() {
        let far = SQUARE.map(|[x, y]| [x + 3.0, y]);
        assert!(clip(&SQUARE, &far).is_empty());
    }
}
