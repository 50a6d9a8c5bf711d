//! Which walkers are on which edge, rebuilt each tick in memory that is kept.

use super::walker::Walker;

/// Walkers by edge and place.
#[derive(Clone, Debug, Default)]
pub(super) struct EdgeLists {
    order: Vec<u32>,
    rank: Vec<u32>,
}

impl EdgeLists {
    pub fn rebuild(&mut self, walkers: &[Walker]) {
        self.order.clear();
        self.order.extend(0..walkers.len() as u32);
        self.order.sort_unstable_by(|&a, &b| {
            let (a, b) = (&walkers[a as usize], &walkers[b as usize]);
            a.edge.cmp(&b.edge).then(a.s_m.total_cmp(&b.s_m)).then(a.id.cmp(&b.id))
        });
        self.rank.resize(walkers.len(), 0);
        for (rank, &index) in self.order.iter().enumerate() {
            self.rank[index as usize] = rank as u32;
        }
    }

    /// Indices of the walkers on the same edge before and behind, the nearest first.
    pub fn around(&self, index: usize) -> (impl Iterator<Item = usize> + '_, impl Iterator<Item = usize> + '_) {
        let rank = self.rank[index] as usize;
        let up = self.order[rank + 1..].iter().map(|i| *i as usize);
        let down = self.order[..rank].iter().rev().map(|i| *i as usize);
        (up, down)
    }
}
