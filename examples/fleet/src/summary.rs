//! All shards together.

use std::fmt;

use crate::record::Record;

/// What the records of a whole run add up to.
#[derive(Debug)]
pub struct Summary {
    worlds: u32,
    steps: u64,
    thread_seconds: f64,
    slowest: f64,
    asleep: u32,
    bodies: u32,
    lost: u32,
}

impl Summary {
    /// Adds up the records, which must be of one run and have each of its worlds once.
    pub fn of(records: &[Record]) -> Result<Self, String> {
        let first = records.first().ok_or("the files have no records")?;
        if let Some(other) = records.iter().find(|record| record.run() != first.run()) {
            return Err(format!(
                "world {} is of another run: {}, not {}",
                other.world,
                other.run(),
                first.run()
            ));
        }
        let mut counts = vec![0_u32; first.worlds as usize];
        for record in records {
            *counts
                .get_mut(record.world as usize)
                .ok_or_else(|| format!("there is no world {}", record.world))? += 1;
        }
        let with = |has: fn(u32) -> bool| counts.iter().filter(|count| has(**count)).count();
        let (missing, twice) = (with(|count| count == 0), with(|count| count > 1));
        if missing + twice > 0 {
            return Err(format!("{missing} worlds are missing, {twice} came twice"));
        }
        let sum = |value: fn(&Record) -> u32| records.iter().map(value).sum();
        Ok(Self {
            worlds: first.worlds,
            steps: records.iter().map(|record| u64::from(record.steps)).sum(),
            thread_seconds: records.iter().map(|record| record.seconds).sum(),
            slowest: records
                .iter()
                .map(|record| record.seconds)
                .fold(0.0, f64::max),
            asleep: sum(|record| record.asleep),
            bodies: sum(|record| record.bodies),
            lost: sum(|record| record.lost),
        })
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} worlds, {} steps, {:.0} steps per second and thread, slowest world {:.2} s; \
             {} of {} bodies asleep, {} outside of their bins",
            self.worlds,
            self.steps,
            self.steps as f64 / self.thread_seconds,
            self.slowest,
            self.asleep,
            self.bodies,
            self.lost
        )
    }
}

#[cfg(test)]
mod tests {
    use super::Summary;
    use crate::record::Record;

    fn record(world: u32) -> Record {
        Record {
            world,
            worlds: 3,
            seed: 1,
            steps: 10,
            seconds: 0.5,
            asleep: 1,
            bodies: 2,
            lost: 0,
        }
    }

    #[test]
    fn a_whole_run_adds_up() {
        let summary = Summary::of(&[2, 0, 1].map(record)).expect("all worlds, once");
        assert_eq!((summary.steps, summary.asleep, summary.bodies), (30, 3, 6));
    }

    #[test]
    fn what_is_no_whole_run_is_refused() {
        let other = Record {
            seed: 2,
            ..record(1)
        };
        let longer = Record {
            steps: 11,
            ..record(1)
        };
        for records in [
            vec![],
            vec![record(0), record(1)],
            vec![record(0), record(1), record(1), record(2)],
            vec![record(0), record(1), record(2), record(3)],
            vec![record(0), other, record(2)],
            vec![record(0), longer, record(2)],
        ] {
            assert!(Summary::of(&records).is_err(), "{records:?}");
        }
    }
}
