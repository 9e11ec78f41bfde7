//! Convex outlines of points in a plane.

use glam::DVec2;

/// The convex outline of numbered points, counter-clockwise (Andrew, *Another efficient algorithm for convex hulls in
/// two dimensions*, IPL 9(5), 1979).
pub(super) fn convex_outline(mut points: Vec<(DVec2, u16)>) -> Vec<(DVec2, u16)> {
    points.sort_by(|(a, i), (b, j)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(i.cmp(j)));
    points.dedup();
    let mut outline = half_outline(points.iter());
    outline.extend(half_outline(points.iter().rev()));
    outline
}

/// Half of an outline, from the first point up to the last, which is left out.
fn half_outline<'a>(points: impl Iterator<Item = &'a (DVec2, u16)>) -> Vec<(DVec2, u16)> {
    let mut chain: Vec<(DVec2, u16)> = Vec::new();
    for &point in points {
        while let [.., (a, _), (b, _)] = chain[..]
            && (b - a).perp_dot(point.0 - a) <= 0.0
        {
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}

/// Whether a segment crosses the inside of an outline.
pub(super) fn crosses([from, to]: [DVec2; 2], outline: &[(DVec2, u16)]) -> bool {
    let ends = outline.iter().cycle().skip(1);
    // The part of the segment that is inside all sides so far.
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (&(a, _), &(b, _)) in outline.iter().zip(ends) {
        let [start, end] = [from, to].map(|p| (b - a).perp_dot(p - a));
        if start <= 0.0 && end <= 0.0 {
            return false;
        }
        let crossing = start / (start - end);
        if start < 0.0 {
            first = first.max(crossing);
        } else if end < 0.0 {
            last = last.min(crossing);
        }
    }
    first < last
}
