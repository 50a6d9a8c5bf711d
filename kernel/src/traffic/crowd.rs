//! Who walks near whom, kept in order along an axis from tick to tick.

use glam::Vec2;

use super::body::Body;

/// The axis: askew to streets, which mostly follow the compass, so that few are in one place along it.
const AXIS: Vec2 = Vec2::new(0.8, 0.6);

fn along(body: &Body) -> f32 {
    body.position.truncate().dot(AXIS)
}

/// The place in the order of who is not present.
const ABSENT: u32 = u32::MAX;

/// People by their place.
#[derive(Clone, Debug, Default)]
pub(super) struct Crowd {
    /// Place along the axis and index of everybody who is present, ascending.
    order: Vec<(f32, u32)>,
    /// For each index its place in the order; [`ABSENT`] for who is not present.
    rank: Vec<u32>,
}

impl Crowd {
    /// Takes the people whose indices are `present`. The order follows from their places alone.
    pub fn rebuild(&mut self, bodies: &[Body], present: impl Fn(usize) -> bool) {
        let is_there = |i: u32| present(i as usize);
        let there = (0..bodies.len() as u32).filter(|i| is_there(*i));
        let same = self.rank.len() == bodies.len() && self.order.iter().all(|(_, i)| is_there(*i));
        if same && self.order.len() == there.clone().count() {
            self.order.iter_mut().for_each(|(at, i)| *at = along(&bodies[*i as usize]));
            self.insert_all();
        } else {
            self.order.clear();
            self.order.extend(there.map(|i| (along(&bodies[i as usize]), i)));
            self.order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        self.rank.clear();
        self.rank.resize(bodies.len(), ABSENT);
        for (rank, (_, index)) in self.order.iter().enumerate() {
            self.rank[*index as usize] = rank as u32;
        }
    }

    /// Insertion sort: from one tick to the next hardly anybody changes places.
    fn insert_all(&mut self) {
        let less = |a: &(f32, u32), b: &(f32, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).is_lt();
        for k in 1..self.order.len() {
            let mut at = k;
            while at > 0 && less(&self.order[at], &self.order[at - 1]) {
                self.order.swap(at, at - 1);
                at -= 1;
            }
        }
    }

    /// Whether somebody is present.
    pub fn has(&self, index: usize) -> bool {
        self.rank[index] != ABSENT
    }

    /// Indices of those within `reach_m` of somebody, and of some farther away.
    pub fn near(&self, index: usize, reach_m: f32) -> impl Iterator<Item = usize> + '_ {
        let rank = self.rank[index] as usize;
        let at = self.order[rank].0;
        let behind = self.order[..rank].iter().rev().take_while(move |o| at - o.0 < reach_m);
        let ahead = self.order[rank + 1..].iter().take_while(move |o| o.0 - at < reach_m);
        ahead.chain(behind).map(|o| o.1 as usize)
    }
}
