//! The faces of a user's own shape.
//!
//! What a shape takes for a face need not be one. Parry's hulls merge triangles up to 1.5 degrees apart, and tell four
//! corners of the result; and a round side shows a polygon in its place. So no point of the shape may be above a face.

use glam::DVec3;

use super::feature::{ExtremeFeature, id_by_place};
use super::shape::{CustomShape, extreme};
use crate::support::{Support, VertexId};
use crate::tuning::{MAX_PORTALS, SMALL_TURN};

type Corner = (DVec3, VertexId);

impl CustomShape<'_> {
    /// The face that is extreme along `dir`, and its outward unit normal. Where the shape merges several into one, the
    /// one under its middle.
    pub(super) fn face(&self, dir: DVec3) -> Option<(ExtremeFeature, DVec3)> {
        let feature = self.feature(dir, 3)?;
        let normal = feature.area().try_normalize()?;
        let (feature, normal) = if normal.dot(dir) < 0.0 {
            (feature.reversed(), -normal)
        } else {
            (feature, normal)
        };
        let highest = extreme(self.support, normal);
        if self.is_highest(&feature, normal, highest) {
            return Some((feature, normal));
        }
        self.face_under_middle(&feature, dir)
    }

    /// Whether the sides of a face are extreme along directions a little to their side of its normal. Those of a polygon
    /// in a disc are not.
    pub(super) fn are_edges(&self, face: &ExtremeFeature, normal: DVec3) -> bool {
        face.edges().all(|[a, b]| {
            let outward = (b - a).cross(normal).normalize_or_zero();
            let tilted = normal + outward * SMALL_TURN;
            tilted.dot(extreme(self.support, tilted) - a) <= self.rounding()
        })
    }

    /// Whether no point is higher along `normal` than the corners of a face, up to rounding.
    fn is_highest(&self, face: &ExtremeFeature, normal: DVec3, highest: DVec3) -> bool {
        let is_on_top =
            |&(corner, _): &Corner| normal.dot(highest - corner).abs() <= self.rounding();
        face.corners().iter().all(is_on_top)
    }

    /// The triangle on the surface that the line along `dir` through the middle of a polygon meets, by portal refinement
    /// (Snethen, "XenoCollide", in Game Programming Gems 7, 2008). `None` if the surface is round there.
    fn face_under_middle(
        &self,
        polygon: &ExtremeFeature,
        dir: DVec3,
    ) -> Option<(ExtremeFeature, DVec3)> {
        let corners = polygon.corners();
        let sum: DVec3 = corners.iter().map(|(corner, _)| corner).sum();
        let middle = sum / corners.len() as f64;
        let fan = corners.windows(2).skip(1);
        let mut portal = widest(fan.map(|side| [corners[0], side[0], side[1]]), middle, dir)?;
        for _ in 0..MAX_PORTALS {
            let face = ExtremeFeature::triangle(portal);
            let normal = face.area().try_normalize()?;
            let highest = extreme(self.support, normal);
            if self.is_highest(&face, normal, highest) {
                return Some((face, normal));
            }
            let apex = (highest, id_of(highest, corners));
            let [a, b, c] = portal;
            let around = [[a, b, apex], [b, c, apex], [c, a, apex]];
            portal = widest(around.into_iter(), middle, dir)?;
        }
        None
    }
}

/// The triangle, counter-clockwise seen against `dir`, inside of which a line along `dir` is farthest from its sides.
fn widest(
    triangles: impl Iterator<Item = [Corner; 3]>,
    middle: DVec3,
    dir: DVec3,
) -> Option<[Corner; 3]> {
    let inset = |triangle: &[Corner; 3]| ExtremeFeature::triangle(*triangle).inset(dir, middle);
    triangles.max_by(|a, b| inset(a).total_cmp(&inset(b)))
}

/// The id of a vertex: that of one of these corners, or one by its place.
fn id_of(vertex: DVec3, corners: &[Corner]) -> VertexId {
    let corner = corners.iter().find(|(corner, _)| *corner == vertex);
    corner.map_or_else(|| id_by_place(vertex), |&(_, id)| id)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use parry3d::shape::SharedShape;

    use super::*;

    /// Also where parry's hulls have merged triangles that are not in one plane.
    #[test]
    fn hulls_have_faces_in_all_directions() {
        let mut rng = oorandom::Rand32::new(5);
        let mut direction = || {
            let coordinates = [(); 3].map(|()| rng.rand_float() * 2.0 - 1.0);
            Vec3::from(coordinates).normalize_or(Vec3::X)
        };
        let mut merged = 0;
        for size in [0.06, 1.0] {
            for _ in 0..100 {
                let points: Vec<Vec3> = (0..16).map(|_| direction() * size).collect();
                let hull = SharedShape::convex_hull(&points).expect("a solid");
                let (shape, _) = CustomShape::of(&*hull).expect("a solid");
                for _ in 0..20 {
                    let dir = direction().as_dvec3();
                    let feature = shape.feature(dir, 3).expect("a face");
                    let (face, normal) = shape.face(dir).expect("a face");
                    let highest = normal.dot(extreme(shape.support, normal));
                    for (corner, _) in face.corners() {
                        let depth = highest - normal.dot(*corner);
                        assert!(depth <= 1e-5 * f64::from(size), "{depth} below the surface");
                    }
                    merged += usize::from(face.corners().len() < feature.corners().len());
                }
            }
        }
        assert!(merged > 20, "{merged}");
    }
}
