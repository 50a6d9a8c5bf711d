//! Who walks with whom: a function of the seed and the ids, which follow each other in a group.

use crate::rng::{Stream, unit};

use super::walker::Walker;

/// Shares of groups up to so many people: sizes follow a Poisson distribution without zero, of mean 0.83 before that is cut
/// off (Moussaïd et al. 2010, their population A), so that 56 % of all people are in company.
const UP_TO: [f32; 3] = [0.643, 0.91, 0.984];
/// At most so many walk together.
const MOST: usize = UP_TO.len() + 1;
/// Ids are dealt out in blocks of so many: no group lies in two of them.
const BLOCK: u16 = 64;
/// What draws the size of a group, as a key of random numbers.
const GROUP_KEY: u64 = 35;

/// The lowest id in the group of somebody, whether that is there or not.
pub(super) fn first_of_group(seed: u64, id: u16) -> u16 {
    let mut first = id - id % BLOCK;
    loop {
        let drawn = unit(seed, Stream::Trait, u64::from(first), GROUP_KEY);
        let size = 1 + UP_TO.iter().filter(|share| drawn >= **share).count() as u16;
        if id - first < size {
            return first;
        }
        first += size;
    }
}

/// The groups of all walkers, by index.
#[derive(Clone, Debug, Default)]
pub(super) struct Groups {
    /// Who leads; itself, where somebody leads or is alone.
    leader: Vec<u32>,
    /// The number in the group, 0 for who leads.
    rank: Vec<u8>,
    /// How many follow who leads, and who they are.
    followers: Vec<(u8, [u32; MOST - 1])>,
}

impl Groups {
    /// Those of some walkers, in any order.
    pub fn new(seed: u64, walkers: &[Walker]) -> Self {
        let mut order: Vec<u32> = (0..walkers.len() as u32).collect();
        order.sort_unstable_by_key(|i| walkers[*i as usize].id);
        let none = (0, [0; MOST - 1]);
        let count = walkers.len();
        let mut groups = Self { leader: order.clone(), rank: vec![0; count], followers: vec![none; count] };
        let (mut before, mut leader) = (None, 0);
        for index in order {
            let at = index as usize;
            let group = first_of_group(seed, walkers[at].id);
            if before != Some(group) {
                (before, leader) = (Some(group), index);
            } else {
                let (many, followers) = &mut groups.followers[leader as usize];
                followers[usize::from(*many)] = index;
                *many += 1;
                groups.rank[at] = *many;
            }
            groups.leader[at] = leader;
        }
        groups
    }

    /// Whom somebody follows.
    pub fn leader(&self, index: usize) -> Option<usize> {
        (self.rank[index] > 0).then(|| self.leader[index] as usize)
    }

    /// The number in the group, 0 for who leads or is alone.
    pub fn rank(&self, index: usize) -> u8 {
        self.rank[index]
    }

    /// Who follows somebody.
    pub fn followers(&self, index: usize) -> impl Iterator<Item = usize> + '_ {
        let (count, all) = &self.followers[index];
        all[..usize::from(*count)].iter().map(|i| *i as usize)
    }

    /// Whether somebody walks alone.
    pub fn is_alone(&self, index: usize) -> bool {
        self.rank[index] == 0 && self.followers[index].0 == 0
    }

    /// All who walk with somebody, that one too.
    pub fn members(&self, index: usize) -> impl Iterator<Item = usize> + '_ {
        let leader = self.leader[index] as usize;
        std::iter::once(leader).chain(self.followers(leader))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_as_large_as_counted_in_streets() {
        let mut sizes = [0u32; MOST + 1];
        for seed in 0..20 {
            let firsts: Vec<u16> = (1..=4096).map(|id| first_of_group(seed, id)).collect();
            for group in firsts.chunk_by(|a, b| a == b) {
                sizes[group.len()] += 1;
            }
        }
        let all: u32 = sizes.iter().sum();
        for (size, share) in [(1, 0.643), (2, 0.267), (3, 0.074), (4, 0.016)] {
            let found = sizes[size] as f32 / all as f32;
            assert!((found - share).abs() < 0.012, "{size}: {found}");
        }
        let people: u32 = (1..).zip(&sizes[1..]).map(|(size, count)| size * count).sum();
        let in_company = 1.0 - sizes[1] as f32 / people as f32;
        assert!((in_company - 0.56).abs() < 0.02, "{in_company}");
    }
}
