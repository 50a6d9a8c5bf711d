//! How often the program is killed, and when: from two variables of the environment, or always the same.

use std::env;
use std::time::Duration;

use crate::program::Aim;

/// Kills in all, unless told otherwise.
const FEW: u64 = 7;
/// Of so many kills ...
const OF: u32 = 20;
/// ... each command gets these.
const SHARES: [(&str, u32); 7] =
    [("drive", 5), ("campaign", 3), ("natural", 3), ("train", 3), ("redrive", 2), ("compare", 2), ("experiment", 2)];

/// Moments to kill a command at; another command draws others.
pub struct Draws {
    command: &'static str,
    seed: u64,
    count: u64,
}

impl Draws {
    /// Those of a command.
    pub fn of(command: &'static str) -> Self {
        Self { command, seed: number("AEYE_KILLS_SEED", 1), count: 0 }
    }

    /// How often it is killed: at least once.
    pub fn kills(&self) -> u32 {
        let share = SHARES.iter().find(|(name, _)| *name == self.command).expect("a share").1;
        (number("AEYE_KILLS", FEW) as u32 * share / OF).max(1)
    }

    /// A moment within a time. Every other one is just after the next change in the folder from then on, as files
    /// are half-written for a tiny part of the time only.
    pub fn aim(&mut self, within: Duration) -> Aim {
        Aim { after: within.mul_f64(self.fraction()), at_change: self.count.is_multiple_of(2) }
    }

    /// From 0 to 1.
    fn fraction(&mut self) -> f64 {
        self.count += 1;
        let Self { command, seed, count } = self;
        let hash = blake3::hash(format!("{seed} {command} {count}").as_bytes());
        let bits = u64::from_le_bytes(*hash.as_bytes().first_chunk().expect("32 bytes"));
        bits as f64 / u64::MAX as f64
    }
}

fn number(variable: &str, otherwise: u64) -> u64 {
    let Ok(text) = env::var(variable) else { return otherwise };
    text.parse().unwrap_or_else(|_| panic!("{variable} is {text:?}; expected a whole number"))
}
