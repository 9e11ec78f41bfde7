//! Convex shapes as lines of a recording.

use parry3d::math::{Real, Vector};
use parry3d::shape::{
    ConvexPolyhedron, Cuboid, HalfSpace, RoundConvexPolyhedron, RoundCuboid, RoundShape, Segment,
    Shape, ShapeType, SharedShape, Triangle, TypedShape,
};

use super::error::{RecordingError, RecordingErrorKind};
use super::lines::{self, Lines};
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
    let name = words.next_word()?;
    let shape = match name {
        "hull" => SharedShape::new(surface(lines)?),
        "hull-shape" => {
            let hull = HullShape::try_from(surface(lines)?);
            SharedShape::new(hull.map_err(|_| lines.error(RecordingErrorKind::BadShape))?)
        }
        "round-hull" => SharedShape::new(RoundConvexPolyhedron {
            border_radius: words.size()?,
            inner_shape: surface(lines)?,
        }),
        "ball" => SharedShape::ball(words.size()?),
        "cuboid" => SharedShape::new(Cuboid::new(words.sizes()?)),
        "round-cuboid" => SharedShape::new(RoundCuboid {
            inner_shape: Cuboid::new(words.sizes()?),
            border_radius: words.size()?,
        }),
        "capsule" => SharedShape::capsule(words.point()?, words.point()?, words.finite()?),
        "segment" => SharedShape::segment(words.point()?, words.point()?),
        "triangle" => SharedShape::triangle(words.point()?, words.point()?, words.point()?),
        "round-triangle" => {
            let [a, b, c] = [words.point()?, words.point()?, words.point()?];
            SharedShape::round_triangle(a, b, c, words.finite()?)
        }
        "half-space" => SharedShape::new(HalfSpace {
            normal: words.point()?,
        }),
        "cylinder" => SharedShape::cylinder(words.size()?, words.size()?),
        "round-cylinder" => {
            SharedShape::round_cylinder(words.size()?, words.size()?, words.size()?)
        }
        "cone" => SharedShape::cone(words.size()?, words.size()?),
        "round-cone" => SharedShape::round_cone(words.size()?, words.size()?, words.size()?),
        _ => return Err(words.error(RecordingErrorKind::UnknownShape(name.to_owned()))),
    };
    words.end()?;
    Ok(shape)
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
