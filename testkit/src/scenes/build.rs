//! Where the bodies of each scene start.

use oorandom::Rand32;
use rapier3d::prelude::*;

use super::containers::{Ground, WALL};
use super::filler::{Filler, GAP, reach, square_cell};
use super::world::World;
use super::{HullSource, Scene, SceneParams, containers, families, hulls, solids, standing};

/// Distance between the centres of neighbours at the start, in bounding diameters.
const SPACING: Real = 1.1;
/// Bodies along a side of a narrow pile over those of a cubic one.
const HEAP_WIDTH: Real = 0.7;
const TOWER: usize = 8;
const COIN_TOWER: usize = 16;
const COIN_HALF_HEIGHT: Real = 0.03;
/// One bouncing hull for so many that sleep.
const SLEEPERS_PER_BOUNCER: usize = 100;

/// Puts the bodies of `scene` and their container into an empty world, with colliders that are
/// [`isa_gjk::HullShape`]s where the hulls are plain if `hull_shape` is set.
pub fn fill(
    world: &mut World,
    scene: Scene,
    params: &SceneParams,
    hull_shape: bool,
) -> Result<(), String> {
    let mut random = Rand32::new(params.seed);
    let mut shapes = shapes(scene, params, &mut random)?;
    if let Some(size) = params.size.or(scene.default_size()) {
        shapes = hulls::scaled(&shapes, size)?;
    }
    let colliders = if hull_shape {
        hulls::prepared(&shapes)?
    } else {
        shapes.clone()
    };
    let mut filler = Filler {
        world,
        reach: shapes.iter().map(reach).fold(0.0, Real::max),
        shapes,
        colliders,
        random,
        bodies: params.bodies as usize,
        can_sleep: params.can_sleep,
    };
    match scene {
        Scene::Drum => filler.drum(),
        Scene::Stack => filler.towers(TOWER),
        Scene::Coins => filler.towers(COIN_TOWER),
        Scene::Asleep => filler.resting(),
        Scene::Wall => filler.wall(),
        Scene::Dominoes => filler.dominoes(),
        Scene::Spin => filler.spinning()?,
        Scene::Top => filler.tops(),
        Scene::Rolling => filler.rolling(),
        Scene::Trimesh => filler.spread_on(Ground::Mesh)?,
        Scene::Heightfield => filler.spread_on(Ground::HeightField)?,
        Scene::Rubble => filler.spread_on(Ground::Boxes)?,
        Scene::Solids => filler.heap_on(params.ground)?,
        Scene::Breach => filler.breach(),
        Scene::Grippers | Scene::ShakenGrippers => filler.grippers(scene)?,
        Scene::Pile
        | Scene::Cuboids
        | Scene::Balls
        | Scene::Mixed
        | Scene::Compound
        | Scene::Rocks
        | Scene::Stones
        | Scene::Dice
        | Scene::Pebbles
        | Scene::Cubes
        | Scene::Plates
        | Scene::Needles
        | Scene::Pencils
        | Scene::Rings
        | Scene::Reshaped
        | Scene::Bursts => filler.pile()?,
    }
    Ok(())
}

/// The shapes that the bodies of a scene take in turn.
fn shapes(
    scene: Scene,
    params: &SceneParams,
    random: &mut Rand32,
) -> Result<Vec<SharedShape>, String> {
    let size = |random: &mut Rand32| hulls::RADIUS * (0.3 + 0.4 * random.rand_float());
    let count = params.distinct.min(params.bodies);
    Ok(match scene {
        Scene::Cuboids => (0..count)
            .map(|_| SharedShape::cuboid(size(random), size(random), size(random)))
            .collect(),
        Scene::Balls => (0..count)
            .map(|_| SharedShape::ball(size(random)))
            .collect(),
        Scene::Mixed => hulls::make(&params.hulls, count, random)?
            .into_iter()
            .flat_map(|hull| {
                let [a, b, c] = [size(random), size(random), size(random)];
                [
                    hull,
                    SharedShape::ball(a),
                    SharedShape::cuboid(a, b, c),
                    SharedShape::capsule_y(a, b),
                    SharedShape::cylinder(b, c),
                    SharedShape::cone(c, a),
                ]
            })
            .collect(),
        Scene::Solids => solids::make(&params.solids, params.bodies, random)?,
        Scene::Compound => {
            let hulls = hulls::make(&params.hulls, count, random)?;
            (0..hulls.len()).map(|i| pair_of_hulls(&hulls, i)).collect()
        }
        Scene::Rocks | Scene::Pebbles => families::rocks(count, random)?,
        Scene::Stones => families::stones(count, random)?,
        Scene::Dice => families::dice()?,
        Scene::Cubes => vec![families::cube()?],
        Scene::Plates => vec![families::plate()?],
        Scene::Needles => vec![families::needle()?],
        Scene::Wall | Scene::Breach => vec![hulls::cuboid(standing::BRICK)?],
        Scene::Dominoes => vec![hulls::cuboid(standing::DOMINO)?],
        Scene::Coins | Scene::Top => {
            vec![hulls::prism(
                sides(params)?,
                hulls::RADIUS,
                COIN_HALF_HEIGHT,
            )?]
        }
        Scene::Pencils => vec![families::pencil(sides(params)?)?],
        Scene::Rings => vec![families::ring(sides(params)?)?],
        Scene::Stack => hulls::upright(&params.hulls, count, random)?,
        Scene::Drum
        | Scene::Pile
        | Scene::Spin
        | Scene::Rolling
        | Scene::Asleep
        | Scene::Trimesh
        | Scene::Heightfield
        | Scene::Rubble
        | Scene::Grippers
        | Scene::ShakenGrippers
        | Scene::Reshaped
        | Scene::Bursts => hulls::make(&params.hulls, count, random)?,
    })
}

fn sides(params: &SceneParams) -> Result<u32, String> {
    match params.hulls {
        HullSource::Prism { sides } => Ok(sides),
        _ => Err("this scene makes prisms".to_owned()),
    }
}

/// Hull `i` and the next one, overlapping like the two ends of a dumb-bell.
fn pair_of_hulls(hulls: &[SharedShape], i: usize) -> SharedShape {
    let ends = [&hulls[i], &hulls[(i + 1) % hulls.len()]];
    let shift = 0.6 * reach(ends[0]);
    SharedShape::compound(vec![
        (Pose::translation(-shift, 0.0, 0.0), ends[0].clone()),
        (Pose::translation(shift, 0.0, 0.0), ends[1].clone()),
    ])
}

impl Filler<'_> {
    /// A drum that the bodies fill to about a third.
    fn drum(&mut self) {
        let diameter = 2.0 * self.reach;
        let spacing = SPACING * diameter;
        let mut apothem = diameter * (0.48 * self.bodies as Real).cbrt();
        let cells = loop {
            let length = 1.6 * apothem;
            let cells = drum_cells(apothem - self.reach, length, spacing);
            if cells.len() >= self.bodies {
                containers::drum(self.world, apothem, length);
                break cells;
            }
            // A small drum holds fewer bodies than its volume says.
            apothem *= 1.05;
        };
        for (i, &cell) in cells.iter().take(self.bodies).enumerate() {
            let pose = self.tumbled(cell);
            self.insert(i, pose);
        }
    }

    fn pile(&mut self) -> Result<(), String> {
        let (side, half_width) = self.column(1.0);
        self.drop_on(Ground::Floor, side, half_width)
    }

    /// A pile on bumps, so wide that most bodies lie on them.
    fn spread_on(&mut self, ground: Ground) -> Result<(), String> {
        let (side, half_width) = self.column(1.0);
        self.drop_on(ground, 2 * side, 2.0 * half_width)
    }

    /// A pile so narrow that most bodies lie on others, though most are smaller than the largest.
    fn heap_on(&mut self, ground: Ground) -> Result<(), String> {
        let (side, half_width) = self.column(HEAP_WIDTH);
        self.drop_on(ground, side, half_width)
    }

    fn drop_on(&mut self, ground: Ground, side: usize, half_width: Real) -> Result<(), String> {
        let cell = match ground {
            Ground::Floor => 0.0,
            _ => 1.5 * self.reach,
        };
        ground.insert(self.world, half_width + WALL, cell)?;
        self.drop_in(side, half_width, cell);
        Ok(())
    }

    /// Bodies along a side of a column so many times as wide as a cubic one, and half the width of the box around it.
    fn column(&self, width: Real) -> (usize, Real) {
        let side = (width * (self.bodies as Real).cbrt()).ceil() as usize;
        let half_width = (side as Real + 0.5) * SPACING * self.reach;
        (side, half_width)
    }

    /// Layers of `side` times `side` bodies above `bottom`, with walls around them.
    fn drop_in(&mut self, side: usize, half_width: Real, bottom: Real) {
        let spacing = 2.0 * SPACING * self.reach;
        let layers = self.bodies.div_ceil(side * side);
        containers::walls(self.world, half_width, bottom + spacing * layers as Real);
        for i in 0..self.bodies {
            let (x, z) = square_cell(i % (side * side), side, spacing);
            let y = bottom + spacing * ((i / (side * side)) as Real + 0.5);
            // Exact columns would land on their tips and stand there.
            let shake = 0.05 * self.reach;
            let cell = Vector::new(x + self.within(shake), y, z + self.within(shake));
            let pose = self.tumbled(cell);
            self.insert(i, pose);
        }
    }

    /// Upright towers.
    fn towers(&mut self, high: usize) {
        let towers = self.bodies.div_ceil(high);
        let side = (towers as Real).sqrt().ceil() as usize;
        let spacing = 3.0 * self.reach;
        containers::floor(self.world, spacing * side as Real);
        let mut top = 0.0;
        for i in 0..self.bodies {
            if i % high == 0 {
                top = GAP;
            }
            let half_height = self.shape(i).compute_local_aabb().half_extents().y;
            let (x, z) = square_cell(i / high, side, spacing);
            let shake = 0.02 * self.reach;
            let centre = Vector::new(
                x + self.within(shake),
                top + half_height,
                z + self.within(shake),
            );
            let yaw = Rotation::from_rotation_y(self.within(std::f32::consts::PI));
            self.insert(i, Pose::from_parts(centre, yaw));
            top += 2.0 * half_height + GAP;
        }
    }

    /// Hulls that lie on a stable face each, and a row of bouncing ones beside them.
    fn resting(&mut self) {
        let side = (self.bodies as Real).sqrt().ceil() as usize;
        let spacing = 2.0 * SPACING * self.reach;
        let bouncers = self.bodies.div_ceil(SLEEPERS_PER_BOUNCER);
        // Wide enough for those that bounce: each bounce turns them off their way.
        containers::floor(self.world, 2.0 * spacing * side as Real);
        for i in 0..self.bodies - bouncers {
            let (x, z) = square_cell(i, side, spacing);
            let pose = resting_pose(self.shape(i), x, z);
            self.insert(i, pose);
        }
        for i in 0..bouncers {
            let (x, z) = square_cell(i * side, side, spacing);
            let away = Vector::new(x - 3.0 * spacing, 4.0 * self.reach, z);
            let pose = self.tumbled(away);
            let (_, collider) = self.insert(i, pose);
            let collider = &mut self.world.physics.colliders[collider];
            collider.set_restitution(1.0);
            collider.set_restitution_combine_rule(CoefficientCombineRule::Max);
        }
    }
}

/// Places inside a cylinder around the z axis, from the bottom up.
fn drum_cells(radius: Real, length: Real, spacing: Real) -> Vec<Vector> {
    let across = (2.0 * radius / spacing) as usize + 1;
    let deep = (length / spacing) as usize;
    let along = |step: usize, count: usize| (step as Real - (count - 1) as Real / 2.0) * spacing;
    let mut cells = Vec::new();
    for j in 0..across {
        for i in 0..across {
            let (x, y) = (along(i, across), along(j, across));
            if x.hypot(y) <= radius {
                cells.extend((0..deep).map(|k| Vector::new(x, y, along(k, deep))));
            }
        }
    }
    cells
}

/// The pose above `(x, z)` in which a hull lies on the face nearest to its centre of mass, where
/// it cannot roll: the centre is above that face.
fn resting_pose(shape: &SharedShape, x: Real, z: Real) -> Pose {
    let centre = shape.mass_properties(1.0).local_com;
    let lowest = shape.as_convex_polyhedron().and_then(|hull| {
        let heights = hull.faces().iter().map(|face| {
            let corner = hull.vertices_adj_to_face()[face.first_vertex_or_edge as usize];
            let height = face.normal.dot(hull.points()[corner as usize] - centre);
            (height, face.normal)
        });
        heights.min_by(|a, b| a.0.total_cmp(&b.0))
    });
    let (height, down) = lowest.unwrap_or((reach(shape), -Vector::Y));
    let turn = Rotation::from_rotation_arc(down, -Vector::Y);
    Pose::from_parts(Vector::new(x, height, z) - turn * centre, turn)
}
