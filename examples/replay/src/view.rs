//! Bodies as they are drawn on the picture of a film: outlines, seen by a camera without perspective.

use std::fmt::Write;

use rapier3d::prelude::{Collider, Pose, Real, Rotation, Shape, TypedShape, Vector};

use crate::mesh;

/// Pixels of the picture of a world.
pub const WIDTH: Real = 280.0;
pub const HEIGHT: Real = 250.0;
/// How far beneath the top the lowest bodies are at the start.
const BOTTOM: Real = 0.92 * HEIGHT;
/// How much more than the bodies at the start it shows: towers fall over.
const ROOM: [Real; 2] = [1.5, 1.1];
/// The camera's turn about the vertical, and its height above the horizon, in radians.
const AZIMUTH: Real = 0.6;
const ELEVATION: Real = 0.3;
/// Faces with at least this many corners are drawn apart from the rest of a body.
const MANY_CORNERS: usize = 5;

/// A camera without perspective.
pub struct View {
    turn: Rotation,
    /// Pixels in a metre.
    scale: Real,
    /// What is at the bottom in the middle, in metres to the right and up.
    centre: Vector,
}

impl View {
    /// One that sees all of these.
    pub fn around<'a>(colliders: impl Iterator<Item = &'a Collider>) -> Self {
        let turn = Rotation::from_rotation_x(ELEVATION) * Rotation::from_rotation_y(AZIMUTH);
        let corners = colliders.flat_map(corners).map(|corner| turn * corner);
        let (mut least, mut most) = (Vector::MAX, Vector::MIN);
        for corner in corners {
            (least, most) = (least.min(corner), most.max(corner));
        }
        let size = most - least;
        Self {
            turn,
            scale: (WIDTH / (ROOM[0] * size.x)).min(BOTTOM / (ROOM[1] * size.y)),
            centre: Vector::new(0.5 * (least.x + most.x), least.y, 0.0),
        }
    }

    /// How far something is behind the picture.
    pub fn depth(&self, point: Vector) -> Real {
        -(self.turn * point).z
    }

    /// On the picture, in pixels.
    fn project(&self, point: Vector) -> [i32; 2] {
        let seen = (self.turn * point - self.centre) * self.scale;
        [0.5 * WIDTH + seen.x, BOTTOM - seen.y].map(|x| x.round() as i32)
    }

    /// The outline of a body, and over it the outlines of faces with many corners.
    pub fn draw(&self, collider: &Collider, (dark, light): (&str, &str)) -> String {
        let pose = collider.position();
        let outline = convex_hull(corners(collider).map(|p| self.project(p)).collect());
        let mut body = format!("<path fill=\"{dark}\" d=\"{}\"/>", path(&outline));
        for face in large_faces(collider.shape()) {
            if let Some(polygon) = self.seen_face(pose, &face) {
                let _ = write!(body, "<path fill=\"{light}\" d=\"{}\"/>", path(&polygon));
            }
        }
        body
    }

    /// On the picture, if the face looks at it. Corners go round counter-clockwise, seen from
    /// outside.
    fn seen_face(&self, pose: &Pose, face: &[Vector]) -> Option<Vec<[i32; 2]>> {
        let seen = face.iter().map(|p| self.project(pose.transform_point(*p)));
        let polygon = convex_hull(seen.collect());
        let [a, b, c] = [0, 1, 2].map(|i| face[i * face.len() / 3]);
        let normal = self.turn * (pose.rotation * (b - a).cross(c - a));
        (normal.z > 0.0 && polygon.len() > 2).then_some(polygon)
    }
}

/// The corners of a collider, where it is now.
fn corners(collider: &Collider) -> impl Iterator<Item = Vector> {
    let pose = *collider.position();
    let corners = mesh::triangles(collider.shape()).into_iter();
    corners.map(move |corner| pose.transform_point(corner))
}

fn large_faces(shape: &dyn Shape) -> Vec<Vec<Vector>> {
    let TypedShape::ConvexPolyhedron(hull) = shape.as_typed_shape() else {
        return Vec::new();
    };
    let (points, names) = (hull.points(), hull.vertices_adj_to_face());
    let faces = hull.faces().iter().map(|face| {
        let first = face.first_vertex_or_edge as usize;
        let names = &names[first..first + face.num_vertices_or_edges as usize];
        names.iter().map(|name| points[*name as usize]).collect()
    });
    faces
        .filter(|face: &Vec<_>| face.len() >= MANY_CORNERS)
        .collect()
}

/// Corners of the convex hull of points in the plane (Andrew's monotone chain).
fn convex_hull(mut points: Vec<[i32; 2]>) -> Vec<[i32; 2]> {
    points.sort_unstable();
    points.dedup();
    let mut hull = half_hull(points.iter());
    hull.extend(half_hull(points.iter().rev()));
    hull
}

/// One side of it, without its last corner.
fn half_hull<'a>(points: impl Iterator<Item = &'a [i32; 2]>) -> Vec<[i32; 2]> {
    let mut chain: Vec<[i32; 2]> = Vec::new();
    for &point in points {
        while let [.., a, b] = chain[..]
            && cross(a, b, point) <= 0
        {
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}

fn cross(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> i32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// As differences from corner to corner, which are short.
fn path(polygon: &[[i32; 2]]) -> String {
    let mut d = String::new();
    let mut last = [0; 2];
    for (index, point) in polygon.iter().enumerate() {
        let command = if index == 0 { "M" } else { "l" };
        let [x, y] = [point[0] - last[0], point[1] - last[1]];
        let _ = write!(d, "{command}{x} {y}");
        last = *point;
    }
    d + "z"
}

#[cfg(test)]
mod tests {
    use rapier3d::prelude::{Collider, ColliderBuilder, Vector};

    use super::{HEIGHT, View, WIDTH, corners};

    #[test]
    fn all_bodies_at_the_start_are_in_the_picture() {
        let places = [[-30.0, 2.0, 5.0], [4.0, 50.0, -20.0], [8.0, 0.2, 9.0]];
        let colliders: Vec<Collider> = places
            .map(|place| {
                ColliderBuilder::ball(0.5)
                    .translation(Vector::from(place))
                    .build()
            })
            .into();
        let view = View::around(colliders.iter());
        for corner in colliders.iter().flat_map(corners) {
            let [x, y] = view.project(corner);
            assert!((0..=WIDTH as i32).contains(&x), "{x} across");
            assert!((0..=HEIGHT as i32).contains(&y), "{y} down");
        }
    }
}
