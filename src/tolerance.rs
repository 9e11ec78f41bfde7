//! Every tolerance of the crate, with its reason.
//!
//! Shapes come with f32 coordinates (unit roundoff 6e-8) and all arithmetic of queries is f64
//! (1e-16), so what is exact in the input stays decidable. A tolerance named "relative" is
//! multiplied by a length of the shapes at hand; none is an absolute length.

/// A face is a set of hull triangles that deviate from one plane by at most this share of the
/// hull's radius. Ten f32 roundings: flat caps become one polygon, and what a face certifies is
/// wrong by no more than this.
pub const FACE_FLATNESS: f64 = 6e-7;

/// Neighbouring triangles are only joined to a face when their normals are within 1 degree
/// (cosine), so that slivers of arbitrary direction cannot chain a face around a corner.
pub const FACE_ANGLE_COS: f64 = 0.999_847_7;

/// Faces within 1 degree (cosine) of a larger one around which they lie are a cap with it:
/// contacts are sought on all of them together. Distances are measured to the faces themselves, so
/// that the angle decides only how many corners are looked at; f32 rounding and scanning noise
/// stay below it, and the facets of round hulls of a thousand vertices above.
pub const CAP_ANGLE_COS: f64 = 0.999_847_7;

/// A triangle lower than this share of the radius is a sliver: rounding of its corners can turn
/// its plane by several degrees.
pub const SLIVER: f64 = 4e-6;

/// How deep (relative to the radius) an edge may be a dent: sixteen f32 roundings. Of a needle a
/// climb may lose many times what its dents are deep.
pub const CONVEXITY: f64 = 1e-6;

/// How far (relative to the radius) a hull may reach beyond the plane of a face: many dents in a row
/// make a bowl. The noise of scanned plates stays below it.
pub const BOWL: f64 = 5e-5;

/// A triangle lower than this share of the radius may face inwards by the rounding of its corners;
/// a higher one that does is a fold of the surface. Ten f32 roundings.
pub const FOLD: f64 = 6e-7;

/// A hull whose smallest extent is below this share of its radius has no usable interior.
pub const THINNEST: f64 = 1e-6;

/// A hull whose centre is deeper than this share of its radius beneath all faces is thick enough for the
/// f32 decisions of parry's hull builder: of thousands of clouds down to a seventh of it none lost a corner.
pub const THICK: f64 = 0.05;

/// A point may be outside of the hull that was built around it by this share of the radius: half of what
/// distances may be off.
pub const LEFT_OUT: f64 = 1e-5;

/// Two support values closer than this share of `radius * |direction|` tie for hill climbing:
/// vertices that are coplanar up to f32 rounding must be seen as one plateau.
pub const PLATEAU: f64 = 4e-7;

/// An edge shorter than this share of the radius may rise or fall by its ends' rounding alone, as
/// steeply as anything that is climbed.
pub const SHORT_EDGE: f64 = 1e-2;

/// The way up from a false summit may begin with a step down by this share of `radius * |direction|`:
/// a vertex is beneath its neighbours by no more than a few dents.
pub const DIP: f64 = 4.0 * CONVEXITY;

/// GJK stops when its bounds of the distance differ by less than this share of the distance...
pub const GJK_RELATIVE_GAP: f64 = 1e-9;

/// ...or by less than this share of the pair's size: the rounding of f64 sums of coordinates.
pub const GJK_ABSOLUTE_GAP: f64 = 1e-12;

/// ...or, in scene queries of cylinders and cones, by less than this share of it: a tenth of the promised
/// accuracy. A search on a polytope ends at its vertices; one on a curved surface goes on and on.
pub const GJK_CURVED_GAP: f64 = 1e-6;

/// A distance below this share of the pair's size has no reliable direction; the penetration
/// search, which works on planes, answers instead.
pub const TOUCHING: f64 = 1e-10;

/// A penetration depth is certified when upper and lower bound differ by less than this share
/// of the smaller shape's radius: a tenth of the promised accuracy.
pub const DEPTH_GAP: f64 = 1e-6;

/// How far (relative to the smaller radius) shapes are moved apart to find the witness points of their
/// depth. Wide enough for GJK to see a direction; so narrow that the normal's error, an angle that costs
/// no more depth than [`DEPTH_GAP`], shifts no point by a tenth of that.
pub const WITNESS_GAP: f64 = 1e-2;

/// Points (relative to the pair's size) closer than this to a line or plane do not span an
/// initial polytope: 1e5 roundings of f64, far below anything f32 input can resolve.
pub const DEGENERATE: f64 = 1e-11;

/// Visibility of a polytope face from a new point, relative to the pair's size: coplanar
/// faces count as visible, so that they are replaced together and no sliver is left.
pub const COPLANAR: f64 = 1e-14;

/// What was normalised in f32, a quaternion or a normal, has a squared length this near to 1; one step
/// of Newton's method then normalises it to f64 rounding.
pub const NEARLY_UNIT: f64 = 1e-6;

/// Edges whose directions span less than this sine squared do not define a contact normal.
pub const PARALLEL_EDGES: f64 = 1e-8;

/// A ray cast has arrived when it is this near, relative to the pair's size and the way
/// travelled (whose coordinates carry the rounding). The square root of f64's roundoff: a nearer
/// nearest point, a sum of coordinates, has no direction that could move the ray on.
pub const RAY_TOUCHING: f64 = 1e-8;

/// A motion whose share against a contact normal is below this is along the contact: normals and
/// velocities given in f32, and turned from frame to frame, are off by a few roundings.
pub const GRAZING: f64 = 1e-6;

/// Contacts keep their places while the normal turns by less than 1 degree (cosine) from one update to
/// the next: a greater turn means that other features have come into contact.
pub const KEPT_ANGLE_COS: f64 = 0.999_847_7;

/// Contacts keep their places while their two points are apart, across the normal, by less than this
/// share of the smaller shape's radius. Heaps of small bodies rest for anything from 1 % on; what
/// slides or rolls takes its contacts along in steps of this size.
pub const KEPT_DRIFT: f64 = 2e-2;

/// The deepest of the contacts that keep their places is told at the query's depth. By this share of
/// the smaller shape's radius, the promised accuracy, it may lie above the deepest place of all: corners tie up
/// to the tilt of a body at rest, and must not take turns. Beyond it, a corner without a contact has
/// become the deepest, and the contacts are chosen anew.
pub const KEPT_DEPTH: f64 = 2e-5;
