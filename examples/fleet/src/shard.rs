//! Which of the worlds are this job's.

use std::fmt;
use std::str::FromStr;

/// One of several equal parts of the worlds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u32,
    count: u32,
}

impl Shard {
    /// All worlds.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Every `count`-th of the worlds: neighbours cost about the same, so all shards do.
    pub fn worlds(self, worlds: u32) -> impl Iterator<Item = u32> {
        (self.index..worlds).step_by(self.count as usize)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let numbers = parts.and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, count)) if index < count => Ok(Self { index, count }),
            Some((index, count)) => Err(format!(
                "there is no shard {index} of {count}: they are counted from zero"
            )),
            None => Err("write it as 3/16, two whole numbers".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn shards_share_out_all_worlds() {
        let mut worlds: Vec<u32> = (0..7)
            .flat_map(|i| format!("{i}/7").parse::<Shard>().unwrap().worlds(100))
            .collect();
        worlds.sort_unstable();
        assert_eq!(worlds, (0..100).collect::<Vec<_>>());
    }

    #[test]
    fn bad_shards_are_refused() {
        for text in ["", "3", "3/", "a/b", "3/3", "1/0", "-1/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text:?}");
        }
    }
}
