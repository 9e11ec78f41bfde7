//! The surface of a point cloud's hull, by parry's hull builder.

use std::collections::{HashMap, HashSet};

use glam::{DMat3, DVec3, Vec3};

use super::validate::validate_finite;
use crate::hull::{Hull, HullError};
use crate::support::{FaceId, Polytope, Support};
use crate::tolerance::{MAX_LEFT_OUT, MIN_EXTENT, MIN_TRUSTED_THICKNESS};

/// Gives `build` the vertices and triangles around a point cloud.
///
/// The builder decides in f32 what is flat, and finds no convex surface around needles and discs
/// that are too thin for that, or one that leaves corners out. Such a cloud is whitened first: an
/// affine map changes nothing of a hull but its coordinates.
pub(crate) fn hull_of_points<T: AsRef<Hull>>(
    points: &[Vec3],
    build: impl Fn(Vec<Vec3>, &[[u32; 3]]) -> Result<T, HullError>,
) -> Result<T, HullError> {
    if points.len() < 4 {
        return Err(HullError::TooFewPoints);
    }
    validate_finite(points)?;
    let around_all = |vertices, triangles: &[[u32; 3]]| {
        let built = build(vertices, triangles)?;
        if misses_points(built.as_ref(), points) {
            return Err(HullError::BuilderFailed);
        }
        Ok(built)
    };
    let as_it_is = || {
        let (vertices, triangles) = triangulate(points)?;
        around_all(vertices, &triangles)
    };
    let after_whitening = || {
        let whitened = whiten(points)?;
        let (vertices, triangles) = triangulate(&whitened).ok()?;
        around_all(unwhiten(points, &whitened, &vertices), &triangles).ok()
    };
    as_it_is().or_else(|error| after_whitening().ok_or(error))
}

fn triangulate(points: &[Vec3]) -> Result<(Vec<Vec3>, Vec<[u32; 3]>), HullError> {
    let (vertices, triangles) =
        parry3d::transformation::try_convex_hull(points).map_err(|_| HullError::BuilderFailed)?;
    // Of points on a line the builder keeps the ends.
    if vertices.len() < 4 {
        return Err(HullError::Flat);
    }
    Ok((vertices, triangles))
}

/// Whether one of the points is outside of a hull that is thin: of others the builder leaves none out.
fn misses_points(hull: &Hull, points: &[Vec3]) -> bool {
    let faces = || 0..hull.face_count() as FaceId;
    let height = |face, p: DVec3| hull.face_normal(face).dot(p) - hull.face_offset(face);
    let thick = MIN_TRUSTED_THICKNESS * hull.radius();
    let is_thin = faces().any(|face| -height(face, hull.center()) < thick);
    if !is_thin {
        return false;
    }
    let is_above = |p: DVec3| faces().any(|face| height(face, p) > MAX_LEFT_OUT * hull.radius());
    // Vertices need no look at all faces, and neither do points in an ellipsoid inside of the hull. Large
    // clouds may have hardly any others.
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    let vertices: HashSet<_> = hull.points().iter().map(bits).collect();
    let is_inner = inner_ellipsoid(hull);
    let mut others = points.iter().filter(|p| !vertices.contains(&bits(p)));
    others.any(|p| !is_inner(p.as_dvec3()) && is_above(p.as_dvec3()))
}

/// Tells which points are in an ellipsoid around the centre that touches the hull from inside.
fn inner_ellipsoid(hull: &Hull) -> impl Fn(DVec3) -> bool {
    let whitening = Whitening::of(hull.points());
    let center = hull.center();
    let size = whitening.as_ref().map_or(0.0, |whitening| {
        let size = |face| {
            let normal = hull.face_normal(face);
            (hull.face_offset(face) - normal.dot(center)) / whitening.extent(normal)
        };
        let sizes = (0..hull.face_count() as FaceId).map(size);
        sizes.fold(f64::INFINITY, f64::min)
    });
    move |p| {
        let image = whitening
            .as_ref()
            .map(|whitening| whitening.image(p - center));
        image.is_some_and(|image| image.length() < size)
    }
}

/// An affine image of the points with unit covariance; `None` if they span no volume.
fn whiten(points: &[Vec3]) -> Option<Vec<Vec3>> {
    let whitening = Whitening::of(points)?;
    let image = |p: &Vec3| whitening.image(p.as_dvec3() - whitening.mean).as_vec3();
    Some(points.iter().map(image).collect())
}

/// The linear map that gives points unit covariance: Cholesky's factor of their covariance undoes it.
struct Whitening {
    mean: DVec3,
    /// The factor, column by column.
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl Whitening {
    /// `None` if the points span no volume.
    fn of(points: &[Vec3]) -> Option<Self> {
        let count = points.len() as f64;
        let exact = || points.iter().map(|p| p.as_dvec3());
        let mean = exact().sum::<DVec3>() / count;
        let outer = |d: DVec3| DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        let covariance = exact().fold(DMat3::ZERO, |sum, p| sum + outer(p - mean)) * count.recip();
        let [x, y, z] = [covariance.x_axis, covariance.y_axis, covariance.z_axis];
        let least = MIN_EXTENT * MIN_EXTENT * (x.x + y.y + z.z);
        let root = |pivot: f64| (pivot > least).then(|| pivot.sqrt());
        let xx = root(x.x)?;
        let (xy, xz) = (x.y / xx, x.z / xx);
        let yy = root(y.y - xy * xy)?;
        let yz = (y.z - xy * xz) / yy;
        let zz = root(z.z - xz * xz - yz * yz)?;
        Some(Self {
            mean,
            x: DVec3::new(xx, xy, xz),
            y: DVec3::new(0.0, yy, yz),
            z: DVec3::new(0.0, 0.0, zz),
        })
    }

    /// Where the map takes a vector.
    fn image(&self, d: DVec3) -> DVec3 {
        let x = d.x / self.x.x;
        let y = (d.y - self.x.y * x) / self.y.y;
        let z = (d.z - self.x.z * x - self.y.z * y) / self.z.z;
        DVec3::new(x, y, z)
    }

    /// How far the ellipsoid whose image is the unit ball reaches along a direction.
    fn extent(&self, dir: DVec3) -> f64 {
        DVec3::new(self.x.dot(dir), self.y.dot(dir), self.z.dot(dir)).length()
    }
}

/// The points whose images the builder chose as vertices.
fn unwhiten(points: &[Vec3], images: &[Vec3], chosen: &[Vec3]) -> Vec<Vec3> {
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    let of_image: HashMap<_, _> = images.iter().map(bits).zip(points).collect();
    chosen
        .iter()
        .map(|vertex| *of_image[&bits(vertex)])
        .collect()
}
