//! How much traffic there is.

use std::fmt;

use crate::actor::ActorKind;
use crate::state;

use super::population::Population;

state! {
    /// How many actors of each kind there are, and how they behave.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct TrafficCounts {
        /// Cars, vans, lorries and buses.
        pub cars: u16,
        /// Motorcycles and scooters.
        pub motorcycles: u16,
        /// Bicycles, with and without a box.
        pub bicycles: u16,
        /// Pedestrians.
        pub pedestrians: u16,
        /// Mean number of times a minute that anyone walking beside a road steps onto it, of all together.
        pub jaywalks_per_min: f32,
        /// What drivers are like.
        pub drivers: Population,
    }
}

/// Actors that were asked for and found no room on the map: how many of how many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Missing {
    /// Cars, vans, lorries and buses.
    pub cars: [u16; 2],
    /// Motorcycles and scooters.
    pub motorcycles: [u16; 2],
    /// Bicycles, with and without a box.
    pub bicycles: [u16; 2],
    /// Pedestrians.
    pub pedestrians: [u16; 2],
}

impl TrafficCounts {
    /// Nobody.
    pub const NONE: Self = Self {
        cars: 0,
        motorcycles: 0,
        bicycles: 0,
        pedestrians: 0,
        jaywalks_per_min: 0.0,
        drivers: Population::USUAL,
    };

    /// Who is missing among those who are there.
    pub(super) fn missing(&self, present: impl Iterator<Item = ActorKind> + Clone) -> Missing {
        let of = |asked: u16, is: fn(ActorKind) -> bool| {
            let there = present.clone().filter(|kind| is(*kind)).count();
            [asked.saturating_sub(there as u16), asked]
        };
        Missing {
            cars: of(self.cars, ActorKind::is_car_or_heavier),
            motorcycles: of(self.motorcycles, ActorKind::is_motorcycle),
            bicycles: of(self.bicycles, ActorKind::is_pedalled),
            pedestrians: of(self.pedestrians, ActorKind::is_on_foot),
        }
    }
}

impl Missing {
    /// How many in all.
    pub fn total(&self) -> u32 {
        let Self { cars, motorcycles, bicycles, pedestrians } = self;
        [cars, motorcycles, bicycles, pedestrians].into_iter().map(|of| u32::from(of[0])).sum()
    }
}

impl fmt::Display for Missing {
    /// As in `60 of 400 pedestrians and 2 of 5 motorcycles`; nothing when nobody is missing.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds = [
            (self.cars, "cars"),
            (self.motorcycles, "motorcycles"),
            (self.bicycles, "bicycles"),
            (self.pedestrians, "pedestrians"),
        ];
        let missing = kinds.into_iter().filter(|([count, _], _)| *count > 0);
        let words: Vec<String> = missing.map(|([count, of], kind)| format!("{count} of {of} {kind}")).collect();
        match words.as_slice() {
            [] => Ok(()),
            [one] => f.write_str(one),
            [some @ .., last] => write!(f, "{} and {last}", some.join(", ")),
        }
    }
}
