//! The constants that bear on accuracy, each with its reason. Those that only steer a choice are in `tuning`.
//!
//! Shapes come with f32 coordinates (unit roundoff 6e-8). Distances, depths and their proofs are computed in f64
//! (1e-16), so that what is exact in the input stays decidable. Unless its comment names another factor, a
//! tolerance is multiplied by a length of the shapes at hand; none is an absolute length.

mod casts;

pub use casts::{GRAZED, NORMAL_ROUNDING, NORMAL_STRETCH, RAY_TOUCHING};

/// The cosine of 1 degree, and its sine.
const COS_1_DEGREE: f64 = 0.999_847_7;
const SIN_1_DEGREE: f64 = 0.017_452_4;

/// A face is a set of hull triangles that deviate from one plane by at most this share of the hull's radius. This
/// is ten f32 roundings: flat caps become one polygon, and the error of what a face certifies is at most this.
pub const FACE_FLATNESS: f64 = 6e-7;

/// Neighbouring triangles are merged into a face only if their normals are within 1 degree (cosine), so that
/// slivers of arbitrary direction cannot continue a face around a corner.
pub const FACE_ANGLE_COS: f64 = COS_1_DEGREE;

/// Faces around a larger one form a face cluster with it if their normals are within 1 degree (cosine):
/// contacts are sought on all of them together. Distances are measured to the faces themselves, so the angle
/// decides only how many corners are examined. f32 rounding and scanning noise stay below it, and the facets
/// of round hulls of a thousand vertices above.
pub const CLUSTER_ANGLE_COS: f64 = COS_1_DEGREE;

/// Faces and clusters grow only over edges that bend by less than 4 degrees (cosine). No other edge can be inside
/// one: the normal of a triangle is within 1 degree of its face's, and that is within 1 degree of its cluster's.
pub const NEARLY_FLAT_COS: f64 = 0.997_564;

/// A triangle lower than this share of the radius is a sliver: rounding can turn its plane by several degrees.
pub const MIN_TRIANGLE_HEIGHT: f64 = 4e-6;

/// Greatest depth of a concave edge, relative to the radius: sixteen f32 roundings. On a needle a climb
/// may lose more than the depth of its dents.
pub const MAX_DENT: f64 = 1e-6;

/// How far (relative to the radius) a hull may reach beyond the plane of a face, since many dents in a row
/// make a bowl. The noise of scanned plates stays below it.
pub const BOWL: f64 = 5e-5;

/// What a climb may lose (relative to the radius) on a surface with such a bowl. Its sides slope by twice its
/// depth over half its width. In a direction tilted by twice that slope, the rim opposite the top is just a
/// summit, lower than the top by the tilt times the whole width.
pub const BOWL_LOSS: f64 = 8.0 * BOWL;

/// If a surface bends at an edge by less than this share of the radius, its two triangles could as well have
/// the other diagonal. This is twice the depth of a dent.
pub const FLAT_EDGE: f64 = 2e-6;

/// An edge is steep if each of its triangles is this share of the radius above the other one's far corner. It
/// is far above what rounding a normal to f32 can lift a neighbour: if all edges at a vertex are steep, the
/// vertex is the highest of its neighbours over each of its triangles.
pub const STEEP_EDGE: f64 = 1e-5;

/// The corners of a flat side are this near to one plane, in radii: then each of its diagonals is a [`FLAT_EDGE`].
pub const FLAT_SIDE: f64 = FLAT_EDGE / 8.0;

/// Where two flat sides meet, any two of their triangles bend by more than this share of the radius. Then the
/// edge between them is no [`FLAT_EDGE`].
pub const BENT_EDGE: f64 = 2.0 * FLAT_EDGE;

/// A triangle lower than this share of the radius may face inwards because its corners are rounded. A higher
/// triangle that faces inwards is a fold of the surface. This is ten f32 roundings.
pub const MAX_INWARD_HEIGHT: f64 = 6e-7;

/// A hull whose smallest extent is below this share of its radius has no usable interior.
pub const MIN_EXTENT: f64 = 1e-6;

/// The f64 error of the determinant that decides on which side of a plane a point lies, as a share of the sum
/// of its products: nine roundings where at most seven occur. Nearer to zero, the exact sum decides.
pub const ORIENTATION_ROUNDING: f64 = 1e-15;

/// Two support values closer than this share of `radius * |direction|` tie for hill climbing:
/// vertices that are coplanar up to f32 rounding must be seen as one plateau.
pub const SUPPORT_TIE: f64 = 4e-7;

/// An edge shorter than this share of the radius may rise or fall by the rounding of its ends alone, as
/// steeply as any edge that is climbed.
pub const SHORT_EDGE: f64 = 1e-2;

/// The way up from a false summit may begin with a step down by this share of `radius * |direction|`:
/// a vertex is beneath its neighbours by no more than a few dents.
pub const DIP: f64 = 4.0 * MAX_DENT;

/// GJK stops when its bounds on the distance differ by less than this share of the distance...
pub const GJK_GAP_OF_DISTANCE: f64 = 1e-9;

/// ...or by less than this share of the pair's size: the rounding of f64 sums of coordinates.
pub const GJK_GAP_OF_SIZE: f64 = 1e-12;

/// ...or, in scene queries of cylinders and cones, by less than this share of the size: a tenth of the promised
/// accuracy. A search on a polytope ends at its vertices, but one on a curved surface does not end by itself.
pub const GJK_CURVED_GAP: f64 = 1e-6;

/// A distance below this share of the pair's size has no reliable direction. The penetration search, which
/// works on planes, answers instead. Shapes this near touch: rounding in f64 is far less, a step of f32 far more.
pub const MIN_DIRECTED_DISTANCE: f64 = 1e-10;

/// Proved bounds are widened by this share of the pair's size and offset: the rounding of a few f64 sums and products.
pub const BOUNDS_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The deepest contact of a manifold looks wrong where it is beyond proved bounds of its depth by more than
/// this share of the larger shape's diameter: the promised accuracy.
pub const SUSPECT: f64 = 1e-5;

/// A penetration depth is certified if its upper and lower bound differ by less than this share of the
/// smaller shape's radius: a tenth of the promised accuracy.
pub const DEPTH_GAP: f64 = 1e-6;

/// The f32 error of how far a point is inside a face, as a share of how far it and the corners are from each
/// other and from the origin: a dozen roundings.
pub const INSET_ROUNDING: f64 = 1e-6;

/// With the rounding of a point this many radii away, a point that is beneath the planes of both faces at a knife's
/// edge is in the hull: each of the two may be above the hull by [`FACE_FLATNESS`].
pub const KNIFE_EDGE: f64 = 2.0 * FACE_FLATNESS / INSET_ROUNDING;

/// How far (relative to the smaller radius) shapes are moved apart to find the witness points of their
/// depth. Wide enough for GJK to see a direction; so narrow that the normal's error, an angle that costs
/// no more depth than [`DEPTH_GAP`], shifts no point by a tenth of that.
pub const WITNESS_GAP: f64 = 1e-2;

/// Points (relative to the pair's size) closer than this to a line or plane do not span an
/// initial polytope: 1e5 roundings of f64, far below anything f32 input can resolve.
pub const DEGENERATE: f64 = 1e-11;

/// A new point sees a polytope face unless it is lower than this below its plane, relative to the pair's
/// size. So coplanar faces count as visible, are replaced together, and leave no sliver.
pub const COPLANAR: f64 = 1e-14;

/// A quaternion or normal that was normalised in f32 has a squared length this near to 1. One Newton step
/// then normalises it up to 3/8 of the squared excess: 4e-13 at this limit, and 1e-14 for usual input.
pub const NEARLY_UNIT: f64 = 1e-6;

/// Edges whose directions span less than this sine squared do not define a contact normal.
pub const PARALLEL_EDGES: f64 = 1e-8;

/// A motion counts as tangential if its share against the contact normal is below this: normals and
/// velocities that are given in f32 and turned from frame to frame are off by a few roundings.
pub const GRAZING: f64 = 1e-6;

/// Contacts keep their places while the normal turns by less than 1 degree (cosine) from one update to the
/// next. A larger turn means that other features came into contact.
pub const KEPT_ANGLE_COS: f64 = COS_1_DEGREE;

/// Contacts keep their places while the distance of their two points across the normal is less than this
/// share of the smaller shape's radius. Heaps of small bodies rest for any value from 1 % on. The contacts of
/// sliding or rolling bodies move in steps of this size.
pub const KEPT_DRIFT: f64 = 2e-2;

/// The deepest of the kept contacts is reported at the query's depth. It may lie above the deepest place by
/// this share of the smaller shape's radius, which is the promised accuracy: corners tie up to the tilt of a
/// body at rest, and must not take turns. Beyond this, a corner without a contact has become the deepest, and
/// the contacts are chosen anew.
pub const KEPT_DEPTH: f64 = 2e-5;

/// Contacts stay as they are, with their normal, while the deepest shows the query's depth up to this share of the
/// smaller shape's radius. It is reported as it is measured, so this is an error of the answer.
pub const STILL_DEPTH: f64 = 8e-6;
/// And while the shapes turn by less than this angle against the stored normals.
pub const STILL_TILT: f64 = 5e-6;

/// A feature of a `HullShape` answers for directions within 1 degree of its normals, as in parry.
pub(crate) const FEATURE_ANGLE_COS: f64 = COS_1_DEGREE;
/// The same limit as a sine, for the slope of an edge.
pub(crate) const FEATURE_ANGLE_SIN: f64 = SIN_1_DEGREE;

/// If the sine of a triangle's widest corner is below this, its normal has lost half of its digits. The
/// nearest point is then chosen among all faces by distance, not by the signs of areas. At half of the
/// digits, trusting the normal and ignoring the interior lose equally much.
pub(crate) const MIN_TRIANGLE_SINE: f64 = 1e-8;

/// If the ratio of a tetrahedron's volume to the product of three edges at a corner is below this, the volumes that
/// decide on which side of its faces the origin lies have lost half of their digits. Then all faces are tried.
pub(crate) const MIN_VOLUME_RATIO: f64 = 1e-8;

/// The weights of a tetrahedron must reproduce the origin up to this share of a vertex's distance from
/// it. Otherwise the faces are tried. It is above the rounding of all but nearly flat tetrahedra.
pub(crate) const INTERIOR_RESIDUAL: f64 = 1e-12;

/// Johnson's answer may miss the true distance by this share of the farthest vertex's distance. Beyond it,
/// the backup procedure answers. The determinants of a nearly flat simplex are mere rounding, and satisfy the
/// halt condition by chance; the rounding of a good answer is far below this.
pub(crate) const JOHNSON_ERROR: f64 = 1e-10;

/// A cached polytope proves depths up to this share of the search's tolerance. The rest is far more than rounding,
/// so a search would find the depth that a polytope proves: answers do not depend on what is cached.
pub(crate) const PROOF_MARGIN: f64 = 0.999;

/// Support points of a user's own shape may be off by this share of their distance from the origin: their code rounds
/// to f32, and so is the direction that it gets.
pub(crate) const SUPPORT_ROUNDING: f64 = 8.0 / (1 << 24) as f64;

/// Two heights computed in f32 are in the right order if they differ by more than this, for points in the
/// unit ball and a direction whose largest coordinate is 1. Coordinates, direction, products and two sums are
/// rounded, each by at most a unit of the sum of the products, which is below √3. So both heights together
/// are off by 10 √3 units, and their difference by one more.
pub(crate) const SCAN_ROUNDING: f32 = 20.0 / (1 << 24) as f32;

/// A corner of the contact patch counts as deep as the witness if their depths differ by less than this share
/// of the smaller shape's radius: the rounding of f32 face planes.
pub(crate) const SAME_DEPTH: f64 = 2e-6;

/// A point counts as inside an edge of a clip polygon if it is outside by less than this share of the edge's
/// extent, and of its distance from the origin of the contact plane: four roundings of the coordinates. So
/// corners that meet up to rounding are never lost.
pub(crate) const CLIP_SLACK: f32 = 4.0 * f32::EPSILON;

/// If a point is inside or outside a polygon's side by this many slacks, it is so for the adjacent sides as
/// well, whichever of them rounding chose.
pub(crate) const CLEARLY_BESIDE: f32 = 4.0;

/// A box without thickness gets this share of its largest half-extent as its thickness, so that its side
/// faces have normals. This is a hundredth of the promised accuracy.
pub(crate) const MIN_BOX_THICKNESS: f64 = 1e-7;

/// A correction of a unit normal by less than this in each coordinate is mere rounding.
pub(crate) const UNCORRECTED: f32 = 1e-6;

/// A part of a compound covers a face of another one at a place if it is found this far beyond the face, as a
/// share of the part's radius. So gaps of a thousandth of the radius, as decompositions leave them, are closed.
pub(crate) const SEAM_STEP: f64 = 2e-3;

/// Places are tested nearer to the middle of their face, by this share of the part's radius: the upper edge of a
/// cut is on the surface of both parts. As far as the step, the place tested is seen at 45 degrees from that edge:
/// so it is in the other part if a cut leans by less, and not in one beside a concave crease of less than 90 degrees.
pub(crate) const SEAM_INSET: f64 = SEAM_STEP;

/// The promised accuracy: distances and depths of solids are right up to this share of the larger radius,
/// which is 1e-5 of the diameter of the larger bounding sphere.
pub(crate) const PROMISED_ERROR: f64 = 2e-5;

/// The sum of the errors of all stages of one answer, as shares of the larger radius. The table in
/// `docs/theory.md` explains each. GJK's gap is left out: it is 1e-9 of the distance.
pub(crate) const WORST_ERROR: f64 = POSE_ERROR
    + CLIMB_ERROR
    + FACE_ERROR
    + PROJECTION_ERROR
    + DEPTH_ERROR
    + SAME_DEPTH
    + STILL_DEPTH
    + OUTPUT_ERROR;

/// A normalised quaternion is off by 3/8 of the squared excess, and a rotation by twice that.
const POSE_ERROR: f64 = NEARLY_UNIT * NEARLY_UNIT;
/// What a climb may lose on each shape: four plateaus on dented hulls, two dents on long needles.
const CLIMB_ERROR: f64 = 2.0
    * if 2.0 * SUPPORT_TIE > MAX_DENT {
        4.0 * SUPPORT_TIE
    } else {
        2.0 * MAX_DENT
    };
/// The corners of a face may lie beneath its plane, on each shape.
const FACE_ERROR: f64 = 2.0 * FACE_FLATNESS;
/// The origin may project beside the facet.
const PROJECTION_ERROR: f64 = DEPTH_GAP;
/// A depth is certified within one gap, and the facet at hand is preferred within another.
pub(crate) const DEPTH_ERROR: f64 = 2.0 * DEPTH_GAP;
/// Depths are at most two radii and rounded to f32 by half a unit.
const OUTPUT_ERROR: f64 = f32::EPSILON as f64;

const _: () = assert!(WORST_ERROR <= PROMISED_ERROR, "more than the promise");

/// Cores of capsules nearer than this share of the pair's size meet: the direction between them is mere rounding.
pub const CAPSULE_TOUCH: f64 = 1e-12;

/// Gaps that differ by less than this share of a radius count as equal: half of the promised accuracy.
pub const SAME_GAP: f64 = 1e-5;

/// A point outside of an outline by less than this share of its size counts as on it: f64 sums of coordinates
/// are off by a few units of 1e-16.
pub const ON_OUTLINE: f64 = 1e-12;

/// A disc counts as tilted over a flat side if its slope is above this. Below it, the deepest corner of a
/// square is as deep as the rim up to the promised accuracy, and noise must not turn the square.
pub const LEVEL: f64 = 5e-5;

/// A normal counts as that of a piece of surface if they differ by less than this. A bound loses only its square.
pub const SAME_NORMAL: f64 = 1e-7;

/// Axes count as parallel if the squared sine of their angle is below this: f64 leaves half of its digits.
pub const PARALLEL_AXES: f64 = 1e-15;

/// A search along the normals of an edge or a side ends at steps below this angle. It loses only its square.
pub const SETTLED_ANGLE: f64 = 1e-9;

/// Bounds of the distance of curved shapes differ by no more than this share of the smaller radius. The
/// normal is off by the root of it, relative to the distance, and contacts beside each other by that.
pub const FINE_GAP: f64 = 1e-9;

/// A cast of turning shapes ends when these are apart by less than this share of the smaller radius: the
/// promised accuracy of a distance. What their climbs may lose is less.
pub(crate) const IMPACT_GAP: f64 = 1e-5;

/// Parry counts an impact this soon after the start of such a cast, in units of time, as one at the start.
pub(crate) const AT_START: f64 = 1e-5;
