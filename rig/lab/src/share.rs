//! The part of some work that one process does.

use std::fmt;
use std::str::FromStr;

use base::failure::Failure;
use base::json::Typed;
use base::library::Found;
use serde::{Deserialize, Serialize};

/// Every N-th of runs, files or scenes: of number 0, 1, 2 ... shard I of N has those whose number modulo N is I - 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Share {
    /// Number of the shard, from 1 on.
    pub shard: u32,
    /// How many shards there are.
    pub of: u32,
}

impl Share {
    /// All of them.
    pub const WHOLE: Self = Self { shard: 1, of: 1 };

    /// That of so many which has a number.
    pub fn with(number: u32, of: u32) -> Self {
        Self { shard: number % of + 1, of }
    }

    /// Its files of those that were found. What could not even be opened is told by the first shard alone.
    pub fn pick(self, mut found: Found) -> Found {
        self.keep(&mut found.files);
        if self.shard != 1 {
            found.failed.clear();
        }
        found
    }

    /// Leaves of a list what it has.
    pub fn keep<T>(self, all: &mut Vec<T>) {
        let mut numbers = 0..;
        all.retain(|_| numbers.next().is_some_and(|number| self.has(number)));
    }

    /// Whether it has a number.
    pub fn has(self, number: u32) -> bool {
        Self::with(number, self.of) == self
    }

    /// Its first number, its second one, and so on, counted from 0; `None` beyond what numbers can say.
    pub fn number(self, turn: u32) -> Option<u32> {
        turn.checked_mul(self.of)?.checked_add(self.shard - 1)
    }

    /// How many of the first so many it has.
    pub fn count(self, all: u32) -> u32 {
        all.saturating_sub(self.shard - 1).div_ceil(self.of)
    }
}

/// What came of a share of files or scenes. The folders of all shares, copied into one, hold everything for the command
/// that does the rest.
#[derive(Debug, Serialize)]
pub struct ShareDone {
    /// Which one it is.
    #[serde(flatten)]
    pub share: Share,
    /// Folder of the results.
    pub out: String,
    /// Files or scenes that are done.
    pub done: usize,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// What `aeye compare --shard` prints, and each other command that takes it, but for `aeye campaign`.
impl Typed for ShareDone {
    const TYPE: &'static str = "aeye.share";
}

impl fmt::Display for ShareDone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: shard {}, {} done", self.out, self.share, self.done)
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.shard, self.of)
    }
}

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(shard, of)| Some((shard.parse().ok()?, of.parse().ok()?)));
        let share = numbers.map(|(shard, of)| Self { shard, of }).filter(|share| (1..=share.of).contains(&share.shard));
        share.ok_or_else(|| "expected I/N with I from 1 to N, as in 2/4".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_part_all_runs() {
        for of in 1..6 {
            let shares: Vec<Share> = (1..=of).map(|shard| Share { shard, of }).collect();
            for runs in 0..13 {
                let below = |number: &u32| *number < runs;
                let numbers = |share: Share| (0..).map_while(move |turn| share.number(turn).filter(below));
                let mut all: Vec<u32> = shares.iter().flat_map(|share| numbers(*share)).collect();
                all.sort_unstable();
                assert_eq!(all, (0..runs).collect::<Vec<_>>());
                assert!(shares.iter().all(|share| numbers(*share).count() == share.count(runs) as usize));
                assert!(shares.iter().all(|share| numbers(*share).all(|run| share.has(run))));
                assert!(shares.iter().all(|share| {
                    let mut kept: Vec<u32> = (0..runs).collect();
                    share.keep(&mut kept);
                    numbers(*share).eq(kept)
                }));
            }
        }
        assert_eq!(Share { shard: 2, of: 2 }.number(u32::MAX), None);
    }

    #[test]
    fn a_share_is_read_as_it_is_printed() {
        assert_eq!("2/4".parse(), Ok(Share { shard: 2, of: 4 }));
        assert_eq!(Share::WHOLE.to_string().parse(), Ok(Share::WHOLE));
        assert!(
            ["", "2", "0/4", "5/4", "1/0", "-1/4", "1/4/2", "a/b"].iter().all(|text| text.parse::<Share>().is_err())
        );
    }
}
