//! Boxes in any position, and how far two of them overlap: by the separating axes of Gottschalk, Lin and Manocha
//! (*OBBTree: A hierarchical structure for rapid interference detection*, SIGGRAPH 1996).

use glam::{DVec3, Vec3};

use crate::map_pair::map_pair;
use crate::pose::RelativePose;
use crate::simd::f32x4;
use crate::tolerance::{COPLANAR, FLAT_SIDE, INSET_ROUNDING, PARALLEL_EDGES};
use crate::tuning::SQUARE;

const CORNERS: usize = 8;

/// How many separating axes two boxes have: three and three along their edges, and nine across an edge of both.
const AXES: usize = 15;

/// A box.
#[derive(Clone, Debug)]
pub struct OrientedBox {
    center: DVec3,
    /// Unit vectors along its edges.
    axes: [DVec3; 3],
    /// Half of the lengths of its edges.
    half: DVec3,
    /// The axes in f32, and coordinate by coordinate.
    rounded: [Vec3; 3],
    columns: [f32x4; 3],
}

/// What spans the facet of the Minkowski difference of two boxes that a separating axis is the normal of.
pub enum BoxFacet {
    /// A face of the first box.
    FirstFace,
    /// A face of the second box.
    SecondFace,
    /// An edge of both, along these directions, each in the frame of its box.
    Edges([DVec3; 2]),
}

impl OrientedBox {
    /// The box with these corners and face normals, if they are those of a box up to their rounding.
    pub fn with_corners(
        corners: &[Vec3],
        normals: impl Iterator<Item = Vec3> + Clone,
        radius: f64,
    ) -> Option<Self> {
        let corners: &[Vec3; CORNERS] = corners.try_into().ok()?;
        let first = normals.clone().next()?;
        let second = normals.clone().find(|n| n.dot(first).abs() < SQUARE)?;
        let axes = [first, second, first.cross(second)].map(|axis| axis.as_dvec3());
        let corners = corners.map(|corner| corner.as_dvec3());
        let center = corners.iter().sum::<DVec3>() / CORNERS as f64;
        let axes = mean_axes(corners.map(|corner| corner - center), axes)?;
        let places = corners.map(|corner| along(axes, corner - center));
        let half = places.iter().map(|place| place.abs()).sum::<DVec3>() / CORNERS as f64;
        let is_corner =
            |place: &DVec3| (place.abs() - half).abs().max_element() <= FLAT_SIDE * radius;
        let rounded = axes.map(|axis| axis.as_vec3());
        places.iter().all(is_corner).then(|| Self {
            center,
            axes,
            half,
            rounded,
            columns: columns(rounded),
        })
    }

    /// Whether no direction has a smaller depth than `least`, given the second box at a pose. `size` is that of both.
    ///
    /// All axes are compared in f32 first, with a known error. Those that may be below, mostly a single one, are
    /// compared in f64.
    #[inline(never)]
    pub fn overlap_by(&self, other: &Self, pose: &RelativePose, least: f64, size: f64) -> bool {
        let pair = BoxPair::new([self, other], pose);
        // Depths are sums of some forty roundings.
        let margin = 4.0 * INSET_ROUNDING * size;
        let mut unsure = pair.shallow_axes(least as f32, margin as f32);
        while unsure != 0 {
            let axis = pair.axis(unsure.trailing_zeros() as usize);
            unsure &= unsure - 1;
            // Nearly parallel edges span a strip, and the facets beside it are hardly deeper.
            let depth = pair.depth_along(axis) + COPLANAR * size;
            let is_deep = depth >= least * axis.length();
            if !is_deep {
                return false;
            }
        }
        true
    }

    /// The separating axis along which the second box, at a pose, overlaps the first one least: the unit normal of the
    /// facet from the first to the second, and what spans it.
    #[inline(never)]
    pub fn least_overlap(&self, other: &Self, pose: &RelativePose) -> Option<(DVec3, BoxFacet)> {
        let pair = BoxPair::new([self, other], pose);
        let mut least = f64::INFINITY;
        let mut found = None;
        for number in 0..AXES {
            let axis = pair.axis(number);
            let length_squared = axis.length_squared();
            // Nearly parallel edges span no facet.
            if length_squared > PARALLEL_EDGES {
                let length = length_squared.sqrt();
                let depth = pair.depth_along(axis) / length;
                if depth < least {
                    least = depth;
                    found = Some((axis / length, number));
                }
            }
        }
        let (axis, number) = found?;
        Some((axis * axis.dot(pair.offset).signum(), pair.facet(number)))
    }
}

struct BoxPair<'a> {
    boxes: [&'a OrientedBox; 2],
    /// Of the second box in the frame of the first.
    pose: &'a RelativePose,
    /// From the centre of the first to that of the second.
    offset: DVec3,
}

impl<'a> BoxPair<'a> {
    #[inline]
    fn new(boxes: [&'a OrientedBox; 2], pose: &'a RelativePose) -> Self {
        let offset = pose.point_to_1(boxes[1].center) - boxes[0].center;
        Self {
            boxes,
            pose,
            offset,
        }
    }

    /// A bit for each separating axis along which the depth may be less than `least`. Errors are below `margin`.
    #[inline]
    fn shallow_axes(&self, least: f32, margin: f32) -> u32 {
        let [first, second] = self.boxes;
        let of_2 = map_three(self.pose.rotation_rows(), |row| dot(&second.columns, row));
        let offset = self.offset.as_vec3();
        let [along_1, along_2] = [dot(&first.columns, offset), dot(&of_2, offset)];
        // The cosines of each axis of the first box with all of the second.
        let rows = map_three(first.rounded, |axis| dot(&of_2, axis));
        let widths = map_three(rows, f32x4::abs);
        let [[a, b, c], [d, e, f]] = map_pair([first, second], |of| of.half.as_vec3().to_array());
        let [half_1, half_2] = [f32x4::new([a, b, c, 0.0]), f32x4::new([d, e, f, 0.0])];
        let [left, right] = [f32x4::new([e, f, d, 0.0]), f32x4::new([f, d, e, 0.0])];
        let depth_1 = half_1 + sums(map_three(widths, |row| row * half_2)) - along_1.abs();
        let depth_2 = half_2 + widths[0] * a + widths[1] * b + widths[2] * c - along_2.abs();
        let limit = f32x4::splat(least + margin);
        let mut shallow = below(depth_1, limit) | below(depth_2, limit) << 3;
        let (half_1, along_1) = ([a, b, c], along_1.to_array());
        for (i, [j, k]) in [[1, 2], [2, 0], [0, 1]].into_iter().enumerate() {
            // Along the products of an axis with all axes of the other box; all lengths times theirs.
            let of_first = widths[k] * half_1[j] + widths[j] * half_1[k];
            let [x, y, z, _] = widths[i].to_array();
            let of_second = left * f32x4::new([z, x, y, 0.0]) + right * f32x4::new([y, z, x, 0.0]);
            let between = rows[j] * along_1[k] - rows[k] * along_1[j];
            let length = (rows[j] * rows[j] + rows[k] * rows[k]).sqrt();
            let depth = of_first + of_second - between.abs();
            shallow |= below(depth, length * least + margin) << (6 + 3 * i);
        }
        shallow
    }

    /// One of the fifteen separating axes, of some length, in the frame of the first box.
    fn axis(&self, number: usize) -> DVec3 {
        let of_1 = |i: usize| self.boxes[0].axes[i % 3];
        let of_2 = |i: usize| self.pose.direction_to_1(self.boxes[1].axes[i % 3]);
        match number {
            0..3 => of_1(number),
            3..6 => of_2(number),
            _ => of_1(number / 3 - 2).cross(of_2(number)),
        }
    }

    /// What spans the facet along a separating axis.
    fn facet(&self, number: usize) -> BoxFacet {
        let [first, second] = self.boxes;
        match number {
            0..3 => BoxFacet::FirstFace,
            3..6 => BoxFacet::SecondFace,
            _ => BoxFacet::Edges([first.axes[number / 3 - 2], second.axes[number % 3]]),
        }
    }

    /// How far the boxes overlap along an axis, times its length.
    fn depth_along(&self, axis: DVec3) -> f64 {
        let [first, second] = self.boxes;
        let seen = self.pose.direction_to_2(axis);
        first.reach(axis) + second.reach(seen) - self.offset.dot(axis).abs()
    }
}

impl OrientedBox {
    /// How far it reaches from its centre along an axis, times its length.
    #[inline]
    fn reach(&self, axis: DVec3) -> f64 {
        self.half.dot(along(self.axes, axis).abs())
    }
}

/// The axes of a box, along the means of its edges. The corners are given from its centre; those on different sides
/// of its middle planes are told apart by about the right axes. `None` if two are on the same sides.
fn mean_axes(corners: [DVec3; CORNERS], about: [DVec3; 3]) -> Option<[DVec3; 3]> {
    let mut found = 0_u32;
    let mut edges = [DVec3::ZERO; 3];
    for corner in corners {
        let signs = along(about, corner).signum();
        let [x, y, z] = signs.to_array().map(|sign| u32::from(sign > 0.0));
        found |= 1 << (x | y << 1 | z << 2);
        for (edge, sign) in edges.iter_mut().zip(signs.to_array()) {
            *edge += corner * sign;
        }
    }
    // The shortest edge has the worst direction.
    edges.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    let first = edges[0].try_normalize()?;
    let second = edges[1].reject_from_normalized(first).try_normalize()?;
    (found == 0xff).then_some([first, second, first.cross(second)])
}

/// The coordinates of a point along axes.
#[inline]
fn along(axes: [DVec3; 3], point: DVec3) -> DVec3 {
    DVec3::from(map_three(axes, |axis| axis.dot(point)))
}

#[inline]
fn map_three<T, U>([a, b, c]: [T; 3], mut f: impl FnMut(T) -> U) -> [U; 3] {
    [f(a), f(b), f(c)]
}

/// The three vectors coordinate by coordinate, and zero.
fn columns([a, b, c]: [Vec3; 3]) -> [f32x4; 3] {
    [
        f32x4::new([a.x, b.x, c.x, 0.0]),
        f32x4::new([a.y, b.y, c.y, 0.0]),
        f32x4::new([a.z, b.z, c.z, 0.0]),
    ]
}

#[inline]
fn dot([x, y, z]: &[f32x4; 3], dir: Vec3) -> f32x4 {
    *x * dir.x + *y * dir.y + *z * dir.z
}

/// The sums of the first three lanes.
#[inline]
fn sums(rows: [f32x4; 3]) -> f32x4 {
    let [[a, b, c, _], [d, e, f, _], [g, h, i, _]] = map_three(rows, f32x4::to_array);
    f32x4::new([a, d, g, 0.0]) + f32x4::new([b, e, h, 0.0]) + f32x4::new([c, f, i, 0.0])
}

/// The bits of the first three lanes that are not at least the limit, or NaN.
#[inline]
fn below(depth: f32x4, limit: f32x4) -> u32 {
    0b111 & !depth.simd_ge(limit).to_bitmask()
}
