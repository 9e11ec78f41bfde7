//! The constants that bear on accuracy, each with its reason. Those that only steer a choice are in
//! `tuning`.
//!
//! Shapes come with f32 coordinates (unit roundoff 6e-8). Distances, depths and their proofs are
//! computed in f64 (1e-16), so that what is exact in the input stays decidable. Unless its comment
//! names another factor, a tolerance is multiplied by a length of the shapes at hand; none is an
//! absolute length.

/// The cosine of 1 degree, and its sine.
const COS_1_DEGREE: f64 = 0.999_847_7;
const SIN_1_DEGREE: f64 = 0.017_452_4;

/// A face is a set of hull triangles that deviate from one plane by at most this share of the
/// hull's radius. Ten f32 roundings: flat caps become one polygon, and what a face certifies is
/// wrong by no more than this.
pub const FACE_FLATNESS: f64 = 6e-7;

/// Neighbouring triangles are only joined to a face when their normals are within 1 degree
/// (cosine), so that slivers of arbitrary direction cannot chain a face around a corner.
pub const FACE_ANGLE_COS: f64 = COS_1_DEGREE;

/// Faces within 1 degree (cosine) of a larger one around which they lie form a face cluster with it:
/// contacts are sought on all of them together. Distances are measured to the faces themselves, so
/// that the angle decides only how many corners are looked at; f32 rounding and scanning noise
/// stay below it, and the facets of round hulls of a thousand vertices above.
pub const CLUSTER_ANGLE_COS: f64 = COS_1_DEGREE;

/// Faces and clusters are sought only over edges that bend by less than 4 degrees (cosine). No others
/// can be inside of one: the normal of a triangle is within 1 degree of its face's, and that within
/// 1 degree of its cluster's.
pub const NEARLY_FLAT_COS: f64 = 0.997_564;

/// A triangle lower than this share of the radius is a sliver: rounding of its corners can turn
/// its plane by several degrees.
pub const MIN_TRIANGLE_HEIGHT: f64 = 4e-6;

/// Greatest depth of a concave edge, relative to the radius: sixteen f32 roundings. On a needle a climb
/// may lose more than the depth of its dents.
pub const MAX_DENT: f64 = 1e-6;

/// How far (relative to the radius) a hull may reach beyond the plane of a face: many dents in a row
/// make a bowl. The noise of scanned plates stays below it.
pub const BOWL: f64 = 5e-5;

/// What a climb may lose (relative to the radius) on a surface with such a bowl. Along a direction tilted
/// by twice the slope of its sides, which is twice its depth over half its width, the rim opposite the top
/// is just a summit, lower by that tilt over the whole width.
pub const BOWL_LOSS: f64 = 8.0 * BOWL;

/// Where a surface bends at an edge by less than this share of the radius, its two triangles may as well
/// have the other diagonal: twice what a dent may be deep.
pub const FLAT_EDGE: f64 = 2e-6;

/// The corners of a flat side are within this share of the radius of one plane: then each of its
/// diagonals is a [`FLAT_EDGE`].
pub const FLAT_SIDE: f64 = FLAT_EDGE / 8.0;

/// Where two flat sides meet, any two triangles of them bend by more than this share of the radius: then
/// the edge between them is no [`FLAT_EDGE`].
pub const BENT_EDGE: f64 = 2.0 * FLAT_EDGE;

/// A triangle lower than this share of the radius may face inwards by the rounding of its corners;
/// a higher one that does is a fold of the surface. Ten f32 roundings.
pub const MAX_INWARD_HEIGHT: f64 = 6e-7;

/// A hull whose smallest extent is below this share of its radius has no usable interior.
pub const MIN_EXTENT: f64 = 1e-6;

/// The determinant that tells on which side of a plane a point lies is off, in f64, by less than this share
/// of the sum of its products: nine roundings of at most seven. Nearer to zero, the exact sum decides.
pub const ORIENTATION_ROUNDING: f64 = 1e-15;

/// Two support values closer than this share of `radius * |direction|` tie for hill climbing:
/// vertices that are coplanar up to f32 rounding must be seen as one plateau.
pub const SUPPORT_TIE: f64 = 4e-7;

/// An edge shorter than this share of the radius may rise or fall by its ends' rounding alone, as
/// steeply as anything that is climbed.
pub const SHORT_EDGE: f64 = 1e-2;

/// The way up from a false summit may begin with a step down by this share of `radius * |direction|`:
/// a vertex is beneath its neighbours by no more than a few dents.
pub const DIP: f64 = 4.0 * MAX_DENT;

/// GJK stops when its bounds of the distance differ by less than this share of the distance...
pub const GJK_GAP_OF_DISTANCE: f64 = 1e-9;

/// ...or by less than this share of the pair's size: the rounding of f64 sums of coordinates.
pub const GJK_GAP_OF_SIZE: f64 = 1e-12;

/// ...or, in scene queries of cylinders and cones, by less than this share of it: a tenth of the promised
/// accuracy. A search on a polytope ends at its vertices; one on a curved surface goes on and on.
pub const GJK_CURVED_GAP: f64 = 1e-6;

/// A distance below this share of the pair's size has no reliable direction; the penetration
/// search, which works on planes, answers instead. Shapes this near touch, for every query: rounding in
/// f64 is far less, and one step of f32 far more.
pub const MIN_DIRECTED_DISTANCE: f64 = 1e-10;

/// Proved bounds are widened by this share of the pair's size and offset: the rounding of a few f64 sums and
/// products of coordinates.
pub const BOUNDS_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A penetration depth is certified when upper and lower bound differ by less than this share
/// of the smaller shape's radius: a tenth of the promised accuracy.
pub const DEPTH_GAP: f64 = 1e-6;

/// How much f32 may be off about how far a point is inside of a face, as a share of how far it and the
/// corners are from each other and from the origin: a dozen roundings.
pub const INSET_ROUNDING: f64 = 1e-6;

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

/// What was normalised in f32, a quaternion or a normal, has a squared length this near to 1. One step
/// of Newton's method then normalises it up to 3/8 of the square of the excess: 4e-13 at this limit, and
/// 1e-14 for usual input.
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
pub const KEPT_ANGLE_COS: f64 = COS_1_DEGREE;

/// Contacts keep their places while their two points are apart, across the normal, by less than this
/// share of the smaller shape's radius. Heaps of small bodies rest for anything from 1 % on; what
/// slides or rolls takes its contacts along in steps of this size.
pub const KEPT_DRIFT: f64 = 2e-2;

/// The deepest of the contacts that keep their places is reported at the query's depth. By this share of
/// the smaller shape's radius, the promised accuracy, it may lie above the deepest place of all: corners tie up
/// to the tilt of a body at rest, and must not take turns. Beyond it, a corner without a contact has
/// become the deepest, and the contacts are chosen anew.
pub const KEPT_DEPTH: f64 = 2e-5;

/// A feature of a `HullShape` answers for directions within 1 degree of its normals, as in parry.
pub(crate) const FEATURE_ANGLE_COS: f64 = COS_1_DEGREE;
/// The same limit as a sine, for the slope of an edge.
pub(crate) const FEATURE_ANGLE_SIN: f64 = SIN_1_DEGREE;

/// Where the sine of a triangle's widest corner is below this, its normal has lost half of its digits.
/// The nearest point is then chosen among all faces by distance, not by the signs of areas. Half of the
/// digits balances the loss of trusting the normal against that of ignoring the interior.
pub(crate) const MIN_TRIANGLE_SINE: f64 = 1e-8;

/// Where the ratio of a tetrahedron's volume to the product of three edges at a corner is below this, the
/// outer sides of its faces have lost half of their digits. All faces are then tried.
pub(crate) const MIN_VOLUME_RATIO: f64 = 1e-8;

/// The weights of a tetrahedron must reproduce the origin up to this share of a vertex's distance from
/// it. Otherwise the faces are tried. It is above the rounding of all but nearly flat tetrahedra.
pub(crate) const INTERIOR_RESIDUAL: f64 = 1e-12;

/// Johnson's answer may miss the true distance by this share of the farthest vertex's distance. Beyond
/// it, the backup procedure answers. The determinants of a nearly flat simplex are mere rounding and
/// satisfy the halt condition by chance; a good answer's rounding is far below this.
pub(crate) const JOHNSON_ERROR: f64 = 1e-10;

/// A cached polytope proves a depth with this share of the tolerance of a search. The rest is far beyond
/// rounding, so a search would find what a polytope proves, whatever is stored or lost.
pub(crate) const PROOF_MARGIN: f64 = 0.999;

/// Two heights computed in f32 may be in the wrong order by this much, for points in the unit ball and a
/// direction whose largest coordinate is 1. Coordinates, direction, products and two sums are rounded,
/// each by at most a unit of the sum of the products, which is below √3. So both heights together are
/// off by 10 √3 units, and their difference by one more.
pub(crate) const SCAN_ROUNDING: f32 = 20.0 / (1 << 24) as f32;

/// A corner of the contact patch is as deep as the witness up to this share of the smaller shape's
/// radius: the rounding of f32 face planes.
pub(crate) const SAME_DEPTH: f64 = 2e-6;

/// What lies outside an edge of a clip polygon by less than this share of the edge's extent, and of its
/// distance from the origin of the contact plane, counts as inside: four roundings of the coordinates.
/// So corners that meet up to rounding are never lost.
pub(crate) const CLIP_SLACK: f32 = 4.0 * f32::EPSILON;

/// A point that is inside or outside of a polygon's side by this many slacks is so for the sides beside it
/// as well, whichever of them rounding chose.
pub(crate) const CLEARLY_BESIDE: f32 = 4.0;

/// A box without thickness gets this share of its largest half-extent as one, a hundredth of the promised
/// accuracy. Its side faces then have normals.
pub(crate) const MIN_BOX_THICKNESS: f64 = 1e-7;

/// A correction of a unit normal by less than this in each coordinate is only rounding.
pub(crate) const UNCORRECTED: f32 = 1e-6;

/// The promise: distances and depths of solids are right up to this share of the larger radius, which is
/// 1e-5 of the diameter of the larger bounding sphere.
pub(crate) const PROMISED_ERROR: f64 = 2e-5;

/// What the stages of one answer may add up to, as shares of the larger radius. The table in
/// `docs/theory.md` says where each comes from. GJK's gap is left out: it is 1e-9 of the distance.
pub(crate) const WORST_ERROR: f64 = POSE_ERROR
    + CLIMB_ERROR
    + FACE_ERROR
    + PROJECTION_ERROR
    + DEPTH_ERROR
    + SAME_DEPTH
    + OUTPUT_ERROR;

/// A normalised quaternion is off by 3/8 of the excess squared, and a rotation by twice that.
const POSE_ERROR: f64 = NEARLY_UNIT * NEARLY_UNIT;
/// What a climb may lose, on each shape: four plateaus on dented hulls, two dents on long needles.
const CLIMB_ERROR: f64 = 2.0
    * if 2.0 * SUPPORT_TIE > MAX_DENT {
        4.0 * SUPPORT_TIE
    } else {
        2.0 * MAX_DENT
    };
/// The corners of a face lie beneath its plane; a face of each shape.
const FACE_ERROR: f64 = 2.0 * FACE_FLATNESS;
/// The origin may project beside the facet.
const PROJECTION_ERROR: f64 = DEPTH_GAP;
/// A depth is certified within one gap, and the facet at hand is preferred within another.
const DEPTH_ERROR: f64 = 2.0 * DEPTH_GAP;
/// Depths, which are at most two radii, are rounded to f32 by half a unit.
const OUTPUT_ERROR: f64 = f32::EPSILON as f64;

const _: () = assert!(
    WORST_ERROR <= PROMISED_ERROR,
    "the errors add up to more than the promise"
);

/// No pair is scaled up beyond this radius for parry's searches: the squares of longer coordinates are more
/// than f32 holds.
pub const LARGEST_SCALED: f64 = 1e15;

/// Cores of capsules nearer than this share of the pair's size meet: the direction between their nearest
/// points is rounding only.
pub const CAPSULE_TOUCH: f64 = 1e-12;

/// Gaps that differ by less than this share of the radii are the same: the promised accuracy of a contact.
pub const SAME_GAP: f64 = 1e-5;
