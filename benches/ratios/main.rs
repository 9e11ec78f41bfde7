//! rapier's default dispatcher and ours, in turn: whatever else the machine does meanwhile, it does to both.
//! `cargo bench --bench ratios` prints medians over the turns, as tables. A word after `--` chooses a table:
//! `warm`, `curved`, `scene` or `casts`.

mod casts;
mod queries;
mod warm;

use std::time::Instant;

use oorandom::Rand32;
use parry3d::math::Vector;

const TURNS: usize = 101;

fn main() {
    let tables: [(&str, fn()); 4] = [
        ("warm", warm::manifolds),
        ("curved", warm::curved),
        ("scene", queries::scene),
        ("casts", casts::nonlinear),
    ];
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    let is_chosen = |name: &str| chosen.iter().any(|word| word == name);
    let is_any_chosen = tables.iter().any(|(name, _)| is_chosen(name));
    for (name, print) in tables {
        if is_chosen(name) || !is_any_chosen {
            print();
        }
    }
}

fn vector(random: &mut Rand32) -> Vector {
    let mut coordinate = || 2.0 * random.rand_float() - 1.0;
    Vector::new(coordinate(), coordinate(), coordinate())
}

/// Nanoseconds of each call and the ratio, medians, when both make so many calls in turn.
fn in_turn(calls: usize, default: impl Fn(), ours: impl Fn()) -> String {
    let time = |work: &dyn Fn()| {
        let start = Instant::now();
        work();
        start.elapsed().as_nanos() as f64 / calls as f64
    };
    let turns: Vec<[f64; 2]> = (0..TURNS).map(|_| [time(&default), time(&ours)]).collect();
    let median = |of: fn(&[f64; 2]) -> f64| {
        let mut values: Vec<f64> = turns.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[TURNS / 2]
    };
    let [default, ours, ratio] = [median(|t| t[0]), median(|t| t[1]), median(|t| t[0] / t[1])];
    format!("{default:.0} → {ours:.0}, {ratio:.1}")
}
