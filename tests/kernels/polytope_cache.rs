//! What is kept of an expanded polytope proves depths, and only such as are true; it saves work, and
//! changes no bit of an answer.

use glam::{DQuat, DVec3};
use isa_gjk::Hull;
use isa_gjk::internals::epa::{EpaScratch, KnownDepth, PolytopeCache, penetration};
use isa_gjk::internals::pose::RelativePose;
use isa_gjk::internals::query::{Answer, PairMemory, Query};
use isa_gjk::internals::stats::{Cost, Stage};
use isa_gjk::internals::support::Cso;
use parry3d::math::Pose;
use testkit::generate::Rng;

/// Of the smaller radius: what a known depth may be too large by.
const TOLERANCE: f64 = 2.1e-6;

fn hull(vertices: usize, rng: &mut Rng) -> Hull {
    let points: Vec<_> = (0..vertices).map(|_| rng.direction().as_vec3()).collect();
    Hull::from_points(&points).expect("points on a sphere")
}

/// Deep in each other, or not quite, and moving slowly.
struct Motion {
    from: DVec3,
    velocity: DVec3,
    axis: DVec3,
    speed: f64,
}

impl Motion {
    fn new(rng: &mut Rng, depth: f64, speed: f64) -> Self {
        Self {
            from: rng.direction() * (2.0 - depth),
            velocity: rng.direction() * 0.002 * speed,
            axis: rng.direction(),
            speed: speed * 0.5_f64.to_radians(),
        }
    }

    fn at(&self, frame: usize) -> RelativePose {
        let t = frame as f64;
        let turn = DQuat::from_axis_angle(self.axis, self.speed * t).as_quat();
        let place = (self.from + self.velocity * t).as_vec3();
        RelativePose::new(&Pose::from_parts(place, turn)).expect("a finite pose")
    }
}

fn ask(
    hulls: &[Hull; 2],
    pose: &RelativePose,
    memory: &PairMemory,
    polytope_cache: Option<(&mut PolytopeCache, u64)>,
) -> (Answer, Stage) {
    let query = Query {
        cso: &cso(hulls, pose),
        max_distance: 0.01,
        polytope_cache,
        scratch: &mut EpaScratch::default(),
        cost: &mut Cost::default(),
    }
    .run(memory);
    query.expect("finite solids")
}

fn cso<'a>(hulls: &'a [Hull; 2], pose: &'a RelativePose) -> Cso<'a, Hull, Hull> {
    Cso {
        shape_1: &hulls[0],
        shape_2: &hulls[1],
        pose,
    }
}

/// A depth alone, of which no facet is known.
fn known(depth: f64) -> KnownDepth {
    KnownDepth {
        depth,
        normal: DVec3::X,
        inset: 0.0,
    }
}

/// Along slow and fast motions, with a cached polytope of the pair's own, and with one that many pairs write
/// to in turn.
#[test]
fn no_bit_of_an_answer_depends_on_the_cache() {
    let mut rng = Rng::new(71);
    let mut proved = [0; 2];
    let mut cache = PolytopeCache::default();
    const SHARED: u64 = u64::MAX;
    for round in 0..120 {
        let hulls = [(); 2].map(|()| hull([8, 20, 90, 400][round % 4], &mut rng));
        let depth = [0.01, 0.1, 0.4, 1.2][round / 4 % 4];
        let motion = Motion::new(&mut rng, depth, [0.1, 1.0, 10.0][round % 3]);
        let mut memory = PairMemory::None;
        for frame in 0..40 {
            let pose = motion.at(frame);
            let (answer, stage) = ask(&hulls, &pose, &memory, None);
            assert_ne!(stage, Stage::CachedPolytope, "there is none");
            for (key, proved) in [round as u64, SHARED].into_iter().zip(&mut proved) {
                let (other, stage) = ask(&hulls, &pose, &memory, Some((&mut cache, key)));
                // Debug prints all digits.
                assert_eq!(
                    format!("{answer:?}"),
                    format!("{other:?}"),
                    "{round}/{frame}"
                );
                *proved += usize::from(stage == Stage::CachedPolytope);
            }
            memory = answer.memory();
        }
    }
    assert!(
        proved.iter().all(|&n| n > 1_000),
        "{proved:?} of 4,800 frames"
    );
}

/// Polytopes of other poses and other pairs, also of such as have vertices that this one has not.
#[test]
fn what_a_cached_polytope_proves_is_true() {
    let mut rng = Rng::new(72);
    let mut cache = PolytopeCache::default();
    let mut outcomes = [0; 2];
    let (mut overlapping, mut own) = (0, 0);
    for round in 0..4_000 {
        let hulls = [(); 2].map(|()| hull([5, 12, 40, 120][round % 4], &mut rng));
        let motion = Motion::new(&mut rng, [0.3, 0.7, 1.4][round % 3], 1.0);
        let scratch = &mut EpaScratch::default();
        let cost = &mut Cost::default();
        for frame in [0, 3, 30] {
            let pose = motion.at(frame);
            let cso = cso(&hulls, &pose);
            let Some(true_depth) = penetration(&cso, &[], scratch, cost).map(|found| found.depth)
            else {
                panic!("finite solids");
            };
            for claimed in [0.6, 0.95, 1.0, 1.0 + 1e-5, 1.1].map(|share| share * true_depth) {
                let tolerance = TOLERANCE * cso.min_radius();
                let proves = cache.proves_depth(0, &cso, &known(claimed), scratch, cost);
                assert!(!proves || true_depth >= claimed - tolerance, "{round}");
                outcomes[usize::from(proves)] += usize::from(true_depth > 0.0);
            }
            if frame == 0 {
                penetration(&cso, &[], scratch, cost);
                cache.store(0, &cso, scratch);
                let radius = cso.min_radius();
                own += usize::from(cache.proves_depth(0, &cso, &known(true_depth), scratch, cost));
                overlapping += usize::from(true_depth > 0.0);
                let too_deep = known(true_depth + 1e-5 * radius);
                assert!(!cache.proves_depth(0, &cso, &too_deep, scratch, cost));
            }
        }
    }
    assert!(own * 50 > overlapping * 49, "{own} of {overlapping}");
    assert!(
        outcomes.iter().all(|&n| n > 1_000),
        "not proved, proved: {outcomes:?}"
    );
}

#[test]
fn an_empty_shell_proves_nothing() {
    let mut rng = Rng::new(73);
    let hulls = [(); 2].map(|()| hull(20, &mut rng));
    let pose = Motion::new(&mut rng, 1.0, 0.0).at(0);
    for depth in [-1.0, 0.0, 1e-9, 0.5] {
        let (scratch, cost) = (&mut EpaScratch::default(), &mut Cost::default());
        assert!(!PolytopeCache::default().proves_depth(
            0,
            &cso(&hulls, &pose),
            &known(depth),
            scratch,
            cost
        ));
    }
}

/// Twice as many pairs as there are slots: the first pairs keep theirs while they are useful, and lose them
/// when they are not.
#[test]
fn pairs_that_share_a_place_do_not_drive_each_other_out() {
    const PAIRS: u64 = 4_096;
    let mut rng = Rng::new(74);
    let hulls = [(); 2].map(|()| hull(12, &mut rng));
    let pose = Motion::new(&mut rng, 1.7, 0.0).at(0);
    let cso = cso(&hulls, &pose);
    let (scratch, cost) = (&mut EpaScratch::default(), &mut Cost::default());
    let found = penetration(&cso, &[], scratch, cost).expect("finite solids");
    assert!(found.depth > 0.1, "they overlap");
    let expanded = scratch.clone();
    let mut cache = PolytopeCache::default();
    let mut frame = |pairs: std::ops::Range<u64>| {
        let mut proved = Vec::new();
        for key in pairs {
            if cache.proves_depth(key, &cso, &known(found.depth), scratch, cost) {
                proved.push(key);
            } else {
                cache.store(key, &cso, &expanded);
            }
        }
        proved
    };
    assert!(frame(0..PAIRS / 2).is_empty(), "nothing was kept");
    let first = frame(0..PAIRS / 2);
    assert!(first.len() > 1_000, "{} of the first pairs", first.len());
    let crowd = frame(0..PAIRS);
    assert!(
        first.iter().all(|key| crowd.contains(key)),
        "driven out at once"
    );
    // Pairs that are no longer queried give way.
    for _ in 0..40 {
        frame(PAIRS / 2..PAIRS);
    }
    let second = frame(PAIRS / 2..PAIRS);
    assert!(second.len() > 1_000, "{} of the later pairs", second.len());
}
