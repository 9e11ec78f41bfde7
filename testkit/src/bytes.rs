//! Any string of bytes is a pair of shapes and a motion: the input of the fuzz tests.

use isa_gjk::{Hull, HullShape};
use parry3d::math::{Pose, Real, Rotation, Vector};
use parry3d::shape::{ConvexPolyhedron, SharedShape};
use parry3d::transformation::try_convex_hull;
use parry3d::utils::Array2;

/// Numbers that are trouble, before they are scaled.
const TROUBLE: [Real; 11] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1.0e-7,
    -1.0e-7,
    1.0e-3,
    0.999_999_94,
    1.000_000_1,
    1.0e-38,
];

/// Numbers that are none, or hardly.
const NONSENSE: [Real; 5] = [
    Real::NAN,
    Real::INFINITY,
    Real::NEG_INFINITY,
    Real::MAX,
    1.0e25,
];

/// The rest of a string of bytes; zeros when it is used up.
pub struct Bytes<'a> {
    rest: &'a [u8],
    tampered: bool,
    /// The smallest and the largest size so far.
    sizes: [Real; 2],
}

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            tampered: false,
            sizes: [Real::INFINITY, 0.0],
        }
    }

    /// The size of the smallest convex shape made so far, relative to the largest.
    pub fn size_ratio(&self) -> Real {
        self.sizes[0] / self.sizes[1]
    }

    fn note_size(&mut self, points: &[Vector]) {
        let size = points.iter().map(|p| p.length()).fold(0.0, Real::max);
        self.sizes = [self.sizes[0].min(size), self.sizes[1].max(size)];
    }

    /// Whether a polyhedron was made that need not be convex: there is no right answer then.
    pub fn is_tampered(&self) -> bool {
        self.tampered
    }

    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.rest.split_first() else {
            return 0;
        };
        self.rest = rest;
        *first
    }

    fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// Mostly of magnitude up to one, on a coarse grid (where coincidences are) or a fine one.
    fn number(&mut self) -> Real {
        let byte = self.byte();
        match byte >> 6 {
            0 => TROUBLE[usize::from(byte) % TROUBLE.len()],
            1 => Real::from(byte & 7) / 4.0 - 1.0,
            _ => (Real::from(byte & 63) * 256.0 + Real::from(self.byte())) / 8192.0 - 1.0,
        }
    }

    fn vector(&mut self) -> Vector {
        Vector::new(self.number(), self.number(), self.number())
    }

    /// From a millionth to a million, mostly one.
    fn scale(&mut self) -> Real {
        let exponent = match self.byte() {
            byte @ 0..=25 => i32::from(byte) / 2 - 6,
            _ => 0,
        };
        Real::powi(10.0, exponent)
    }

    /// The next pose of a motion: half of the time near the last one.
    pub fn pose(&mut self, last: &Pose, reach: Real) -> Pose {
        if self.byte() < 128 && last.translation.is_finite() {
            let step = self.vector() * reach * 0.01;
            let turn = Rotation::from_scaled_axis(self.vector() * 0.02);
            let place = last.translation + step;
            return Pose::from_parts(place, (turn * last.rotation).normalize());
        }
        let place = self.vector() * reach;
        let turn = Rotation::from_scaled_axis(self.vector() * 4.0);
        match self.byte() {
            byte @ 250..=254 => {
                let bad = NONSENSE[usize::from(byte - 250)];
                Pose::from_parts(Vector::new(place.x, bad, place.z), turn)
            }
            255 => Pose::from_parts(place, Rotation::from_xyzw(0.0, 0.0, 0.0, 0.0)),
            _ => Pose::from_parts(place, turn),
        }
    }

    pub fn prediction(&mut self, size: Real) -> Real {
        match self.byte() {
            0 => 0.0,
            1 => -0.1 * size,
            2 => 1.0e10 * size,
            3 => Real::INFINITY,
            4 => Real::NAN,
            byte => size * Real::from(byte) / 1000.0,
        }
    }

    fn points(&mut self) -> Vec<Vector> {
        let count = 4 + self.below(28);
        let scale = self.scale();
        let stretch = Vector::new(
            1.0,
            1.0,
            [1.0, 1.0, 1.0, 1.0e-2, 1.0e-5, 1.0e-7][self.below(6)],
        );
        let points = (0..count).map(|_| self.vector() * scale * stretch);
        let points: Vec<Vector> = points.collect();
        self.note_size(&points);
        points
    }

    fn surface(&mut self) -> Option<(Vec<Vector>, Vec<[u32; 3]>)> {
        let points = self.points();
        // Parry's hull builder may panic where ours names an error.
        Hull::from_points(&points).ok()?;
        try_convex_hull(&points).ok()
    }

    /// A hull's surface, whose points are then moved a little, or a lot: what parry's polyhedron
    /// takes without a look.
    fn polyhedron(&mut self) -> Option<ConvexPolyhedron> {
        let (mut points, triangles) = self.surface()?;
        let size = points.iter().map(|p| p.length()).fold(0.0, Real::max);
        let change = self.below(12);
        self.tampered |= change < 4;
        match change {
            0 => points.iter_mut().for_each(|p| p.z = 0.0),
            1 => points.iter_mut().for_each(|p| p.x = -p.x),
            2 => points[0] += self.vector() * size,
            3 => {
                for p in &mut points {
                    *p += self.vector() * size * 1.0e-6;
                }
            }
            _ => {}
        }
        ConvexPolyhedron::from_convex_mesh(points, &triangles)
    }

    /// A hull of any kind; `None` where the bytes describe none.
    pub fn hull(&mut self) -> Option<SharedShape> {
        Some(match self.below(5) {
            0..=2 => SharedShape::new(self.polyhedron()?),
            3 => SharedShape::new(HullShape::from_points(&self.points()).ok()?),
            _ => {
                let border = self.number().abs();
                let polyhedron = self.polyhedron()?;
                SharedShape::round_convex_hull(polyhedron.points(), border)?
            }
        })
    }

    /// A hull, or another convex shape.
    pub fn convex(&mut self) -> Option<SharedShape> {
        Some(match self.below(8) {
            0..=4 => self.hull()?,
            5 => {
                let half = self.vector().abs() * self.scale();
                self.note_size(&[half]);
                SharedShape::cuboid(half.x, half.y, half.z)
            }
            6 => {
                let scale = self.scale();
                let [a, b, c] = [(); 3].map(|()| self.vector() * scale);
                self.note_size(&[a - b, a - c]);
                SharedShape::triangle(a, b, c)
            }
            _ => SharedShape::ball(0.1 + self.number().abs()),
        })
    }

    /// A shape with parts.
    pub fn composite(&mut self) -> Option<SharedShape> {
        Some(match self.below(3) {
            0 => {
                let parts = [(); 2].map(|()| {
                    let place = Pose::from_translation(self.vector());
                    self.convex().map(|shape| (place, shape))
                });
                SharedShape::compound(parts.into_iter().collect::<Option<Vec<_>>>()?)
            }
            1 => {
                let (points, triangles) = self.surface()?;
                SharedShape::trimesh(points, triangles).ok()?
            }
            _ => {
                let heights = (0..9)
                    .map(|_| 0.3 * self.number().clamp(-1.0, 1.0))
                    .collect();
                SharedShape::heightfield(Array2::new(3, 3, heights), Vector::new(2.0, 1.0, 2.0))
            }
        })
    }
}
