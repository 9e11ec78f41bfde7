//! Worst errors and failing cases, gathered before anything is asserted.

use std::collections::BTreeMap;
use std::fmt;

/// Everything one test measured, by route.
#[derive(Default)]
pub struct Report {
    title: String,
    routes: BTreeMap<String, Tally>,
}

/// The measurements on one route.
#[derive(Default)]
struct Tally {
    count: usize,
    /// The worst value of each quantity, in the order it was first measured.
    worst: Vec<(&'static str, f64)>,
    failures: Vec<String>,
}

/// One checked answer: measured quantities, and its faults.
#[derive(Debug, Default)]
pub struct Finding {
    measured: Vec<(&'static str, f64)>,
    wrong: Vec<String>,
}

impl Finding {
    /// A `quantity` that may not exceed its `limit`; NaN always does.
    pub fn at_most(&mut self, quantity: &'static str, value: f64, limit: f64) {
        self.measured.push((quantity, value));
        self.require(value <= limit, || {
            format!("{quantity} {value:.1e} > {limit:.1e}")
        });
    }

    /// Whether nothing is wrong.
    pub fn is_fine(&self) -> bool {
        self.wrong.is_empty()
    }

    /// A yes-or-no demand.
    pub fn require(&mut self, holds: bool, complaint: impl FnOnce() -> String) {
        if !holds {
            self.wrong.push(complaint());
        }
    }
}

impl Report {
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            routes: BTreeMap::new(),
        }
    }

    /// Adds the findings about the case `id` on `route`.
    pub fn add(&mut self, route: &str, id: &str, finding: Finding) {
        let tally = self.routes.entry(route.to_owned()).or_default();
        tally.count += 1;
        for (quantity, value) in finding.measured {
            tally.raise(quantity, value);
        }
        if !finding.wrong.is_empty() {
            tally
                .failures
                .push(format!("{id}: {}", finding.wrong.join(", ")));
        }
    }

    /// Prints the table, and fails if anything was wrong, or nothing was checked.
    pub fn conclude(&self) {
        println!("{self}");
        assert!(!self.routes.is_empty(), "{}: nothing checked", self.title);
        let failures: usize = self.routes.values().map(|t| t.failures.len()).sum();
        assert_eq!(failures, 0, "{}: see the table above", self.title);
    }
}

impl Tally {
    fn raise(&mut self, quantity: &'static str, value: f64) {
        match self.worst.iter_mut().find(|(name, _)| *name == quantity) {
            Some((_, worst)) if value > *worst || value.is_nan() => *worst = value,
            Some(_) => {}
            None => self.worst.push((quantity, value)),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        const LISTED: usize = 10;
        writeln!(f, "{}", self.title)?;
        for (route, tally) in &self.routes {
            let failed = tally.failures.len();
            write!(
                f,
                "  {route:<40} {:>5} checked {failed:>5} failed",
                tally.count
            )?;
            for (quantity, worst) in &tally.worst {
                write!(f, "   {quantity} ≤ {worst:.1e}")?;
            }
            writeln!(f)?;
            for failure in tally.failures.iter().take(LISTED) {
                writeln!(f, "      {failure}")?;
            }
        }
        Ok(())
    }
}
