//! All that others keep off in a tick.

use glam::Vec3;

use crate::ops;

use super::hazard::Hazard;
use super::nearby::Nearby;

#[derive(Clone, Debug, Default)]
pub(super) struct Hazards {
    /// Those that move freely, people on the road, vehicles that drive, in this order.
    all: Vec<Hazard>,
    people_from: usize,
    driven_from: usize,
    /// Half of the greatest diagonal among them, metres.
    greatest_half_m: f32,
    nearby: Nearby,
}

impl Hazards {
    /// Takes the ego car, loose actors, vehicles that stand aside and open doors, which are `free`, people on the road, and
    /// vehicles that drive.
    pub fn rebuild(
        &mut self,
        free: impl Iterator<Item = Hazard>,
        people: impl Iterator<Item = Hazard>,
        driven: impl Iterator<Item = Hazard>,
    ) {
        self.all.clear();
        self.all.extend(free);
        self.people_from = self.all.len();
        self.all.extend(people);
        self.driven_from = self.all.len();
        self.all.extend(driven);
        let all = &self.all;
        self.greatest_half_m = ops::sqrt(all.iter().map(|h| h.half.length_squared()).fold(0.0, f32::max));
        self.nearby.rebuild(all.len(), |i| Some(all[i].position));
    }

    /// The ego car first, loose actors, vehicles that stand aside and open doors.
    pub fn free(&self) -> &[Hazard] {
        &self.all[..self.people_from]
    }

    /// People on the road.
    pub fn people(&self) -> &[Hazard] {
        &self.all[self.people_from..self.driven_from]
    }

    /// Vehicles that drive, by ascending index.
    pub fn driven(&self) -> &[Hazard] {
        &self.all[self.driven_from..]
    }

    /// All whose middle is within `reach_m` of a place.
    pub fn around(&self, place: Vec3, reach_m: f32) -> impl Iterator<Item = &Hazard> {
        let near = move |h: &&Hazard| h.position.distance_squared(place) < reach_m * reach_m;
        self.nearby.around(place, reach_m).map(|i| &self.all[i]).filter(near)
    }

    /// All of whom a part may be within `reach_m` of a place.
    pub fn reaching(&self, place: Vec3, reach_m: f32) -> impl Iterator<Item = &Hazard> {
        let near = move |h: &&Hazard| {
            let most_m = reach_m + h.half.length();
            h.position.distance_squared(place) < most_m * most_m
        };
        self.around(place, reach_m + self.greatest_half_m).filter(near)
    }
}
