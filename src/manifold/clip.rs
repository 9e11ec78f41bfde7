//! Intersection of two convex polygons in the plane, edge by edge (Sutherland, Hodgman,
//! *Reentrant polygon clipping*, CACM 17(1), 1974), keeping track of what each corner is made of.

use glam::DVec2;

/// Where a corner of the intersection comes from. Indices are into the polygons as given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tag {
    /// A corner of the clipped polygon.
    Corner(usize),
    /// A corner of the window.
    Window(usize),
    /// An edge of the window crossing an edge of the clipped polygon.
    Crossing(usize, usize),
}

/// A corner while clipping: its place in the contact plane and the edge that leaves it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipVertex {
    pub at: DVec2,
    pub tag: Tag,
    /// The heights of both faces there, along the contact normal.
    pub heights: [f64; 2],
    edge: Edge,
}

/// A side of the growing intersection, named by the corner where it starts in its polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edge {
    Polygon(usize),
    Window(usize),
}

impl ClipVertex {
    /// The `i`-th corner of the polygon to be clipped.
    pub fn corner(at: DVec2, i: usize) -> Self {
        Self {
            at,
            tag: Tag::Corner(i),
            heights: [0.0; 2],
            edge: Edge::Polygon(i),
        }
    }

    /// From the first face to the second, along the contact normal.
    pub fn distance(&self) -> f64 {
        self.heights[1] - self.heights[0]
    }
}

/// Memory for clipping, kept from manifold to manifold so that none of them allocates.
#[derive(Clone, Debug, Default)]
pub struct ClipScratch {
    pub(super) window: Vec<DVec2>,
    pub(super) polygon: Vec<ClipVertex>,
    clipped: Vec<ClipVertex>,
    heights: Vec<f64>,
}

/// Clips `scratch.polygon` by `scratch.window`, which turns counter-clockwise, and leaves the
/// intersection in `scratch.polygon`.
pub(super) fn intersect(scratch: &mut ClipScratch) {
    let count = scratch.window.len();
    for i in 0..count {
        let from = scratch.window[i];
        let along = scratch.window[(i + 1) % count] - from;
        // Height over the window's edge: positive inside.
        scratch.heights.clear();
        scratch
            .heights
            .extend(scratch.polygon.iter().map(|v| along.perp_dot(v.at - from)));
        if scratch.heights.iter().all(|&h| h >= 0.0) {
            continue;
        }
        clip_by_edge(
            &scratch.polygon,
            &scratch.heights,
            &mut scratch.clipped,
            (i, count),
        );
        std::mem::swap(&mut scratch.polygon, &mut scratch.clipped);
    }
}

/// Keeps what lies inside of the `i`-th of `count` window edges.
fn clip_by_edge(
    polygon: &[ClipVertex],
    heights: &[f64],
    clipped: &mut Vec<ClipVertex>,
    (i, count): (usize, usize),
) {
    clipped.clear();
    for k in 0..polygon.len() {
        let next = (k + 1) % polygon.len();
        let (vertex, h, h_next) = (polygon[k], heights[k], heights[next]);
        if h >= 0.0 {
            clipped.push(vertex);
        }
        if (h >= 0.0) == (h_next >= 0.0) {
            continue;
        }
        let entering = h < 0.0;
        let t = h / (h - h_next);
        clipped.push(ClipVertex {
            at: vertex.at.lerp(polygon[next].at, t),
            tag: crossing(vertex.edge, (i, count)),
            heights: [0.0; 2],
            edge: if entering {
                vertex.edge
            } else {
                Edge::Window(i)
            },
        });
    }
}

/// What the crossing of a side with the `i`-th window edge is.
fn crossing(side: Edge, (i, count): (usize, usize)) -> Tag {
    match side {
        Edge::Polygon(j) => Tag::Crossing(i, j),
        // Two window edges meet where the later one starts; the first and the last are
        // neighbours, too.
        Edge::Window(j) if j == 0 && i + 1 == count => Tag::Window(0),
        Edge::Window(j) => Tag::Window(i.max(j)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(window: &[[f64; 2]], polygon: &[[f64; 2]]) -> Vec<ClipVertex> {
        let mut scratch = ClipScratch {
            window: window.iter().copied().map(DVec2::from).collect(),
            polygon: polygon
                .iter()
                .enumerate()
                .map(|(i, &p)| ClipVertex::corner(p.into(), i))
                .collect(),
            ..Default::default()
        };
        intersect(&mut scratch);
        scratch.polygon
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
            _ => usize::MAX,
        });
        assert_eq!(tags, [0, 1, 2, 3].map(Tag::Window));
        for corner in corners {
            let Tag::Window(i) = corner.tag else {
                unreachable!()
            };
            assert!(corner.at.distance(SQUARE[i].into()) < 1e-15);
        }
    }

    #[test]
    fn disjoint_polygons_do_not_meet() {
        let far = SQUARE.map(|[x, y]| [x + 3.0, y]);
        assert!(clip(&SQUARE, &far).is_empty());
    }
}
