//! A box centred at its origin, with the supports and faces of a polytope in closed form.

use glam::DVec3;

use crate::stats::Cost;
use crate::support::{
    EdgeId, FaceCorners, FaceId, Polytope, ShapeId, ShapeKind, Support, VertexId,
};

/// A box by its half extents. Bit `k` of a vertex id is set where coordinate `k` is positive;
/// face `2 k` looks along axis `k`, face `2 k + 1` against it.
#[derive(Clone, Copy, Debug)]
pub struct CuboidPolytope {
    half_extents: DVec3,
    radius: f64,
}

/// The corners of each face, counter-clockwise from outside.
const FACES: [[u8; 4]; 6] = [
    [1, 3, 7, 5],
    [0, 4, 6, 2],
    [2, 6, 7, 3],
    [0, 1, 5, 4],
    [4, 5, 7, 6],
    [0, 2, 3, 1],
];

impl CuboidPolytope {
    /// A box with these half extents.
    pub fn new(half_extents: DVec3) -> Self {
        Self {
            half_extents,
            radius: half_extents.length(),
        }
    }

    #[inline]
    fn corner(dir: DVec3) -> VertexId {
        let [x, y, z] = [dir.x, dir.y, dir.z].map(|x| u32::from(x > 0.0));
        VertexId::from(x | y << 1 | z << 2)
    }
}

impl Support for CuboidPolytope {
    #[inline]
    fn support(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        cost.supports += 1;
        // Where a coordinate of the direction is zero both signs tie: stay at the start, so
        // that a resting box does not swap its vertices.
        let mut vertex = Self::corner(dir).index();
        for k in 0..3 {
            if dir[k] == 0.0 {
                vertex = vertex & !(1 << k) | start.index() & (1 << k);
            }
        }
        let vertex = VertexId::new(vertex);
        (self.vertex(vertex), vertex)
    }

    #[inline]
    fn start_vertex(&self, dir: DVec3) -> VertexId {
        Self::corner(dir)
    }

    #[inline]
    fn clamp_vertex(&self, vertex: VertexId) -> VertexId {
        VertexId::new(vertex.index() & 7)
    }

    #[inline]
    fn may_roll(&self) -> bool {
        false
    }

    #[inline]
    fn id(&self) -> Option<ShapeId> {
        Some(ShapeId::described_by(
            ShapeKind::Cuboid,
            self.half_extents.to_array(),
        ))
    }

    #[inline]
    fn radius(&self) -> f64 {
        self.radius
    }
}

impl Polytope for CuboidPolytope {
    #[inline]
    fn vertex(&self, vertex: VertexId) -> DVec3 {
        let h = self.half_extents;
        let sign = |k: u32, x: f64| if vertex.index() >> k & 1 == 1 { x } else { -x };
        DVec3::new(sign(0, h.x), sign(1, h.y), sign(2, h.z))
    }

    #[inline]
    fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> {
        (0..3).map(move |k| VertexId::new(vertex.index() ^ 1 << k))
    }

    #[inline]
    fn has_face(&self, face: FaceId) -> bool {
        face.index() < 6
    }

    #[inline]
    fn face_normal(&self, face: FaceId) -> DVec3 {
        let mut normal = DVec3::ZERO;
        normal[face.index() / 2] = if face.index() & 1 == 0 { 1.0 } else { -1.0 };
        normal
    }

    #[inline]
    fn face_offset(&self, face: FaceId) -> f64 {
        self.half_extents[face.index() / 2]
    }

    #[inline]
    fn face_len(&self, _: FaceId) -> usize {
        4
    }

    #[inline]
    fn face_vertex(&self, face: FaceId, i: usize) -> VertexId {
        VertexId::new(FACES[face.index()][i].into())
    }

    #[inline]
    fn face_inset(&self, face: FaceId, p: DVec3) -> Option<f64> {
        let mut insets = self.half_extents - p.abs();
        insets[face.index() / 2] = f64::INFINITY;
        Some(insets.min_element())
    }

    /// On its way, the line passes the planes of up to three faces. Between two of these planes, its distance from the
    /// box is that from the faces that it has passed.
    fn height_of_border(&self, point: DVec3, dir: DVec3, width: f64) -> Option<f64> {
        let mut passed = [0, 1, 2].map(|k| {
            let height = (self.half_extents[k] - point[k] * dir[k].signum()) / dir[k].abs();
            (height.max(0.0), dir[k] * dir[k])
        });
        passed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let ends = [passed[1].0, passed[2].0, f64::INFINITY];
        // At a height, half the slope of the squared distance, and that distance; and half the slope's slope.
        let (mut slope, mut squared, mut bend) = (0.0, 0.0, 0.0);
        let mut height = passed[0].0;
        for ((_, share), end) in passed.into_iter().zip(ends) {
            bend += share;
            let missing = width * width - squared;
            let way = missing / (slope + (slope * slope + bend * missing).sqrt());
            if height + way <= end {
                return Some(height + way);
            }
            let step = end - height;
            squared += step * (2.0 * slope + step * bend);
            slope += step * bend;
            height = end;
        }
        None
    }

    #[inline]
    fn face_corners(&self, face: FaceId) -> impl FaceCorners {
        (self, face)
    }

    #[inline]
    fn face_at_vertex(&self, vertex: VertexId, dir: DVec3) -> FaceId {
        let mut best = (f64::NEG_INFINITY, FaceId::default());
        for k in 0..3 {
            let positive = vertex.index() >> k & 1 == 1;
            let aligned = if positive { dir[k] } else { -dir[k] };
            if aligned > best.0 {
                best = (aligned, FaceId::new(2 * k + usize::from(!positive)));
            }
        }
        best.1
    }

    #[inline]
    fn face_at_edge(&self, edge: EdgeId, dir: DVec3) -> FaceId {
        let [from, to] = self.edge_ends(edge).unwrap_or_default();
        // Of the three faces at an end, the edge belongs to the two that are not square to it.
        let along = (from.index() ^ to.index()).trailing_zeros().min(2);
        let mut across = dir;
        across[along as usize] = if from.index() >> along & 1 == 1 {
            f64::NEG_INFINITY
        } else {
            f64::INFINITY
        };
        self.face_at_vertex(from, across)
    }

    #[inline]
    fn edge_between(&self, from: VertexId, to: VertexId) -> Option<EdgeId> {
        let (low, high) = (from.min(to).index(), from.max(to).index());
        (high < 8 && (low ^ high).is_power_of_two()).then(|| EdgeId::new(low << 3 | high))
    }

    #[inline]
    fn edge_ends(&self, edge: EdgeId) -> Option<[VertexId; 2]> {
        let ends = [edge.index() >> 3, edge.index() & 7].map(VertexId::new);
        (self.edge_between(ends[0], ends[1]) == Some(edge)).then_some(ends)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_ends_where_it_is_as_far_away_as_wide() {
        let half = DVec3::new(1.0, 0.3, 2.0);
        let cuboid = CuboidPolytope::new(half);
        let mut rng = oorandom::Rand64::new(7);
        let mut within = || {
            let mut number = || 2.0 * rng.rand_float() - 1.0;
            DVec3::new(number(), number(), number())
        };
        for round in 0..3000 {
            let mut point = within() * half;
            for k in 0..round % 4 {
                point[k] = half[k].copysign(point[k]);
            }
            let mut dir = within();
            for k in 0..round / 4 % 3 {
                dir[k] *= if round % 5 == 0 { 0.0 } else { 1e-9 };
            }
            let dir = dir.normalize();
            let width = 10.0_f64.powi(-(round as i32 % 6));
            let height = cuboid
                .height_of_border(point, dir, width)
                .expect("a border");
            let outside = |height: f64| {
                ((point + dir * height).abs() - half)
                    .max(DVec3::ZERO)
                    .length()
            };
            assert!(
                (outside(height) - width).abs() < 1e-12,
                "{point} {dir} {width}: {height}"
            );
            // On its way out, the distance does not fall.
            assert!(outside(height - 1e-3 * width) < width);
        }
    }

    #[test]
    fn faces_turn_counter_clockwise_on_their_planes() {
        let cuboid = CuboidPolytope::new(DVec3::new(1.0, 2.0, 3.0));
        for face in (0..6).map(FaceId::new) {
            let corner = |i| cuboid.vertex(cuboid.face_vertex(face, i));
            let normal = cuboid.face_normal(face);
            assert!(
                (corner(1) - corner(0))
                    .cross(corner(2) - corner(1))
                    .dot(normal)
                    > 0.0
            );
            for i in 0..4 {
                assert_eq!(corner(i).dot(normal), cuboid.face_offset(face));
                let (a, b) = (
                    cuboid.face_vertex(face, i),
                    cuboid.face_vertex(face, (i + 1) % 4),
                );
                let edge = cuboid.edge_between(a, b).expect("neighbours share an edge");
                assert_eq!(cuboid.edge_ends(edge), Some([a.min(b), a.max(b)]));
            }
        }
    }
}
