//! Of casts, and of the normals that they show.

/// A ray cast has arrived if it is this near, relative to the pair's size and the way travelled (whose
/// coordinates are rounded). This is the square root of f64's roundoff: a nearest point is a sum of
/// coordinates, and a nearer one has no reliable direction in which the ray could advance.
pub const RAY_TOUCHING: f64 = 1e-8;

/// Shapes that come nearer than the target distance of a cast by less than this, relative to the pair's size, pass each
/// other: a body that was moved to this distance may be this much nearer, two roundings of f32.
pub const GRAZED: f64 = 2.4e-7;

/// Components of the normal of a cast below this are rounding, and zero. To rapier's character controller, a wall whose
/// normal points down at all is a ceiling, on which it looks for no step.
pub const NORMAL_ROUNDING: f64 = 1e-6;

/// Normals of casts are longer than 1 by this: four roundings, as many as one loses where it is turned by two
/// quaternions of f32. On a floor whose normal is shorter than 1, rapier's character controller moves nowhere: it
/// seems to slip.
pub const NORMAL_STRETCH: f32 = 1.0 + 4.0 * f32::EPSILON;
