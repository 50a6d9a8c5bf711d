//! Who is near whom or a place, kept in order along an axis from tick to tick.

use std::cmp::Ordering;

use glam::{Vec2, Vec3};

/// The axis: askew to streets, which mostly follow the compass, so that few are in one place along it.
const AXIS: Vec2 = Vec2::new(0.8, 0.6);

fn along(position: Vec3) -> f32 {
    position.truncate().dot(AXIS)
}

/// The place in the order of who is not present.
const ABSENT: u32 = u32::MAX;

fn compare(a: &(f32, u32), b: &(f32, u32)) -> Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

/// Sorts by insertion, which is quickest for what is nearly in order: from one tick to the next hardly anybody changes places.
fn put_right(order: &mut [(f32, u32)]) {
    for i in 1..order.len() {
        let mut at = i;
        while at > 0 && compare(&order[at], &order[at - 1]) == Ordering::Less {
            order.swap(at, at - 1);
            at -= 1;
        }
    }
}

/// Those of a list by their place.
#[derive(Clone, Debug, Default)]
pub(super) struct Nearby {
    /// Place along the axis and index of everybody who is present, ascending.
    order: Vec<(f32, u32)>,
    /// For each index its place in the order; [`ABSENT`] for who is not present.
    rank: Vec<u32>,
    /// For each index its place along the axis.
    along: Vec<Option<f32>>,
}

impl Nearby {
    /// Takes the positions of those who are present out of a list of so many. The order follows from them alone.
    pub fn rebuild(&mut self, count: usize, position: impl Fn(usize) -> Option<Vec3>) {
        self.along.clear();
        self.along.extend((0..count).map(|i| position(i).map(along)));
        let at = &self.along;
        let present = at.iter().flatten().count();
        let same = self.rank.len() == count && self.order.len() == present;
        if same && self.order.iter().all(|(_, i)| at[*i as usize].is_some()) {
            self.order.iter_mut().for_each(|(place, i)| *place = at[*i as usize].unwrap_or(*place));
            put_right(&mut self.order);
        } else {
            self.order.clear();
            self.order.extend((0..count as u32).filter_map(|i| Some((at[i as usize]?, i))));
            self.order.sort_by(compare);
        }
        self.rank.clear();
        self.rank.resize(count, ABSENT);
        for (rank, (_, index)) in self.order.iter().enumerate() {
            self.rank[*index as usize] = rank as u32;
        }
    }

    /// Whether somebody is present.
    pub fn has(&self, index: usize) -> bool {
        self.rank[index] != ABSENT
    }

    /// Indices of those within `reach_m` of a place, and of some farther away.
    pub fn around(&self, place: Vec3, reach_m: f32) -> impl Iterator<Item = usize> + '_ {
        let at = along(place);
        let first = self.order.partition_point(|o| o.0 < at - reach_m);
        self.order[first..].iter().take_while(move |o| o.0 <= at + reach_m).map(|o| o.1 as usize)
    }

    /// The same around somebody, who is not among them.
    pub fn near(&self, index: usize, reach_m: f32) -> impl Iterator<Item = usize> + '_ {
        let rank = self.rank[index] as usize;
        let at = self.order[rank].0;
        let behind = self.order[..rank].iter().rev().take_while(move |o| at - o.0 < reach_m);
        let ahead = self.order[rank + 1..].iter().take_while(move |o| o.0 - at < reach_m);
        ahead.chain(behind).map(|o| o.1 as usize)
    }
}
