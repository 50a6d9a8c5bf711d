//! Whether a map has room for all road users that a scenario asks for, and how it is told where it has not.

use std::collections::BTreeSet;

use kernel::scenario::TrafficCounts;
use kernel::traffic::Missing;
use kernel::{Scenario, World, WorldError};
use serde::Serialize;

use crate::maps::Map;

/// How many road users of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct RoadUsers {
    /// Cars, vans, lorries and buses.
    pub cars: u16,
    /// Motorcycles and scooters.
    pub motorcycles: u16,
    /// Bicycles, with and without a box.
    pub bicycles: u16,
    /// People on foot.
    pub pedestrians: u16,
}

impl RoadUsers {
    /// Those that are asked for.
    pub fn asked(counts: &TrafficCounts) -> Self {
        let TrafficCounts { cars, motorcycles, bicycles, pedestrians, .. } = *counts;
        Self { cars, motorcycles, bicycles, pedestrians }
    }

    /// Those for whom there is no room.
    pub fn missing(missing: &Missing) -> Self {
        let Missing { cars, motorcycles, bicycles, pedestrians } = missing;
        Self { cars: cars[0], motorcycles: motorcycles[0], bicycles: bicycles[0], pedestrians: pedestrians[0] }
    }

    /// As in `60 of 400 pedestrians`, of those that are asked for; nothing when nobody is missing.
    pub fn of(&self, asked: &Self) -> Option<String> {
        let missing = Missing {
            cars: [self.cars, asked.cars],
            motorcycles: [self.motorcycles, asked.motorcycles],
            bicycles: [self.bicycles, asked.bicycles],
            pedestrians: [self.pedestrians, asked.pedestrians],
        };
        (missing.total() > 0).then(|| missing.to_string())
    }
}

/// Tells who has no room: once for each map and what is asked of it, of many runs the first one's.
#[derive(Debug, Default)]
pub struct NoRoom {
    told: BTreeSet<(String, RoadUsers)>,
}

impl NoRoom {
    /// What is to be told of the road users of a run that has not begun on a map, if there is anything new.
    pub fn of_run(&mut self, scenario: &Scenario, map: &Map) -> Result<Option<String>, WorldError> {
        Ok(self.of_world(&World::new(scenario, &map.network)?))
    }

    /// As [`Self::of_run`], of a world.
    pub fn of_world(&mut self, world: &World) -> Option<String> {
        let Scenario { map, traffic, .. } = world.scenario();
        self.of(map, &RoadUsers::asked(traffic), &RoadUsers::missing(&world.missing()))
    }

    /// As [`Self::of_run`], where it is known who is asked for and who of them is missing.
    pub fn of(&mut self, map: &str, asked: &RoadUsers, missing: &RoadUsers) -> Option<String> {
        let words = missing.of(asked)?;
        self.told.insert((map.to_owned(), *asked)).then(|| format!("map {map} has no room for {words}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_without_room_is_told_once_for_what_is_asked_of_it() {
        let mut no_room = NoRoom::default();
        let people = |pedestrians| RoadUsers { pedestrians, ..RoadUsers::default() };
        assert_eq!(no_room.of("street", &people(400), &people(0)), None);
        let said = Some("map street has no room for 60 of 400 pedestrians".to_owned());
        assert_eq!(no_room.of("street", &people(400), &people(60)), said);
        assert_eq!(no_room.of("street", &people(400), &people(58)), None);
        assert!(no_room.of("street", &people(500), &people(160)).is_some());
        assert!(no_room.of("city", &people(400), &people(60)).is_some());
    }

    #[test]
    fn a_crowd_on_a_small_map_is_told_and_a_few_are_not() {
        let map = Map::find("../../tests/maps/cross_stop.xodr").expect("a map");
        let mut scenario = map.scenario(1);
        let mut no_room = NoRoom::default();
        (scenario.traffic.cars, scenario.traffic.pedestrians) = (2, 2);
        (scenario.traffic.motorcycles, scenario.traffic.bicycles) = (0, 0);
        assert_eq!(no_room.of_run(&scenario, &map), Ok(None));
        scenario.traffic.cars = 500;
        let said = no_room.of_run(&scenario, &map).expect("a world").expect("it is full");
        assert!(said.starts_with("map cross_stop has no room for ") && said.ends_with(" of 500 cars"), "{said}");
    }
}
