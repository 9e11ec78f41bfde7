//! Convex shapes as lines of a recording.

use parry3d::math::{Real, Vector};
use parry3d::shape::{
    ConvexPolyhedron, Cuboid, HalfSpace, RoundConvexPolyhedron, RoundCuboid, RoundShape, Segment,
    Shape, ShapeType, SharedShape, Triangle, TypedShape,
};

use super::error::{RecordingError, RecordingErrorKind};
use super::lines::{self, Lines, Words};
use crate::at::At;
use crate::hull::build::polyhedron;
use crate::parry::hull_shape::HullShape;

/// What a shape is made of, in the order in which it is written.
struct Description<'a> {
    name: String,
    numbers: Vec<Real>,
    surface: Option<&'a ConvexPolyhedron>,
}

impl<'a> Description<'a> {
    fn of(shape: &'a dyn Shape) -> Option<Self> {
        use TypedShape as Typed;
        let is_prepared = shape.as_shape::<HullShape>().is_some();
        if shape.shape_type() == ShapeType::Custom && !is_prepared {
            // The typed shape of a user's own shape may only be similar.
            return None;
        }
        let mut surface = None;
        let (name, numbers) = match shape.as_typed_shape() {
            Typed::ConvexPolyhedron(hull) => {
                surface = Some(hull);
                (if is_prepared { "hull-shape" } else { "hull" }, vec![])
            }
            Typed::Ball(ball) => ("ball", vec![ball.radius]),
            Typed::Cuboid(cuboid) => ("cuboid", flat(&[cuboid.half_extents])),
            Typed::Capsule(capsule) => {
                let Segment { a, b } = capsule.segment;
                ("capsule", [&flat(&[a, b])[..], &[capsule.radius]].concat())
            }
            Typed::Segment(Segment { a, b }) => ("segment", flat(&[*a, *b])),
            Typed::Triangle(Triangle { a, b, c }) => ("triangle", flat(&[*a, *b, *c])),
            Typed::HalfSpace(half_space) => ("half-space", flat(&[half_space.normal])),
            Typed::Cylinder(cylinder) => ("cylinder", vec![cylinder.half_height, cylinder.radius]),
            Typed::Cone(cone) => ("cone", vec![cone.half_height, cone.radius]),
            Typed::RoundConvexPolyhedron(round) => return Self::rounded(round),
            Typed::RoundCuboid(round) => return Self::rounded(round),
            Typed::RoundTriangle(round) => return Self::rounded(round),
            Typed::RoundCylinder(round) => return Self::rounded(round),
            Typed::RoundCone(round) => return Self::rounded(round),
            _ => return None,
        };
        Some(Self {
            name: name.to_owned(),
            numbers,
            surface,
        })
    }

    fn rounded(round: &'a RoundShape<impl Shape>) -> Option<Self> {
        let inner = Self::of(&round.inner_shape)?;
        Some(Self {
            name: format!("round-{}", inner.name),
            numbers: [&inner.numbers[..], &[round.border_radius]].concat(),
            ..inner
        })
    }
}

fn flat(points: &[Vector]) -> Vec<Real> {
    points.iter().flat_map(|p| p.to_array()).collect()
}

/// Appends a shape to `text`; `None` if a recording cannot have it.
pub(super) fn write(shape: &dyn Shape, text: &mut String) -> Option<()> {
    let Description {
        name,
        numbers,
        surface,
    } = Description::of(shape)?;
    lines::push(&format!("shape {name}"), &numbers, text);
    let Some(surface) = surface else {
        return Some(());
    };
    let triangles = triangles(surface)?;
    lines::push("points", &[surface.points().len()], text);
    for point in surface.points() {
        lines::push("", &point.to_array(), text);
    }
    lines::push("triangles", &[triangles.len()], text);
    for triangle in triangles {
        lines::push("", &triangle, text);
    }
    Some(())
}

/// The surface of a polyhedron, if parry makes a polyhedron of it again.
fn triangles(polyhedron: &ConvexPolyhedron) -> Option<Vec<[u32; 3]>> {
    let triangles = polyhedron::triangles(polyhedron).unwrap_or_else(|| polyhedron.to_trimesh().1);
    let points = polyhedron.points().to_vec();
    ConvexPolyhedron::from_convex_mesh(points, &triangles).map(|_| triangles)
}

/// Reads a shape, from its first line on.
pub(super) fn read(lines: &mut Lines<'_>) -> Result<SharedShape, RecordingError> {
    let mut words = lines.after("shape")?;
    let name = possible_name(&mut words)?;
    let shape = match name {
        "hull" => SharedShape::new(surface(lines)?),
        "hull-shape" => {
            let hull = HullShape::try_from(surface(lines)?);
            SharedShape::new(hull.map_err(|_| lines.error(RecordingErrorKind::BadShape))?)
        }
        "round-hull" => SharedShape::new(RoundConvexPolyhedron {
            border_radius: words.number()?,
            inner_shape: surface(lines)?,
        }),
        "ball" => SharedShape::ball(words.number()?),
        "cuboid" => SharedShape::new(Cuboid::new(words.vector()?)),
        "round-cuboid" => SharedShape::new(RoundCuboid {
            inner_shape: Cuboid::new(words.vector()?),
            border_radius: words.number()?,
        }),
        "capsule" => SharedShape::capsule(words.vector()?, words.vector()?, words.number()?),
        "segment" => SharedShape::segment(words.vector()?, words.vector()?),
        "triangle" => SharedShape::triangle(words.vector()?, words.vector()?, words.vector()?),
        "round-triangle" => {
            let [a, b, c] = [words.vector()?, words.vector()?, words.vector()?];
            SharedShape::round_triangle(a, b, c, words.number()?)
        }
        "half-space" => SharedShape::new(HalfSpace {
            normal: words.vector()?,
        }),
        "cylinder" => SharedShape::cylinder(words.number()?, words.number()?),
        "round-cylinder" => {
            SharedShape::round_cylinder(words.number()?, words.number()?, words.number()?)
        }
        "cone" => SharedShape::cone(words.number()?, words.number()?),
        "round-cone" => SharedShape::round_cone(words.number()?, words.number()?, words.number()?),
        _ => return Err(words.error(RecordingErrorKind::UnknownShape(name.to_owned()))),
    };
    words.end()?;
    Ok(shape)
}

/// The name of a shape, which may have the numbers after it. Some shapes consist of points, and others only of sizes,
/// where parry panics if one is negative.
fn possible_name<'a>(words: &mut Words<'a>) -> Result<&'a str, RecordingError> {
    const OF_POINTS: [&str; 5] = [
        "segment",
        "capsule",
        "triangle",
        "round-triangle",
        "half-space",
    ];
    let name = words.next_word()?;
    let has_points = OF_POINTS.contains(&name);
    let is_possible = |n: Real| n.is_finite() && (has_points || n.is_sign_positive());
    match words.reals().all(is_possible) {
        true => Ok(name),
        false => Err(words.error(RecordingErrorKind::BadShape)),
    }
}

fn surface(lines: &mut Lines<'_>) -> Result<ConvexPolyhedron, RecordingError> {
    let points = lines.list("points", |words| words.vector())?;
    let triangles = lines.list("triangles", |words| words.numbers::<u32, 3>())?;
    let is_known = |corner: &u32| points.try_at(*corner).is_some();
    let bad = lines.error(RecordingErrorKind::BadShape);
    let are_finite = points.iter().all(|point| point.is_finite());
    if !are_finite || !triangles.as_flattened().iter().all(is_known) {
        return Err(bad);
    }
    ConvexPolyhedron::from_convex_mesh(points, &triangles).ok_or(bad)
}
