//! The distance sub-algorithms against an independent oracle, against each other, and against the
//! optimality condition, on simplices of every kind of degeneracy.

use glam::DVec3;
use isa_gjk::internals::simplex::{DistanceSubalgorithm, Johnson, Nearest, SignedVolumes, Voronoi};
use oorandom::Rand64;

/// Simplices per regime; every one is put to all three algorithms.
const CASES: usize = 200_000;

/// What an answer may miss, relative to the farthest vertex.
#[derive(Clone, Copy)]
struct Tolerance {
    /// The oracle's norm.
    norm: f64,
    /// The optimality condition `v·(v − y_i) ≤ 0`, relative to the square.
    optimality: f64,
    /// The convex combination that is said to be the point.
    combination: f64,
}

/// Sound simplices, and exactly degenerate ones: right to rounding. (The weights of a tetrahedron
/// that holds the origin are not refined; Johnson's lose more.)
const ROUNDING: [Tolerance; 3] = [
    Tolerance {
        norm: 1e-14,
        optimality: 1e-12,
        combination: 1e-10,
    },
    Tolerance {
        norm: 1e-14,
        optimality: 1e-13,
        combination: 1e-12,
    },
    Tolerance {
        norm: 1e-14,
        optimality: 1e-13,
        combination: 1e-12,
    },
];

/// Nearly flat tetrahedra, down to needles of width 1e-8: Johnson's determinants, products of up to
/// six lengths, keep a quarter of the digits; volumes keep nearly half.
const NEARLY_FLAT: [Tolerance; 3] = [
    Tolerance {
        norm: 1e-3,
        optimality: 1e-5,
        combination: 1e-3,
    },
    Tolerance {
        norm: 2e-6,
        optimality: 1e-7,
        combination: 2e-6,
    },
    Tolerance {
        norm: 2e-6,
        optimality: 1e-7,
        combination: 2e-6,
    },
];

/// Below this coordinate, relative to 1, the origin is as good as on the boundary of a face.
const ON_BOUNDARY: f64 = 1e-9;

type Solve = fn(&[DVec3]) -> Nearest;

const ALGORITHMS: [(&str, Solve); 3] = [
    ("Johnson", Johnson::nearest),
    ("Voronoi", Voronoi::nearest),
    ("SignedVolumes", SignedVolumes::nearest),
];

// --- The oracle: orthogonal bases of all 15 faces, refined, clamped into the face. ---

/// The least norm over a simplex. Every candidate is a convex combination, so that no error of a
/// nearly dependent basis can undercut the truth, and the nearest feature's is accurate.
fn oracle(y: &[DVec3]) -> f64 {
    let subsets = 1..1_usize << y.len();
    subsets
        .map(|s| face_distance(y, s))
        .fold(f64::INFINITY, f64::min)
}

fn face_distance(y: &[DVec3], subset: usize) -> f64 {
    let mut face: Vec<DVec3> = (0..y.len())
        .filter(|i| subset >> i & 1 == 1)
        .map(|i| y[i])
        .collect();
    face.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let edges: Vec<DVec3> = face[1..].iter().map(|&p| p - face[0]).collect();
    let mut x = vec![0.0; edges.len()];
    for _ in 0..4 {
        let residual = edges.iter().zip(&x).fold(face[0], |r, (&e, &x)| r + e * x);
        for (x, dx) in x.iter_mut().zip(least_squares(&edges, -residual)) {
            *x += dx;
        }
    }
    x.iter_mut().for_each(|x| *x = x.max(0.0));
    let sum = x.iter().sum::<f64>().max(1.0);
    edges
        .iter()
        .zip(&x)
        .fold(face[0], |v, (&e, &x)| v + e * (x / sum))
        .length()
}

/// Minimizes ‖Σ x_i e_i − target‖ by Gram-Schmidt with pivoting and reorthogonalization.
fn least_squares(edges: &[DVec3], target: DVec3) -> Vec<f64> {
    let n = edges.len();
    let mut left: Vec<(usize, DVec3)> = edges.iter().copied().enumerate().collect();
    let mut basis: Vec<(usize, DVec3)> = Vec::new();
    while !left.is_empty() {
        let longest = (0..left.len())
            .max_by(|&i, &j| {
                left[i]
                    .1
                    .length_squared()
                    .total_cmp(&left[j].1.length_squared())
            })
            .unwrap();
        let (i, rest) = left.swap_remove(longest);
        let q = basis.iter().fold(rest, |r, (_, q)| r - *q * q.dot(r));
        if q.length() <= 1e-14 * edges[i].length() {
            break;
        }
        let q = q.normalize();
        let q = basis
            .iter()
            .fold(q, |r, (_, q)| r - *q * q.dot(r))
            .normalize();
        left.iter_mut().for_each(|(_, r)| *r -= q * q.dot(*r));
        basis.push((i, q));
    }
    let mut x = vec![0.0; n];
    for k in (0..basis.len()).rev() {
        let (i, q) = basis[k];
        let known: f64 = basis[k + 1..]
            .iter()
            .map(|&(j, _)| q.dot(edges[j]) * x[j])
            .sum();
        x[i] = (q.dot(target) - known) / q.dot(edges[i]);
    }
    x
}

// --- Simplices ---

struct Source(Rand64);

impl Source {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.rand_float()
    }

    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn cube(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.between(-1.0, 1.0)))
    }

    fn grid(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| {
            self.0.rand_range(0..5) as f64 - 2.0
        }))
    }

    fn simplex(&mut self, mut vertex: impl FnMut(&mut Self) -> DVec3) -> Vec<DVec3> {
        let count = self.0.rand_range(1..5);
        (0..count).map(|_| vertex(self)).collect()
    }

    /// Integer coordinates: the origin lies on vertices, edges and faces all the time, and
    /// degenerate simplices are exactly so.
    fn on_the_grid(&mut self) -> Vec<DVec3> {
        self.simplex(Self::grid)
    }

    fn generic(&mut self) -> Vec<DVec3> {
        let offset = self.cube();
        self.simplex(|source| source.cube() + offset)
    }

    /// A small simplex far away.
    fn distant(&mut self) -> Vec<DVec3> {
        let (offset, size) = (self.cube(), self.log_uniform(1e-6, 1.0));
        self.simplex(|source| offset + source.cube() * size)
    }

    /// A generic simplex at the scales the crate may meet.
    fn scaled(&mut self) -> Vec<DVec3> {
        let scale = self.log_uniform(1e-6, 1e6);
        self.generic().iter().map(|&p| p * scale).collect()
    }

    /// Flattened in one or two skew directions, the origin near, inside or off its plane.
    fn nearly_flat(&mut self) -> Vec<DVec3> {
        let (u, v, w) = (self.cube(), self.cube(), self.cube());
        let thin = self.log_uniform(1e-8, 1.0);
        let thinner = if self.0.rand_range(0..2) == 0 {
            thin
        } else {
            1.0
        };
        let lift = self.log_uniform(1e-8, 1.0);
        let offset = self.cube() * lift;
        self.simplex(|source| {
            let p = source.cube();
            offset + u * p.x + v * (p.y * thinner) + w * (p.z * thin)
        })
    }

    /// Vertices repeated, or combined from others: dependent to the last digit or nearly.
    fn dependent(&mut self) -> Vec<DVec3> {
        let mut y = self.generic();
        for i in 1..y.len() {
            let (j, k) = (
                self.0.rand_range(0..i as u64),
                self.0.rand_range(0..i as u64),
            );
            let t = self.between(-1.0, 2.0).max(0.0);
            if self.0.rand_range(0..3) > 0 {
                y[i] = y[j as usize].lerp(y[k as usize], t);
            }
        }
        y
    }
}

// --- Checks ---

fn size(y: &[DVec3]) -> f64 {
    y.iter()
        .map(|p| p.length())
        .fold(f64::MIN_POSITIVE, f64::max)
}

/// What every answer satisfies, on any input.
fn check_convex(name: &str, y: &[DVec3], nearest: &Nearest) {
    let Nearest {
        point,
        face,
        lambda,
    } = *nearest;
    let case = || format!("{name}: {y:?}: {nearest:?}");
    assert!(point.is_finite(), "not finite: {}", case());
    assert!(
        lambda.iter().all(|l| (0.0..=1.0).contains(l)),
        "not convex: {}",
        case()
    );
    assert!(
        (lambda.iter().sum::<f64>() - 1.0).abs() < 1e-15 * 4.0,
        "sum: {}",
        case()
    );
    let support = (0..4)
        .filter(|&i| lambda[i] > 0.0)
        .fold(0, |mask, i| mask | 1 << i);
    assert_eq!(face, support, "face: {}", case());
    assert!(u32::from(face) < 1 << y.len(), "no such vertex: {}", case());
    if face == 0b1111 {
        assert_eq!(point, DVec3::ZERO, "inside: {}", case());
    }
}

fn check_nearest(name: &str, y: &[DVec3], nearest: &Nearest, truth: f64, allowed: &Tolerance) {
    check_convex(name, y, nearest);
    let (v, size) = (nearest.point, size(y));
    let case = || format!("{name}: {y:?}: {nearest:?}, truth {truth}");
    let combination = y
        .iter()
        .zip(nearest.lambda)
        .fold(DVec3::ZERO, |s, (&p, l)| s + p * l);
    assert!(
        v.distance(combination) <= allowed.combination * size,
        "combination: {}",
        case()
    );
    assert!(
        (v.length() - truth).abs() <= allowed.norm * size,
        "norm: {}",
        case()
    );
    let gap = y.iter().map(|&p| v.dot(v - p)).fold(0.0, f64::max);
    assert!(
        gap <= allowed.optimality * size * size,
        "optimality {gap}: {}",
        case()
    );
}

fn check_regime(seed: u128, regime: fn(&mut Source) -> Vec<DVec3>, allowed: &[Tolerance; 3]) {
    let mut source = Source(Rand64::new(seed));
    for _ in 0..CASES {
        let y = regime(&mut source);
        let truth = oracle(&y);
        for ((name, solve), allowed) in ALGORITHMS.iter().zip(allowed) {
            check_nearest(name, &y, &solve(&y), truth, allowed);
        }
    }
}

#[test]
fn grid() {
    check_regime(1, Source::on_the_grid, &ROUNDING);
}

#[test]
fn generic() {
    check_regime(2, Source::generic, &ROUNDING);
}

#[test]
fn distant() {
    check_regime(3, Source::distant, &ROUNDING);
}

#[test]
fn scaled() {
    check_regime(4, Source::scaled, &ROUNDING);
}

#[test]
fn nearly_flat() {
    check_regime(5, Source::nearly_flat, &NEARLY_FLAT);
}

#[test]
fn dependent() {
    check_regime(6, Source::dependent, &ROUNDING);
}

#[test]
fn all_agree_on_the_face() {
    let mut source = Source(Rand64::new(7));
    let mut compared = 0;
    for _ in 0..CASES {
        let y = source.generic();
        let answers = ALGORITHMS.map(|(_, solve)| solve(&y));
        let inner = |n: &Nearest| n.lambda.iter().all(|&l| l == 0.0 || l > ON_BOUNDARY);
        for pair in answers.windows(2).filter(|pair| pair.iter().all(inner)) {
            assert_eq!(pair[0].face, pair[1].face, "{y:?}: {pair:?}");
            assert!(
                pair[0].point.distance(pair[1].point) <= 1e-11 * size(&y),
                "{y:?}: {pair:?}"
            );
            compared += 1;
        }
    }
    assert!(compared > CASES);
}

#[test]
fn extreme_numbers_give_no_nan() {
    const MAGNITUDES: [f64; 9] = [
        0.0,
        f64::MIN_POSITIVE,
        1e-200,
        1e-100,
        1e-30,
        1e30,
        1e60,
        1e100,
        f64::MAX,
    ];
    let mut source = Source(Rand64::new(8));
    for _ in 0..CASES {
        let y = source
            .simplex(|source| source.grid() / 2.0 * MAGNITUDES[source.0.rand_range(0..9) as usize]);
        for (name, solve) in ALGORITHMS {
            check_convex(name, &y, &solve(&y));
        }
    }
}

#[test]
fn no_vertices_have_an_empty_face() {
    for (_, solve) in ALGORITHMS {
        assert_eq!(solve(&[]), Nearest::default());
    }
}

/// Looks at simplices of dyadic coordinates: powers of two scale them exactly.
fn for_simplices(law: impl Fn(&[DVec3], &mut Rand64)) {
    let mut rng = Rand64::new(1988);
    for _ in 0..1000 {
        let mut coordinate = || rng.rand_range(0..129) as f64 / 16.0 - 4.0;
        let all = [(); 4].map(|()| DVec3::new(coordinate(), coordinate(), coordinate()));
        let count = rng.rand_range(1..5) as usize;
        law(&all[..count], &mut rng);
    }
}

#[test]
fn order_does_not_matter() {
    for_simplices(|y, rng| {
        let mut shuffled = y.to_vec();
        for last in (1..y.len()).rev() {
            shuffled.swap(last, rng.rand_range(0..last as u64 + 1) as usize);
        }
        for (name, solve) in ALGORITHMS {
            let difference = solve(y).point.distance(solve(&shuffled).point);
            assert!(difference <= 1e-12 * size(y), "{name}: {y:?}");
        }
    });
}

#[test]
fn scale_does_not_matter() {
    for_simplices(|y, rng| {
        let scale = 2_f64.powi(rng.rand_range(0..41) as i32 - 20);
        let scaled: Vec<DVec3> = y.iter().map(|&p| p * scale).collect();
        for (name, solve) in ALGORITHMS {
            let (small, large) = (solve(y), solve(&scaled));
            assert_eq!(small.point * scale, large.point, "{name}: {y:?}");
            assert_eq!(small.lambda, large.lambda, "{name}: {y:?}");
        }
    });
}

#[test]
fn turning_the_space_turns_the_answer() {
    for_simplices(|y, _| {
        let turned: Vec<DVec3> = y.iter().map(|p| DVec3::new(p.y, p.z, p.x)).collect();
        for (name, solve) in ALGORITHMS {
            let p = solve(y).point;
            let difference = DVec3::new(p.y, p.z, p.x).distance(solve(&turned).point);
            assert!(difference <= 1e-12 * size(y), "{name}: {y:?}");
        }
    });
}
