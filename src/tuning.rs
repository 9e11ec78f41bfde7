//! Constants that steer a choice between correct alternatives, each with what it was tuned for. No proof and
//! no promised accuracy depends on them. The constants that bear on accuracy are in `tolerance`.

use crate::tolerance::{BOWL_LOSS, KEPT_DRIFT};

/// The tangent of the angle by which a failing axis is tilted, towards the expected next facet. Chosen for
/// hulls of a hundred vertices, whose dihedral angles are about this large.
pub(crate) const TILT: f64 = 0.2;

/// A separating axis is kept in the frame of the second shape if that is so many times as large as the first. There it
/// takes a rotation in each update, which is lost if both tumble alike.
pub(crate) const MUCH_LARGER: f64 = 2.0;

/// If its maximum distance exceeds this share of the pair's size, a query goes to GJK without a facet walk.
/// Shapes that far apart are mostly nearest at vertices and edges. Chosen for tumbling piles, where few pairs
/// are left to GJK.
pub(crate) const FACET_WALK_RANGE: f64 = 0.1;

/// A first tetrahedron that spans at least this share of the pair's size is taken as it is. Otherwise
/// support points are tried as well, and the best of all is taken.
pub(crate) const GOOD_SEED: f64 = 1e-3;

/// A cached polytope grows only if it contains the ball of this share of the depth. Otherwise it is hardly
/// from the previous frame, and starting from the present features costs less.
pub(crate) const MIN_GROWABLE: f64 = 0.9;

/// A proof for the directions that a facet does not cover spares a cap of directions. The cap's half-angle
/// has this share of the tangent of the facet's own. So the proof holds while the facet becomes smaller or
/// turns.
pub(crate) const CAP_SHARE: f64 = 0.7;

/// The least tangent of a facet that covers many directions. Facets of hulls of a hundred vertices cover
/// fewer. If such hulls turn by half a degree in each frame, a proof for the other directions hardly lasts
/// for one.
pub(crate) const WIDE_CAP: f64 = 0.25;

/// If the two points of each contact are within this share of the smaller shape's radius of each other, across
/// the normal, the shapes hardly moved, and the faces under the contacts are worth a test. A tenth of
/// [`KEPT_DRIFT`](crate::tolerance::KEPT_DRIFT).
pub(crate) const STILL: f64 = 2e-3;

/// Of a face with more sides than this, the one in some direction is found by halving.
pub(crate) const MANY_SIDES: usize = 8;

/// Where the planes of two faces have a smaller squared sine between them (six degrees), f32 hardly tells the place of the
/// edge: points count as less far inside of it, and corners are looked at instead.
pub(crate) const CLEAR_BEND: f32 = 1e-2;

/// Contacts tie for the deepest if their distances differ by less than this share of the tolerance of a depth.
/// Three that tie, and a far one, leave the place between them within the tolerance.
pub(crate) const FLUSH_TIE: f64 = 0.25;

/// Below this share of the radius, a depth is mostly less than the distance of the witness from the sides of
/// its face, and the cheap proof is tried first. Chosen for hulls of 8 to 1,000 vertices.
pub(crate) const SHALLOW: f64 = 0.1;

/// If the sine of a corner is above this, the cross product of its edges is as good a normal as that of any
/// other corner.
pub(crate) const WIDE_SINE: f64 = 1e-2;

/// A face whose cosine to the contact normal is below this is seen edge-on. Its projection is too narrow
/// to be clipped.
pub(crate) const EDGE_ON: f64 = 0.05;

/// Two faces are tried as sides of a box that meet if their cosine is below this.
pub(crate) const SQUARE: f32 = 1e-3;

/// A face cluster whose slope over the contact plane is below this lies on it. Chosen for slabs with
/// noisy sides: a face seen edge-on under the outline is then a wall beside it, and is left out. The
/// outline passes such a wall only between corners of the rim at different heights, by a thirtieth of
/// that difference.
pub(crate) const LEVEL_SLOPE: f32 = 0.1;

/// Contacts closer together than this share of the smaller shape's radius become one: a solver gains nothing
/// from the second one.
pub(crate) const SAME_POINT: f32 = 1e-3;

/// Points deeper along a corrected normal than this multiple of the query's depth are left out. Chosen
/// between two cases. A body that stands beside the open end of a floor, and overlaps it a little from the
/// side, is far beneath it along the corrected normal. A plate that has sunk in upright is up to six times as
/// deep as the nearest way out.
pub(crate) const ABSURD_DEPTH: f64 = 8.0;

/// Shapes that overlap by more than this share of the smaller shape's radius are pressed into each other: if
/// the faces in contact alone have fewer than four contacts, the faces beside them are clipped as well.
/// Chosen for heaps of stones of 2 and 5 cm. They rest as well with a third of it, but then more pairs pay
/// for a second choice.
pub(crate) const PRESSED: f64 = 0.03;

/// A face beside the one in contact is included up to this slope over the contact plane, 30 degrees. Steeper
/// faces look sideways.
pub(crate) const STEEPEST_BESIDE: f32 = 0.577;

/// Where capsules or ruled sides cross, they have contacts on either side of the nearest place, where they are beside each
/// other by at most this share of the sum of their radii, and so apart by half a hundredth of it. With 0.02 or 0.3 in place
/// of it, heaps of capsules, cylinders and cones rest an eighth later; with contacts only at the ends of bodies that cross
/// by less than ten degrees, a quarter.
pub(crate) const CROSSING_REACH: f64 = 0.1;

/// If the common part of two capsules is shorter than this share of the smaller radius, it has only one
/// contact.
pub(crate) const SHORT_LINE: f64 = 0.05;

/// If two discs are shifted by less than twice this share of the radius, a square in both serves as well as
/// the ends of their lens, which turn with the shift.
pub(crate) const SMALL_SHIFT: f64 = 0.01;

/// The gap between the bounds of a coarse search, as a share of the smaller radius. It is small enough to
/// tell which pieces of surface are in contact; these then give the answer. A tenth of it, or ten times it,
/// serves as well.
pub(crate) const COARSE_GAP: f64 = 0.002;

/// GJK's gap in a cast of turning curved shapes: a fraction of the gap at which the cast ends.
pub(crate) const CURVED_IMPACT_GAP: f64 = crate::tolerance::IMPACT_GAP / 4.0;

/// GJK's gap in a cast of turning shapes that are far apart, relative to the separation that was proved last: a
/// normal that is off by so little proves nearly as much.
pub(crate) const ROUGH_GAP: f64 = 0.01;

/// If the proof along a normal leaves less than this share of the gap, such a cast continues with a new normal.
pub(crate) const USED_UP: f64 = 0.05;

/// From one frame to the next a normal usually turns by less than this angle. Pieces of surface that it
/// misses by more are tried later.
pub(crate) const SMALL_TURN: f64 = 0.03;

/// By more than this angle it hardly turns: 20 radians per second in steps of a sixtieth of a second. Pieces of surface
/// within it are tried before a search, which costs ten times as much.
pub(crate) const LARGE_TURN: f64 = 0.3;

/// The longest step of Newton's method, as an angle: the slope says little about normals farther away.
pub(crate) const LONGEST_STEP: f64 = 0.5;

/// Each step of Newton's method doubles the number of correct digits.
pub(crate) const MAX_NEWTON_STEPS: usize = 5;

/// The most steps to the face of a user's own shape under some place: two suffice within four corners that parry's hulls
/// have merged. On a round side there is no end to them.
pub(crate) const MAX_PORTALS: usize = 6;

/// The most steps to the nearest place of a segment: three or four usually suffice, twice as many where one crosses a rim
/// at a small angle.
pub(crate) const MAX_SEGMENT_STEPS: usize = 12;

/// A face seems flat if its fourth corner is no higher over the first three than this share of its length.
/// Then flat sides are tried first.
pub(crate) const SEEMS_FLAT: f64 = 1e-5;

/// Contacts also keep their places while the normal turns by less than 6 degrees (cosine), if no distance changes much.
/// A needle rocks on two edges a millimetre apart, and turns by two degrees in each step. With new contacts in each
/// step, it would rock for ever.
pub(crate) const ROCKING_COS: f64 = 0.994_522;
/// How much they may change, as a share of the smaller shape's radius. They change by more on a sphere of 642 vertices
/// that rolls from facet to facet. If its contacts stayed behind, it would not roll straight on.
pub(crate) const ROCKING_RISE: f64 = 1e-3;

/// Contacts on a round surface keep their places while the normal turns about its axis by less than this angle from
/// one update to the next, in radians. Bodies that tremble turn by less. Contacts that turn with a rolling body lag
/// behind its lowest place, and push it on until it rolls by this angle in each step.
pub(crate) const ROLLING: f64 = 3e-4;

/// A disc that rolls on its rim by at least this angle from one update to the next, in radians, has a contact ahead. A coin
/// that wobbles on a table rolls by a tenth in each step, whatever its size; one that leans in a corner and swings rolls
/// by a thousandth in each step when it is slow enough to fall asleep. With a hundredth in place of it, it does not.
pub(crate) const LEAST_LEAD: f64 = 0.001;
/// But none farther ahead than this: so wide a turn says little about the next one.
pub(crate) const MOST_LEAD: f64 = 0.5;

/// The side of a prism is round if its faces bend by at most 10 degrees (cosine): so many sides. A solver lets bodies sink
/// in by a fraction of a millimetre, which is more than such a face is lower than its edges where the prism is some
/// centimetres thick. Prisms of 32 sides and 3 cm come to rest by themselves.
pub(crate) const ROUND_SIDES: usize = 36;
pub(crate) const ROUND_COS: f64 = 0.984_807;
/// The tangents of angles at which the next face of such a side is looked for: up to 10.5 degrees, and not so far that it
/// is passed over.
pub(crate) const AHEAD: [f64; 3] = [0.046, 0.093, 0.185];

/// Manifolds whose normals have at least this cosine lie in one plane: the angle, five degrees, up to which
/// rapier merges them.
pub(crate) const ONE_PLANE_COS: f32 = 0.996;

/// A corner this many times as high above the deepest one as it is far from the other contacts is the last to be
/// chosen: the body would have to turn by eleven degrees before it touches there. With 0, bodies that lean on an edge
/// trade its second corner for a far one whenever the deepest corner changes, and heaps of rounded prisms of six sides
/// rest after 227 frames in place of 110. With 15, rounded prisms of twelve sides rest late.
pub(crate) const CORNER_RISE: f32 = 5.0;

/// A contact this many times as high above the deepest one as it is far from the others is no better than
/// none: the body would have to turn by four degrees before it touches there. Heaps of bodies of two
/// hulls rest with 5 as well as with 15, and never with 0.
pub(crate) const RISE: f32 = 15.0;

/// If no contact is higher above the deepest than this share of the extent of all, any four of them will do, and
/// all are kept. With a third of it, heaps of bodies of two hulls rest as well; with three times of it, one in six
/// keeps rattling.
pub(crate) const ALL_LEVEL: f32 = 0.02;

/// Three contacts bear a body if the third is beside the line through the others by at least this share of the
/// extent of all: it is so for beams up to ten times as long as wide.
pub(crate) const BEARING_WIDTH: f32 = 0.1;

/// Contacts of a part are equally deep if their distances differ by less than this share of the extent of the
/// contacts: less than the promised accuracy of a depth.
pub(crate) const ONE_DEPTH: f32 = 3e-6;

/// Contacts that stay as they are belong to the present shapes if none is farther from a shape than this share of the
/// smaller shape's radius. Kept contacts may leave their places by half of it.
pub(crate) const OWN_PLACE: f64 = 2.0 * KEPT_DRIFT;
/// And if some contact is beneath both supporting planes by no more than this: a few times what climbs may lose on a
/// scanned plate. A tenth of a degree of another slope is more.
pub(crate) const OWN_HEIGHT: f64 = 5.0 * BOWL_LOSS;
/// Such contacts and their normals are rounded to f32, and so off by some roundings of the larger shape's coordinates.
pub(crate) const OWN_ROUNDING: f64 = 1e-6;

/// The boundary of a half-space is a disc of so many radii under a curved shape, whose places are all above it.
pub(crate) const WIDE_PLANE: f64 = 4.0;

/// A ball that stands for a part of a body in a cast is larger than the part by this share of its radius and of its
/// place: the motion of its centre is rounded a few times to f32.
pub(crate) const LOOSE_BALL: f32 = 1e-5;

/// A box in which cells are looked for is larger than it would be by this share of its coordinates, a few roundings of
/// f32.
pub(crate) const LOOSE_BOX: f32 = 1e-6;
/// A cast looks for cells along stretches of so many cells, and of half of the moving shape: on longer ones, more cells
/// beside the way are looked at, on shorter ones, the same cells more often.
pub(crate) const CELLS_AT_ONCE: f32 = 4.0;
/// There are no more stretches than these, however long the way is, and no shorter boxes than this share of a shape.
pub(crate) const MOST_STRETCHES: f32 = 10_000.0;
/// A cast of turning shapes looks at the cells in a box one by one if it is no longer than so many cells.
pub(crate) const CELLS_IN_BOX: f32 = 2.0;

/// A cast is looked at once more if the shapes approach by less than this share of their velocity: then they may only
/// graze the target distance. An edge that is passed a rounding too near shows less than 0.03.
pub(crate) const MAY_GRAZE: f64 = 0.1;
