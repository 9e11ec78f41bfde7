//! The hulls that fill the scenes.

use std::f32::consts::PI;
use std::fs;
use std::path::Path;

use isa_gjk::PreparedShapes;
use oorandom::Rand32;
use rapier3d::prelude::*;
use serde_json::Value;

use super::{HullSource, flat};

/// Bounding radius of generated hulls, in metres.
pub const RADIUS: Real = 0.5;
/// Bounding radius that hulls from files are scaled to: objects of about half a metre.
const FILE_RADIUS: Real = 0.28;
/// Sheets are no objects to pile up: they are left out below this ratio of thickness to size.
const MIN_EXTENT: f64 = 0.03;
/// Volume over the cube of the bounding radius below which a hull counts as flat.
const FLAT: Real = 1e-5;
/// Beginnings of the names of shapes that come from real objects.
const REAL: [&str; 5] = ["gr_", "husky_", "panda_", "pb_", "rs_"];

/// At most `distinct` hulls from `source`.
pub fn make(
    source: &HullSource,
    distinct: u32,
    random: &mut Rand32,
) -> Result<Vec<SharedShape>, String> {
    match source {
        HullSource::Random { vertices } => (0..distinct)
            .map(|_| hull(&sphere_points(*vertices, RADIUS, random), "random points"))
            .collect(),
        HullSource::Prism { sides } => (0..distinct)
            .map(|_| {
                let half_height = RADIUS * (0.4 + 0.3 * random.rand_float());
                prism(*sides, RADIUS, half_height)
            })
            .collect(),
        HullSource::Box => (0..distinct)
            .map(|_| {
                let mut size = || RADIUS * (0.3 + 0.4 * random.rand_float());
                cuboid(Vector::new(size(), size(), size()))
            })
            .collect(),
        HullSource::Own => Err("this scene makes its own hulls".to_owned()),
        HullSource::Real => real(distinct),
        HullSource::File(path) => {
            let hull = hull(&normalised(obj_points(path)?), &path.display().to_string())?;
            Ok(vec![hull])
        }
    }
}

/// At most `distinct` hulls to build towers of.
pub fn upright(
    source: &HullSource,
    distinct: u32,
    random: &mut Rand32,
) -> Result<Vec<SharedShape>, String> {
    match source {
        HullSource::Real => {
            let flat = real(u32::MAX)?
                .into_iter()
                .filter_map(|hull| flat::upright(&hull));
            Ok(flat.take(distinct as usize).collect())
        }
        _ => make(source, distinct, random),
    }
}

/// Points drawn uniformly on a sphere; each is a vertex of their hull.
pub fn sphere_points(count: u32, radius: Real, random: &mut Rand32) -> Vec<Vector> {
    (0..count)
        .map(|_| {
            let y = 2.0 * random.rand_float() - 1.0;
            let ring = (1.0 - y * y).sqrt();
            let (sin, cos) = (2.0 * PI * random.rand_float()).sin_cos();
            radius * Vector::new(ring * cos, y, ring * sin)
        })
        .collect()
}

/// An upright prism over a regular polygon with corners at this radius.
pub fn prism(sides: u32, radius: Real, half_height: Real) -> Result<SharedShape, String> {
    let points: Vec<_> = (0..sides)
        .flat_map(|side| {
            let (sin, cos) = (2.0 * PI * side as Real / sides as Real).sin_cos();
            [-half_height, half_height].map(|y| Vector::new(radius * cos, y, radius * sin))
        })
        .collect();
    hull(&points, &format!("a prism of {sides} sides"))
}

/// A table of hulls that lies on its top: a square of 12 cm, 12 mm thick. Its legs are at the corners and end
/// within the top, 6 mm above the ground.
pub fn upturned_table(legs: usize) -> Result<SharedShape, String> {
    let mut parts = vec![(
        Pose::translation(0.0, 0.006, 0.0),
        cuboid(Vector::new(0.06, 0.006, 0.06))?,
    )];
    let leg = cuboid(Vector::new(0.006, 0.036, 0.006))?;
    for (x, z) in [(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)]
        .into_iter()
        .take(legs)
    {
        parts.push((Pose::translation(0.051 * x, 0.042, 0.051 * z), leg.clone()));
    }
    Ok(SharedShape::compound(parts))
}

/// A cuboid of these half extents as a hull.
pub fn cuboid(half: Vector) -> Result<SharedShape, String> {
    hull(&Cuboid::new(half).to_trimesh().0, "the corners of a cuboid")
}

/// The hull of `points`, if it is a solid: rapier gives flat ones no mass.
pub fn hull(points: &[Vector], origin: &str) -> Result<SharedShape, String> {
    let shape = SharedShape::convex_hull(points);
    let solid = shape.filter(|shape| {
        let size = shape.compute_local_bounding_sphere().radius;
        shape.mass_properties(1.0).mass() > FLAT * size.powi(3)
    });
    solid.ok_or_else(|| {
        format!(
            "no solid hull around {origin}: use points that are not all in one plane, and fewer \
             if many are almost in the same place"
        )
    })
}

/// The shapes, all scaled so that the largest of them is of this extent.
pub fn scaled(shapes: &[SharedShape], size: Real) -> Result<Vec<SharedShape>, String> {
    let extent = |shape: &SharedShape| shape.compute_local_aabb().extents().max_element();
    let largest = shapes.iter().map(extent).fold(0.0, Real::max);
    shapes
        .iter()
        .map(|shape| match scaled_by(size / largest, shape) {
            Some(scaled) => Ok(SharedShape(scaled.into())),
            None => Err(format!("no body of this scene can have a size of {size} m")),
        })
        .collect()
}

/// A shape scaled with its border, which parry leaves as it is.
fn scaled_by(factor: Real, shape: &SharedShape) -> Option<Box<dyn Shape>> {
    let mut scaled = shape.scale_dyn(Vector::splat(factor), 0)?;
    if let Some(cuboid) = scaled.as_round_cuboid_mut() {
        cuboid.border_radius *= factor;
    }
    if let Some(cylinder) = scaled.as_round_cylinder_mut() {
        cylinder.border_radius *= factor;
    }
    Some(scaled)
}

/// The shapes with `HullShape`s in the place of plain hulls.
pub fn prepared(shapes: &[SharedShape]) -> Result<Vec<SharedShape>, String> {
    let mut known = PreparedShapes::default();
    let prepared = shapes.iter().map(|shape| known.prepare(shape)).collect();
    match known.refused().first() {
        Some(error) => Err(format!("a hull cannot be prepared: {error}")),
        None => Ok(prepared),
    }
}

/// Hulls of real objects, in the order of their names.
fn real(distinct: u32) -> Result<Vec<SharedShape>, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/hulls/shapes");
    let index = read_json(&folder.join("INDEX.json"))?;
    let mut names: Vec<_> = index
        .as_array()
        .into_iter()
        .flatten()
        .filter(|entry| entry["thinness"].as_f64().is_some_and(|t| t >= MIN_EXTENT))
        .filter_map(|entry| entry["name"].as_str())
        .filter(|name| REAL.iter().any(|beginning| name.starts_with(beginning)))
        .collect();
    names.sort_unstable();
    let chosen = names.into_iter().take(distinct as usize);
    chosen
        .map(|name| {
            let points = json_points(&folder.join(format!("{name}.json")))?;
            hull(&normalised(points), name)
        })
        .collect()
}

fn json_points(path: &Path) -> Result<Vec<Vector>, String> {
    let value = read_json(path)?;
    let points =
        serde_json::from_value::<Vec<[Real; 3]>>(value["points"].clone()).map_err(|error| {
            format!(
                "{}: `points` is no list of x, y, z: {error}",
                path.display()
            )
        })?;
    Ok(points.into_iter().map(Vector::from).collect())
}

fn read_json(path: &Path) -> Result<Value, String> {
    serde_json::from_str(&read(path)?)
        .map_err(|error| format!("{} is no valid JSON: {error}", path.display()))
}

/// The `v` lines of a Wavefront file: a hull needs nothing else of it.
fn obj_points(path: &Path) -> Result<Vec<Vector>, String> {
    let text = read(path)?;
    let points = text
        .lines()
        .enumerate()
        .filter_map(|(number, line)| {
            let mut words = line.split_whitespace();
            (words.next() == Some("v")).then(|| {
                vertex(words).ok_or_else(|| {
                    format!(
                        "{}:{}: expected `v x y z` with finite numbers, found `{line}`",
                        path.display(),
                        number + 1
                    )
                })
            })
        })
        .collect::<Result<Vec<_>, _>>()?;
    if points.len() < 4 {
        return Err(format!(
            "{} has {} vertices (lines `v x y z`): a solid needs at least 4",
            path.display(),
            points.len()
        ));
    }
    Ok(points)
}

fn vertex<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Vector> {
    let mut coordinate = || words.next()?.parse::<Real>().ok();
    let point = Vector::new(coordinate()?, coordinate()?, coordinate()?);
    point.is_finite().then_some(point)
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}

/// Centred at the mean of the points and scaled to [`FILE_RADIUS`].
fn normalised(points: Vec<Vector>) -> Vec<Vector> {
    let centre = points.iter().sum::<Vector>() / points.len() as Real;
    let radius = points
        .iter()
        .map(|p| p.distance(centre))
        .fold(0.0, Real::max);
    let scale = FILE_RADIUS / radius.max(Real::MIN_POSITIVE);
    points.into_iter().map(|p| (p - centre) * scale).collect()
}
