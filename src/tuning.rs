//! Constants that steer a choice between correct ways, each with what it was chosen for. No proof and no
//! promised accuracy depends on them. Those of accuracy are in `tolerance`.

/// Tangent of the angle by which a failing axis is tilted, towards where the next facet is to be
/// expected. Chosen for hulls of a hundred vertices, whose dihedral angles are about this large.
pub(crate) const TILT: f64 = 0.2;

/// A query with a reach beyond this share of the pair's size goes to GJK without a facet walk. Shapes
/// that far apart are mostly nearest at vertices and edges. Chosen for tumbling piles, where few pairs
/// are left to GJK.
pub(crate) const FACET_WALK_RANGE: f64 = 0.1;

/// A first tetrahedron that spans at least this share of the pair's size is taken as it is. Otherwise
/// support points are tried as well, and the best of all is taken.
pub(crate) const GOOD_SEED: f64 = 1e-3;

/// A cached polytope grows only if it holds the ball of this share of the depth. If not, it is hardly
/// that of the previous frame, and a start from the present features costs less.
pub(crate) const MIN_GROWABLE: f64 = 0.9;

/// Below this share of the radius a depth is mostly less than how far a witness is from the sides of its
/// face, and the cheap proof is tried first. Chosen for hulls of 8 to 1,000 vertices.
pub(crate) const SHALLOW: f64 = 0.1;

/// Above this sine of a corner, the product of its edges is as good a normal as that of any other corner.
pub(crate) const WIDE_SINE: f64 = 1e-2;

/// A face whose cosine to the contact normal is below this is seen edge-on. Its projection is too narrow
/// to be clipped.
pub(crate) const EDGE_ON: f64 = 0.05;

/// A face cluster whose slope over the contact plane is below this lies on it. Chosen for slabs with
/// noisy sides: a face seen edge-on under the outline is then a wall beside it, and is left out. The
/// outline passes such a wall only between corners of the rim at different heights, by a thirtieth of
/// that difference.
pub(crate) const LEVEL_SLOPE: f32 = 0.1;

/// Contacts closer together than this share of the smaller shape's radius become one: a solver gains
/// nothing from the second.
pub(crate) const SAME_POINT: f32 = 1e-3;

/// Points deeper along a corrected normal than this multiple of the query's depth are left out. Chosen
/// between two cases. What stands beside the open end of a floor, and overlaps it a little from the
/// side, is far beneath it along the corrected normal. A plate that has sunk in upright is up to six
/// times as deep as the nearest way out.
pub(crate) const ABSURD_DEPTH: f64 = 8.0;

/// Shapes that overlap by more than this share of the smaller shape's radius are pressed into each other:
/// they meet with the faces beside the ones in contact, too, where these alone have fewer than four
/// contacts. Chosen for heaps of stones of 2 and 5 cm. They rest as well with a third of it, but then more
/// pairs pay for a second choice.
pub(crate) const PRESSED: f64 = 0.03;

/// A face beside the one in contact belongs to it up to this slope over the contact plane, that of 30
/// degrees. Steeper ones look aside.
pub(crate) const STEEPEST_BESIDE: f32 = 0.577;

/// Capsules lie side by side if the angle between their axes, seen along the normal, has at most this sine
/// (ten degrees). Those that cross at a wider one touch at one place.
pub(crate) const SIDE_BY_SIDE_SINE: f64 = 0.17;

/// A common part of two capsules shorter than this share of the smaller radius has no two ends.
pub(crate) const SHORT_LINE: f64 = 0.05;
